"""A robot without a map explores with a person about, and knows the home again when it saves."""

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.homes.mapping_home import (
    FLOOR,
    GOOD_SHARE,
    KITCHEN,
    MARGIN,
    ZONE,
    keep_home_map,
    kept_maps,
    mapping_home,
    stray_cells,
)
from fixtures.nodes.explorer import SPEED, Explorer
from fixtures.waiting import wait_until
from roomba_robot.msg import ZoneArray

LONGEST = 110.0
"""s of wall time: in a narrow door the two make room for each other, again and again."""

OUTLINE = 12
"""Cells: what a lidar sees of a person of 0.3 m, from one side."""


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    """The name of the robot's map of the home was mistyped: it begins a new one.

    A person walks about there. ``./roomba run`` would refuse that name.
    """
    with RosGraph(tmp_path) as own:
        keep_home_map(tmp_path / "ros_home", "home")
        own.roslaunch(f"home:={mapping_home(tmp_path, has_walker=True)}", "map:=hom", SPEED)
        yield own


def test_with_a_person_about_and_killed_it_maps_the_home_anew(graph: RosGraph) -> None:
    robot = Explorer(graph)
    assert "did you mean 'home'?" in robot.maps_with("explore").message
    zones: list[ZoneArray] = []
    rospy.Subscriber("/zones", ZoneArray, zones.append)
    robot.explore()
    robot.does("exploring")
    wait_until(robot.drives, 30.0, "it drives")
    before = robot.mapping.known
    graph.signal("mission_node", signal.SIGKILL)
    wait_until(lambda: not graph.answers("mission_node"), 30.0, "it is gone")
    robot.phases.clear()
    robot.does("exploring", 30.0)
    assert robot.mapping.is_growing
    assert robot.mapping.known > 0.95 * before
    robot.does("docked", LONGEST)
    robot.has_whole_map()
    # Ann walked about all the time: of where she was seen last her outline may be left.
    assert stray_cells(robot.map, MARGIN) <= OUTLINE
    assert robot.map.free_area == pytest.approx(FLOOR, rel=2.0 * GOOD_SHARE)

    assert KITCHEN not in robot.rooms
    assert robot.on_maps("save", "home").success
    wait_until(lambda: KITCHEN in robot.rooms, 30.0, "the room has its name again")
    wait_until(
        lambda: zones and [zone.name for zone in zones[-1].zones] == [ZONE.name],
        30.0,
        "the zone is there again",
    )
    stored = kept_maps(graph.folder / "ros_home").load("home")
    assert [zone.name for zone in stored.zones.all] == [ZONE.name]
    # In the frame of the new map, as it was on the floor.
    assert np.array(stored.zones.all[0].points) == pytest.approx(np.array(ZONE.points), abs=0.06)
    assert stored.rooms is not None
    assert stored.rooms.names[stored.rooms.at(1.0, 1.0) - 1] == KITCHEN
