"""The robot makes a map of its own, despite interruptions, and goes on with it."""

import math
from collections.abc import Iterator

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.mapping_home import (
    FLOOR,
    GOOD_SHARE,
    KITCHEN,
    STATION,
    ZONE,
    is_right,
    kept_maps,
    mapping_home,
)
from fixtures.nodes.explorer import SPEED, Explorer, free_cells, is_growing, known
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point, PoseStamped
from roomba_robot.msg import CleanGoal, CleanResult, ExploreResult, Zone
from roomba_robot.srv import RenameRoom, SetZone
from std_srvs.srv import Trigger


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot without a map, faster than real time."""
    folder = tmp_path_factory.mktemp("robot")
    with RosGraph(folder) as own:
        own.launch(f"home:={mapping_home(folder)}", "map:=none", SPEED)
        yield own


@pytest.mark.thorough
def test_an_exploration_is_held_ended_and_taken_up(shared_robot: RosGraph) -> None:
    robot = Explorer(shared_robot)
    told = robot.maps_with("explore")
    assert (told.is_own, told.is_growing, told.name) == (True, True, "")
    assert robot.saved_maps() == ([], "")
    for deed, why in (("save", "explore first"), ("load", "expected one of no maps")):
        refused = robot.on_maps(deed, "home")
        assert not refused.success
        assert why in refused.message

    pause = rospy.ServiceProxy("/pause", Trigger, persistent=True)
    pause.wait_for_service(60.0)
    errand = robot.explore()
    robot.does("exploring")
    robot.stops(pause)
    robot.does("paused", 30.0)
    assert robot.trigger("/resume").success
    robot.does("exploring", 30.0)
    robot.stops(errand.cancel)
    stopped = errand.ends(GoalStatus.PREEMPTED, 30.0)
    assert stopped.outcome == ExploreResult.STOPPED
    robot.does("idle", 30.0)
    assert robot.mapping.is_growing
    assert 0.3 * FLOOR < stopped.known < 1.05 * FLOOR
    assert stopped.distance > 0.05

    again = robot.explore()
    result = again.ends()
    saved = robot.on_maps("save", "at once")
    assert saved.success, saved.message
    assert robot.on_maps("remove", "at once").success
    assert (result.outcome, result.message) == (ExploreResult.COMPLETED, "")
    assert list(result.unseen) == []
    assert min(known(again.feedback)) > 0.95 * stopped.known
    assert result.known == pytest.approx(FLOOR, rel=GOOD_SHARE)
    robot.does("docked", 30.0)
    robot.has_whole_map()
    stages = [free_cells(message) for message in robot.maps if is_growing(message)]
    assert len(set(stages)) >= 3
    assert stages[-1] > 1.1 * stages[0]
    assert is_right(robot.map)
    assert sorted(robot.rooms) == ["Room 1", "Room 2"]


@pytest.mark.thorough
def test_it_goes_by_the_map_that_it_made(shared_robot: RosGraph) -> None:
    robot = Explorer(shared_robot)
    robot.has_whole_map()
    refused = robot.explore().ends(GoalStatus.REJECTED, 30.0)
    assert "nothing to explore" in refused.message
    walk = PoseStamped()
    walk.header.frame_id = "map"
    walk.pose.position, walk.pose.orientation.w = Point(3.6, 1.0, 0.0), 1.0
    robot.probe.send("/move_base_simple/goal", walk)
    wait_until(lambda: math.dist(robot.probe.position(), (3.6, 1.0)) < 0.05, 30.0, "it walks there")
    robot.does("idle")
    spot = CleanGoal(mode=CleanGoal.SPOT, spot=Point(4.1, 2.0, 0.0))
    result = robot.clean(spot).ends()
    assert result.outcome == CleanResult.COMPLETED
    assert result.covered > 0.9 * result.wanted > 0.5
    robot.does("docked")


@pytest.mark.thorough
def test_it_keeps_its_map(shared_robot: RosGraph) -> None:
    robot = Explorer(shared_robot)
    robot.has_whole_map()
    assert rospy.ServiceProxy("/rooms/rename", RenameRoom)("Room 1", KITCHEN).success
    zone = Zone(ZONE.name, Zone.NO_GO, [Point(x, y, 0.0) for x, y in ZONE.points])
    assert rospy.ServiceProxy("/set_zone", SetZone)(zone).success
    wait_until(lambda: KITCHEN in robot.rooms, 30.0, "the room's name")
    for name in ("", "a/b", "x" * 51):
        refused = robot.on_maps("save", name)
        assert not refused.success
        assert "expected a map's name" in refused.message
    store = kept_maps(shared_robot.folder / "ros_home")
    wait_until(lambda: robot.on_maps("save", "home").success, 30.0, "it is saved")
    wait_until(lambda: robot.mapping.name == "home", 30.0, "its name is told")

    def is_all_kept() -> bool:
        robot.on_maps("save", "home")
        stored = store.load("home")
        return stored.rooms is not None and stored.zones.all == (ZONE,)

    wait_until(is_all_kept, 30.0, "the zone is kept")
    stored = store.load("home")
    assert stored.rooms is not None
    assert KITCHEN in stored.rooms.names
    assert stored.station.distance_to(STATION.x, STATION.y) < 0.05

    assert robot.on_maps("save", "second").success
    assert robot.saved_maps() == (["home", "second"], "second")
    assert robot.on_maps("load", "home").success
    assert robot.saved_maps() == (["home", "second"], "home")
    refused = robot.on_maps("load", "hom")
    assert not refused.success
    assert "did you mean 'home'?" in refused.message
    assert robot.on_maps("remove", "second").success
    assert robot.saved_maps() == (["home"], "home")
    assert not robot.on_maps("remove", "second").success
