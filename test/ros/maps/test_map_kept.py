"""A growing map outlives the node that makes it; after a damaged file a new map begins."""

import re
import signal
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.mapping_home import (
    FLOOR,
    KITCHEN,
    STATION,
    ZONE,
    keep_home_map,
    kept_maps,
    mapping_home,
    stray_cells,
)
from fixtures.nodes.explorer import SPEED, Explorer, free_cells, is_growing
from fixtures.waiting import wait_until
from roomba_robot.msg import Localization
from roomba_robot.srv import NameMapResponse

from roomba.files.kept import before_of
from roomba.grid import OccupancyMap
from roomba.storage.map_bound import map_digest
from roomba.storage.mapper import KeptMap, load_mapper, save_mapper
from roomba_ros.maps.map_memory import FOLDER

NODE = "position_pub_node"
HOME = "home"


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    with RosGraph(tmp_path) as own:
        yield own


def file_of(graph: RosGraph) -> Path:
    return graph.folder / "ros_home" / "roomba_robot" / "maps" / FOLDER / "robot" / "map.npz"


def rooms_file(graph: RosGraph, occupancy: OccupancyMap) -> Path:
    folder = graph.folder / "ros_home" / "roomba_robot" / "rooms"
    return folder / f"{map_digest(occupancy)[:16]}.yaml"


def names_kept(graph: RosGraph, name: str) -> tuple[str, ...]:
    rooms = kept_maps(graph.folder / "ros_home").load(name).rooms
    return () if rooms is None else rooms.names


def kept_keyframes(graph: RosGraph) -> int:
    kept = load_mapper(file_of(graph), pytest.fail)
    return 0 if kept is None else sum(len(submap.keyframes) for submap in kept.state.submaps)


def kill(graph: RosGraph, robot: Explorer) -> None:
    """Kill the node, and forget what it told."""
    graph.signal(NODE, signal.SIGKILL)
    wait_until(lambda: not graph.answers(NODE), 30.0, "it is gone")
    robot.maps.clear()
    robot.probe.newest.pop("/mapping", None)


def grows_again(robot: Explorer) -> None:
    wait_until(
        lambda: (
            robot.maps
            and is_growing(robot.maps[-1])
            and "/mapping" in robot.probe.newest
            and robot.mapping.is_growing
        ),
        30.0,
        "it makes its map again",
    )


def knows_its_place(robot: Explorer) -> None:
    wait_until(
        lambda: robot.probe.next("/localization", Localization).state == Localization.KNOWN,
        15.0,
        "it knows its place",
    )
    wait_until(lambda: STATION.distance_to(*robot.probe.position()) < 0.06, 30.0, "it is right")


@pytest.mark.thorough
def test_a_map_that_is_being_made_outlives_the_node(graph: RosGraph) -> None:
    # Left behind by a run of yesterday, or by an unknown one.
    file_of(graph).parent.mkdir(parents=True)
    file_of(graph).write_bytes(b"of something else")
    keep_home_map(graph.folder / "ros_home", HOME)
    launch = graph.launch(f"home:={mapping_home(graph.folder)}", "map:=none", SPEED)
    robot = Explorer(graph)
    robot.maps_with("explore")
    assert "begins a map of its own" in launch.output
    exploring = robot.explore()
    first_look = free_cells(robot.maps[0])
    wait_until(lambda: free_cells(robot.maps[-1]) > 1.1 * first_look, 30.0, "the map grows")
    shown = kept_keyframes(graph)
    wait_until(lambda: kept_keyframes(graph) > shown, 30.0, "more than the first look is kept")
    kill(graph, robot)
    kept = kept_keyframes(graph)
    grows_again(robot)
    assert "it is taken up" in launch.output
    assert launch.output.count("begins a map of its own") == 1
    assert free_cells(robot.maps[0]) > 1.05 * first_look
    assert kept_keyframes(graph) >= kept
    assert stray_cells(robot.map, 0.11) == 0
    wait_until(lambda: "/station_pose" in graph.system_state()[0], 30.0, "the station is told")

    # The errand goes on as soon as the robot's place is told again.
    exploring.ends(GoalStatus.SUCCEEDED)
    robot.has_whole_map()
    assert free_cells(robot.maps[-1]) * 0.05**2 == pytest.approx(FLOOR, rel=0.06)
    assert stray_cells(robot.map, 0.11) == 0
    wait_until(lambda: STATION.distance_to(*robot.probe.position()) < 0.06, 30.0, "it is right")
    wait_until(lambda: not file_of(graph).exists(), 30.0, "what is whole is not being made")
    # Whole it outlives the node as well, without a name and with one.
    made = robot.map
    kill(graph, robot)
    robot.has_whole_map()
    assert np.array_equal(robot.map.values, made.values)
    assert robot.mapping.name == ""
    knows_its_place(robot)

    # Saved by the name of an older map of this floor, it takes over what people named on that.
    # What cannot be used at once is kept with it.
    in_the_way = rooms_file(graph, robot.map)
    in_the_way.mkdir(parents=True)
    answers: list[NameMapResponse] = []

    def is_saved() -> bool:
        answers.append(robot.on_maps("save", HOME))
        return bool(answers[-1].success)

    wait_until(is_saved, 30.0, "it is saved, its rooms found")
    for words in ("saved as home", "does not go by them", "save it again"):
        assert words in answers[-1].message
    assert robot.saved_maps() == ([HOME], "")
    assert KITCHEN not in robot.rooms
    assert KITCHEN in names_kept(graph, HOME)
    in_the_way.rmdir()
    assert robot.on_maps("save", HOME).message.endswith("roomba_robot/maps")
    wait_until(lambda: KITCHEN in robot.rooms, 30.0, "its room's name")
    assert KITCHEN in names_kept(graph, HOME)
    stored = kept_maps(graph.folder / "ros_home").load(HOME)
    assert [zone.name for zone in stored.zones.all] == [ZONE.name]
    assert np.array(stored.zones.all[0].points) == pytest.approx(np.array(ZONE.points), abs=0.06)

    kill(graph, robot)
    robot.has_whole_map()
    wait_until(lambda: robot.mapping.name == HOME, 30.0, "it goes by its name")
    assert np.array_equal(robot.map.values, made.values)
    knows_its_place(robot)


def spoil(kept: KeptMap, path: Path) -> None:
    path.write_bytes(b"PK")
    before_of(path).unlink(missing_ok=True)


def blame(kept: KeptMap, path: Path) -> None:
    save_mapper(replace(kept, taken_up=5), path)


def leave_behind(kept: KeptMap, path: Path) -> None:
    save_mapper(replace(kept, run="that of yesterday"), path)


@pytest.mark.thorough
def test_what_cannot_be_taken_up_is_said_and_a_new_map_begins(graph: RosGraph) -> None:
    launch = graph.launch(f"home:={mapping_home(graph.folder)}", "map:=none", SPEED)
    robot = Explorer(graph)
    robot.maps_with("explore")
    for begun, (change, words) in enumerate(
        (
            (spoil, "not taken up, a new one is: expected a map that is being made: .*set aside"),
            (blame, "not taken up, a new one is: .* ended 5 times in a row"),
            (leave_behind, ""),
        ),
        2,
    ):
        wait_until(lambda: kept_keyframes(graph) > 0, 30.0, "it is kept")
        kept = load_mapper(file_of(graph), pytest.fail)
        assert kept is not None
        # Else the next process would not know that a map was begun, and leave it unread.
        assert graph.param("/map_to_odometry")
        kill(graph, robot)
        change(kept, file_of(graph))
        grows_again(robot)
        assert launch.output.count("begins a map of its own") == begun
        assert re.search(words, launch.output)
    assert "it is taken up" not in launch.output
