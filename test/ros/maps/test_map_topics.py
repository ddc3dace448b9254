"""The robot's own maps: recognized, changed when a person agrees, unused where a map is given."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.mapping_home import (
    CHEST,
    KITCHEN,
    STATION,
    ZONE,
    home_map,
    keep_home_map,
    kept_maps,
    mapping_home,
    other_home,
)
from fixtures.nodes.explorer import SPEED, Explorer
from fixtures.waiting import wait_until
from roomba_robot.msg import Localization, Rectangle, ZoneArray

from roomba.grid import OCCUPIED

HOME = "home"
BEFORE_CHEST = Rectangle(2.8, 0.6, 4.4, 1.8)
LOOKS = 2
"""Passes before the chest: in the time of one it is seen often enough to be offered, or not."""
BY_STATION = Rectangle(0.4, 0.9, 0.9, 1.6)
CELL = 0.05


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    """Nothing yet, but a saved map of the home."""
    with RosGraph(tmp_path) as own:
        keep_home_map(tmp_path / "ros_home", HOME)
        yield own


def knows_its_place(robot: Explorer) -> None:
    """Wait until it does, and see that it is right."""
    wait_until(
        lambda: robot.probe.next("/localization", Localization).state == Localization.KNOWN,
        15.0,
        "it knows its place",
    )
    wait_until(lambda: STATION.distance_to(*robot.probe.position()) < 0.06, 30.0, "it is right")


@contextmanager
def stays_known(robot: Explorer) -> Iterator[None]:
    """See that the place is not lost, from before something is done until after it.

    By wheels and gyro for a moment is well: on a busy machine scans come late.
    """
    heard: list[Localization] = []
    subscriber = rospy.Subscriber("/localization", Localization, heard.append)
    wait_until(lambda: len(heard) >= 2, 30.0, "its place is told")
    yield
    after = len(heard)
    wait_until(lambda: len(heard) >= after + 4, 30.0, "its place is told on")
    subscriber.unregister()
    sound = (Localization.KNOWN, Localization.ROUGH)
    assert [told.message for told in heard if told.state not in sound] == []
    assert STATION.distance_to(*robot.probe.position()) < 0.06


def chest_cells(robot: Explorer) -> int:
    """Return how many cells are occupied where the chest stands, on the newest map."""
    shown = robot.map
    x_min, y_min, x_max, y_max = CHEST
    low, left = shown.frame.cell_of(x_min, y_min)
    high, right = shown.frame.cell_of(x_max - 0.01, y_max - 0.01)
    return int((shown.values[low : high + 1, left : right + 1] == OCCUPIED).sum())


def test_a_floor_is_known_again(graph: RosGraph) -> None:
    graph.launch(f"home:={mapping_home(graph.folder)}", "map:=own", SPEED)
    robot = Explorer(graph)
    zones: list[ZoneArray] = []
    rospy.Subscriber("/zones", ZoneArray, zones.append)
    robot.has_whole_map()
    wait_until(lambda: robot.mapping.name == HOME, 30.0, "it is known by name")
    assert (robot.mapping.is_own, robot.mapping.message) == (True, "")
    assert np.array_equal(robot.map.values, home_map().values)
    knows_its_place(robot)
    wait_until(lambda: KITCHEN in robot.rooms, 30.0, "its room's name")
    wait_until(
        lambda: zones and [zone.name for zone in zones[-1].zones] == [ZONE.name], 5.0, "its zone"
    )
    refused = robot.explore().ends(GoalStatus.REJECTED, 3.0)
    assert "map:=none" in refused.message


@pytest.mark.thorough
def test_another_floor_is_mapped_and_then_cleaned(graph: RosGraph) -> None:
    graph.launch(f"home:={other_home(graph.folder)}", "map:=own", SPEED)
    robot = Explorer(graph)
    robot.maps_with("explore")
    assert "was never on this floor" in graph.programs[0].output
    assert (robot.mapping.is_growing, robot.mapping.name) == (True, "")
    refused = robot.on_maps("load", HOME)
    assert not refused.success
    assert "map/finish" in refused.message
    refused = robot.on_maps("save", HOME)
    assert not refused.success
    assert "explore first" in refused.message

    exploring = robot.explore()
    wait_until(robot.drives, 30.0, "it drives")
    robot.inject("lifted")
    exploring.ends(GoalStatus.ABORTED, 10.0)
    robot.inject("put", x=STATION.x, y=STATION.y, theta=STATION.theta)
    knows_its_place(robot)

    robot.cleans(BY_STATION)
    assert "cleaning" in robot.phases
    robot.explore().ends()
    robot.has_whole_map()

    # By the name of another floor's map it is not saved, and nothing is lost.
    maps = kept_maps(graph.folder / "ros_home")
    before = maps.load(HOME)
    refused = robot.on_maps("save", HOME)
    assert not refused.success
    for words in ("expected the floor of the map 'home'", "another name", "map/remove"):
        assert words in refused.message
    assert maps.load(HOME).is_same(before)
    (maps.folder / HOME / "map.yaml").write_text("no map", encoding="utf-8")
    refused = robot.on_maps("save", HOME)
    assert not refused.success
    for words in ("cannot be read", "map.yaml", "another name", "map/remove"):
        assert words in refused.message
    assert (maps.folder / HOME / "map.yaml").read_text(encoding="utf-8") == "no map"
    assert robot.mapping.name == ""
    refused = robot.on_maps("save", "own")
    assert not refused.success
    assert "says how to begin" in refused.message
    assert robot.on_maps("save", "hallway").success
    assert robot.on_maps("remove", HOME).success
    assert robot.on_maps("save", HOME).success
    assert robot.saved_maps() == (["hallway", HOME], HOME)


@pytest.mark.thorough
def test_what_changed_is_offered_refused_and_accepted(graph: RosGraph) -> None:
    home = mapping_home(graph.folder, "with_chest", has_chest=True)
    graph.launch(f"home:={home}", f"map:={HOME}", SPEED)
    robot = Explorer(graph)
    robot.has_whole_map()
    knows_its_place(robot)
    assert not robot.trigger("/map/update/accept").success
    before = chest_cells(robot)

    robot.cleans(BEFORE_CHEST, passes=LOOKS)
    wait_until(lambda: robot.offers, 30.0, "the chest is offered")
    offer = robot.offers[0]
    assert (len(robot.offers), offer.appeared) == (1, True)
    # It is the middle of what was seen of it, and one side may be all that was.
    x_min, y_min, x_max, y_max = CHEST
    assert x_min - CELL <= offer.middle.x <= x_max + CELL
    assert y_min - CELL <= offer.middle.y <= y_max + CELL
    assert robot.trigger("/map/update/refuse").success
    wait_until(lambda: not robot.offers, 30.0, "it is offered no more")
    robot.cleans(BY_STATION)
    assert robot.offers == []
    assert chest_cells(robot) == before

    with stays_known(robot):
        assert robot.on_maps("load", HOME).success
    robot.cleans(BEFORE_CHEST, passes=LOOKS)
    wait_until(lambda: robot.offers, 30.0, "the chest is offered")
    with stays_known(robot):
        assert robot.trigger("/map/update/accept").success
        wait_until(lambda: chest_cells(robot) > before + 10, 30.0, "the map shows it")
    wait_until(lambda: not robot.offers, 30.0, "nothing more is offered")
    stored = kept_maps(graph.folder / "ros_home").load(HOME)
    assert np.array_equal(stored.occupancy.values, robot.map.values)
    assert stored.zones.all == (ZONE,)
    assert stored.rooms is not None
    assert KITCHEN in stored.rooms.names
    with stays_known(robot):
        assert robot.trigger("/map/update/undo").success
        wait_until(lambda: chest_cells(robot) == before, 30.0, "the map as it was")
    kept = kept_maps(graph.folder / "ros_home").load(HOME).occupancy
    assert np.array_equal(kept.values, robot.map.values)
    refused = robot.trigger("/map/update/undo")
    assert not refused.success
    assert "to take back" in refused.message


@pytest.mark.thorough
def test_a_robot_that_was_given_its_map_makes_none(graph: RosGraph) -> None:
    graph.launch(f"home:={mapping_home(graph.folder)}", SPEED)
    robot = Explorer(graph)
    wait_until(lambda: "/mapping" in robot.probe.newest, 30.0, "whose map it is")
    assert not robot.mapping.is_own
    refused = robot.explore().ends(GoalStatus.REJECTED, 3.0)
    assert "nothing to explore" in refused.message
    answers = [robot.trigger(f"/map/{name}") for name in ("finish", "update/accept")]
    answers += [robot.on_maps(deed, HOME) for deed in ("save", "load", "remove")]
    assert not any(answer.success for answer in answers)
    assert all("was given its map" in answer.message for answer in answers)
    assert robot.saved_maps() == ([HOME], "")
