"""How the mission node converts its messages; without a graph."""

import io
import math

import numpy as np
import pytest
from fixtures.robots.missions import HOME
from geometry_msgs.msg import Point, Point32, Polygon
from roomba_robot.msg import CleanGoal, Rectangle, Room, RoomArray
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from roomba_robot.msg import TimeSpent as TimeSpentMessage
from roomba_robot.msg import Zone as ZoneMessage
from sensor_msgs.msg import BatteryState

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.client.protocol import ErrandOutcome, MissedFloor
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome, CleanResult, Missed, MissReason
from roomba.mission.docking.beams import StationBeams
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.perception.swept.coverage_bits import SWEPT, WANTED
from roomba.time_spent import TimeSpent
from roomba.vocabulary import (
    NO_REASON,
    CarpetWay,
    CleanMode,
    EdgeOrder,
    EdgeReason,
    FanLevel,
    Hindrance,
    OpenEdge,
    Reason,
    RoomWay,
)
from roomba_ros.convert.clean_action import (
    OUTCOMES,
    explored_message,
    goal_of,
    request_of,
    result_message,
    way_codes,
)
from roomba_ros.convert.client import clean_end_of, open_edges_of, outcome_of, times_of
from roomba_ros.convert.mapping import coverage_message, dirt_message
from roomba_ros.convert.readings import battery_of, beams_of
from roomba_ros.convert.rooms import outlines_of, zone_of, zones_markers, zones_message
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.mission.topics import shown, with_trouble
from roomba_ros.senses.heard_place import moved


def test_an_empty_goal_cleans_the_whole_home_once() -> None:
    request = request_of(CleanGoal())
    assert (request.mode, request.passes, request.fan) == (CleanMode.WHOLE, 1, FanLevel.STANDARD)
    assert request.spot is None


def test_goals_say_what_is_wanted() -> None:
    rooms = request_of(
        CleanGoal(mode=CleanGoal.ROOMS, rooms=["Kitchen"], in_order=True, passes=2, fan=2)
    )
    assert (rooms.rooms, rooms.in_order, rooms.passes) == (("Kitchen",), True, 2)
    assert (rooms.carpets, rooms.edges) == (CarpetWay.BOOST, EdgeOrder.ANY)
    special = request_of(CleanGoal(carpets=CleanGoal.CARPETS_AVOID, edges=CleanGoal.EDGES_LAST))
    assert (special.carpets, special.edges) == (CarpetWay.AVOID, EdgeOrder.LAST)
    for wrong in (CleanGoal(carpets=3), CleanGoal(edges=3)):
        with pytest.raises(CleanRefusedError, match="from 0 to 2, got 3"):
            request_of(wrong)
    assert rooms.fan is FanLevel.STRONG
    zones = request_of(CleanGoal(mode=CleanGoal.ZONES, zones=[Rectangle(-1.0, 0.0, 2.0, 3.0)]))
    assert zones.zones == ((-1.0, 0.0, 2.0, 3.0),)
    spot = CleanGoal(mode=CleanGoal.SPOT, spot=Point(1.0, 2.0, 0.0))
    assert request_of(spot).spot == (1.0, 2.0)
    spot.spot_is_here = True
    assert request_of(spot).spot is None


def test_each_room_of_a_goal_can_have_its_own_way() -> None:
    goal = CleanGoal(
        mode=CleanGoal.ROOMS, rooms=["Kitchen", "Hall"], room_passes=[2, 1], room_fans=[1, 2]
    )
    ways = RoomWay(2, FanLevel.QUIET), RoomWay(1, FanLevel.STRONG)
    assert request_of(goal).each == ways
    sent = io.BytesIO()
    goal.serialize(sent)
    came = CleanGoal().deserialize(sent.getvalue())
    assert request_of(came).each == ways
    for passes, fans in (([2], []), ([2, 1], [1, 7]), ([2], [1])):
        goal.room_passes, goal.room_fans = passes, fans
        with pytest.raises(CleanRefusedError, match=r"each of the 2 rooms|passes of rooms"):
            request_of(goal)


@pytest.mark.parametrize(
    "request_",
    [
        CleanRequest(),
        CleanRequest(CleanMode.ROOMS, ("Küche", "Hall"), in_order=True, passes=5),
        CleanRequest(
            CleanMode.ROOMS,
            ("Hall", "Den"),
            each=(RoomWay(2, FanLevel.QUIET), RoomWay(1, FanLevel.STRONG)),
            carpets=CarpetWay.AVOID,
            edges=EdgeOrder.LAST,
        ),
        CleanRequest(CleanMode.ZONES, zones=((-1.0, 0.0, 2.0, 3.0), (0.0, 0.0, 1.0, 1.0))),
        CleanRequest(CleanMode.SPOT, spot=(1.5, -2.5), fan=FanLevel.QUIET),
        CleanRequest(CleanMode.SPOT),
        CleanRequest(CleanMode.EDGES, carpets=CarpetWay.SAME, edges=EdgeOrder.FIRST),
        CleanRequest(CleanMode.DIRTIEST),
    ],
)
def test_a_request_comes_back_out_of_its_goal(request_: CleanRequest) -> None:
    sent = io.BytesIO()
    goal_of(request_).serialize(sent)
    assert request_of(CleanGoal().deserialize(sent.getvalue())) == request_


def test_rooms_are_sent_with_passes_that_can_be_asked_for() -> None:
    ways = RoomWay(2, FanLevel.STRONG), RoomWay()
    assert way_codes(ways) == ([2, 1], [CleanGoal.STRONG, CleanGoal.STANDARD])
    with pytest.raises(CleanRefusedError, match="1 to 5 passes, got 6"):
        way_codes((RoomWay(), RoomWay(6)))


@pytest.mark.parametrize(
    ("goal", "reason"),
    [
        (CleanGoal(mode=6), "mode from 0 to 5, got 6"),
        (CleanGoal(fan=3), "fan level from 0 to 2, got 3"),
        (CleanGoal(passes=6), "1 to 5 passes, got 6"),
        (CleanGoal(mode=CleanGoal.ROOMS), "names of rooms"),
        (CleanGoal(mode=CleanGoal.ZONES), "expected zones"),
        (CleanGoal(mode=2, zones=[Rectangle(1.0, 0.0, 1.0, 3.0)]), "lowest x"),
        (CleanGoal(mode=2, zones=[Rectangle(math.nan, 0.0, 1.0, 3.0)]), "lowest x"),
        (CleanGoal(mode=3, spot=Point(math.inf, 0.0, 0.0)), "finite"),
    ],
)
def test_goals_that_make_no_sense_are_refused_with_the_reason(goal: CleanGoal, reason: str) -> None:
    with pytest.raises(CleanRefusedError, match=reason):
        request_of(goal)


TIMES = TimeSpent(300.0, 320.0, 50.0, 120.0, 40.0, 30.0, 25.0, 15.0)


@pytest.mark.parametrize("spoiled", [math.nan, math.inf, -1.0])
def test_times_that_are_none_are_not_known(spoiled: float) -> None:
    assert times_of(TimeSpentMessage(turning=spoiled, least=5.0)) == TimeSpent()


def test_a_result_says_what_was_missed_and_why() -> None:
    missed = (Missed(0.5, 1.0, 2.0, "Hall", MissReason.SHUT),)
    message = result_message(
        CleanResult(
            CleanOutcome.NOT_DOCKED, "no beams", 20.0, 19.5, 3.0, 99.0, 600.0, 4.5, missed, TIMES
        )
    )
    assert times_of(message.times) == TIMES
    assert message.outcome == message.NOT_DOCKED
    assert (message.wanted, message.covered, message.message) == (20.0, 19.5, "no beams")
    (area,) = message.missed
    assert (area.room, area.reason, area.at.y) == ("Hall", area.SHUT, 2.0)
    assert area.message == MissReason.SHUT.value
    report = clean_end_of(message, outcome_of(message.outcome), "told elsewhere")
    assert (report.outcome, report.message) == (ErrandOutcome.NOT_DOCKED, "no beams")
    assert (report.wanted, report.covered, report.dirt) == (20.0, 19.5, 3.0)
    assert (report.distance, report.duration, report.energy) == (99.0, 600.0, 4.5)
    assert report.missed == (MissedFloor(0.5, 1.0, 2.0, "Hall", MissReason.SHUT.value, "shut"),)
    assert report.times == TIMES
    area.reason = 200
    (unknown,) = clean_end_of(message, ErrandOutcome.STOPPED, "").missed
    assert unknown.code == ""
    message.message = ""
    assert clean_end_of(message, ErrandOutcome.STOPPED, "a newer goal").message == "a newer goal"


def test_outcomes_mean_the_same_to_a_client() -> None:
    for outcome, code in OUTCOMES.items():
        assert outcome_of(code) is ErrandOutcome[outcome.name]
    assert outcome_of(200) is ErrandOutcome.FAULT


EDGES = (
    OpenEdge(3.0, 1.0, -2.0, EdgeReason.NO_ECHO),
    OpenEdge(1.5, 4.0, 0.5, EdgeReason.NOT_LOOKED_AT),
)


def test_where_a_map_stays_open_is_told_of_explorations_and_of_cleans() -> None:
    explored = explored_message(
        ExploreResult(CleanOutcome.COMPLETED, "", 30.0, 9.0, 60.0, ((1.0, -2.0),), EDGES)
    )
    assert open_edges_of(explored.open_edges) == EDGES
    edge = explored.open_edges[0]
    assert (edge.reason, edge.message) == (edge.NO_ECHO, EdgeReason.NO_ECHO.value)
    cleaned = result_message(
        CleanResult(CleanOutcome.COMPLETED, "", 20.0, 20.0, 3.0, 99.0, 600.0, 4.5, open_edges=EDGES)
    )
    assert open_edges_of(cleaned.open_edges) == EDGES


@pytest.mark.parametrize(
    "spoiled",
    [
        OpenEdgeMessage(math.nan, Point(), 0, ""),
        OpenEdgeMessage(-1.0, Point(), 0, ""),
        OpenEdgeMessage(1.0, Point(math.inf, 0.0, 0.0), 0, ""),
        OpenEdgeMessage(1.0, Point(0.0, math.nan, 0.0), 0, ""),
        OpenEdgeMessage(1.0, Point(), 9, ""),
    ],
)
def test_an_edge_that_makes_no_sense_is_left_out(spoiled: OpenEdgeMessage) -> None:
    assert open_edges_of([spoiled]) == ()


def test_the_battery_is_told_in_watt_hours() -> None:
    message = BatteryState(percentage=0.5, capacity=1.8)
    assert battery_of(message, 14.4, True) == Battery(0.5, 1.8 * 14.4, True)
    message.capacity = math.nan
    assert battery_of(message, 14.4, False) == Battery(0.5, is_docked=False)
    for percentage in (-0.1, 1.5, 80.0, math.nan):
        with pytest.raises(ValueError, match="from 0 to 1"):
            battery_of(BatteryState(percentage=percentage), 14.4, False)


@pytest.mark.parametrize(
    ("code", "beams"),
    [
        (0, StationBeams()),
        (161, StationBeams(halo=True)),
        (164, StationBeams(green=True)),
        (168, StationBeams(red=True)),
        (173, StationBeams(halo=True, green=True, red=True)),
        (13, StationBeams()),
        (255, StationBeams()),
    ],
)
def test_beams_are_coded_as_create_2_does(code: int, beams: StationBeams) -> None:
    assert beams_of(code) == beams


def test_zones_come_back_as_they_went() -> None:
    zones = Zones(
        (
            Zone("bowl", ZoneKind.NO_GO, ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0))),
            Zone("stairs", ZoneKind.WALL, ((0.0, 0.0), (3.0, 0.5))),
            Zone("rug", ZoneKind.CARPET, ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0))),
        )
    )
    message = zones_message(3.0, zones, "map")
    assert Zones(tuple(zone_of(zone) for zone in message.zones)) == zones
    drawn = zones_markers(3.0, zones, "map").markers
    assert [len(marker.points) for marker in drawn] == [0, 4, 2, 5]
    with pytest.raises(ZonesError, match="kind from 0 to 2, got 3"):
        zone_of(ZoneMessage("bowl", 3, []))


def test_rooms_are_those_that_were_told() -> None:
    floor = OccupancyMap(GridFrame(0.5, 0.0, 0.0, 4, 6), np.zeros((4, 6), np.int8))
    outline = Polygon([Point32(x, y, 0.0) for x, y in ((0, 0), (1.5, 0), (1.5, 2), (0, 2))])
    outlines = outlines_of(RoomArray(rooms=[Room(name="Hall", outline=outline)]))
    rooms = Rooms.from_outlines(floor.frame, floor.values == FREE, outlines)
    assert rooms.names == ("Hall",)
    assert rooms.labels[:, :3].all()
    assert not rooms.labels[:, 3:].any()


def test_coverage_is_told_cell_by_cell_of_the_map() -> None:
    cells = np.zeros((4, 6), np.uint8)
    cells[:2, :4] = WANTED
    cells[:2, :3] |= SWEPT
    cells[2:] = SWEPT
    message = coverage_message(0.0, cells, GridFrame(0.05, -1.0, 2.0, 4, 6), 2, "map")
    assert (message.info.width, message.info.height) == (3, 2)
    assert message.info.resolution == pytest.approx(0.1)
    assert message.data == [100, 50, -1, -1, -1, -1]


def test_dirt_is_told_as_a_share_of_what_is_dirty() -> None:
    density = np.array([[np.nan, 0.0], [250.0, 9000.0]], np.float32)
    message = dirt_message(0.0, density, GridFrame(0.2, 0.0, 0.0, 2, 2), 500.0, "map")
    assert message.data == [-1, 0, 50, 100]


def test_a_path_is_shown_with_few_points() -> None:
    bent = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.001], [1.0, 1.0], [1.0, 2.0]])
    assert shown(bent).tolist() == [[0.0, 0.0], [1.0, 0.001], [1.0, 2.0]]


def test_a_pose_moves_on_along_its_arc() -> None:
    quarter = moved(Pose(1.0, 2.0, 0.0), Twist(0.5 * math.pi, 0.5 * math.pi), 1.0)
    assert (quarter.x, quarter.y) == pytest.approx((2.0, 3.0))
    assert quarter.theta == pytest.approx(0.5 * math.pi)
    assert moved(Pose(), Twist(0.3, 0.0), 2.0) == Pose(0.6, 0.0, 0.0)
    assert moved(Pose(), Twist(0.3, 0.0), -1.0).x == pytest.approx(-0.3)


def test_an_edit_of_zones_is_told_from_a_map_that_only_grew() -> None:
    def known(zones: Zones) -> KnownHome:
        configs = RobotConfig(), MissionConfig(), DockingConfig()
        context = PlanningContext(HOME.map, HOME.station, *configs, None, zones, is_growing=True)
        return KnownHome(context, SurfaceField.unknown(), GROWING)

    shut = Zones().with_zone(Zone("mat", ZoneKind.NO_GO, ((1.0, 1.8), (1.4, 1.8), (1.4, 2.2))))
    assert not known(shut).is_edit_of(known(shut))
    assert known(shut).is_edit_of(known(Zones()))
    assert known(Zones()).is_edit_of(known(shut))


def test_a_process_that_does_not_work_is_told_first_and_without_a_word_of_the_mission() -> None:
    own = Reason("no way home", Hindrance.NO_WAY, 30.0)
    assert with_trouble("", own) == own
    assert with_trouble("dirt_pub_node ended", own) == Reason("dirt_pub_node ended; no way home")
    assert with_trouble("dirt_pub_node ended", NO_REASON).text == "dirt_pub_node ended"
