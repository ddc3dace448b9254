"""A clean that begins before the map is whole, in a home that the robot has never seen."""

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.mapping_home import other_home
from fixtures.nodes.explorer import LONG, SPEED, Explorer, is_growing
from fixtures.waiting import wait_until
from roomba_robot.msg import CleanGoal, VacuumState

FLOOR = 3.6 * 1.8 - 0.4 * 0.8
"""m2."""
UNREACHED = 0.25
"""Of the floor: corners, and what is beside the station, no round tool reaches."""


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    """A robot that knows nothing of its home."""
    with RosGraph(tmp_path) as own:
        own.launch(f"home:={other_home(tmp_path)}", "map:=none", SPEED)
        yield own


def test_a_home_is_cleaned_while_it_is_mapped_though_the_node_is_killed(graph: RosGraph) -> None:
    robot = Explorer(graph)
    states: list[VacuumState] = []
    rospy.Subscriber("/vacuum/state", VacuumState, states.append)
    rooms = CleanGoal(mode=CleanGoal.ROOMS, rooms=["kitchen"])
    refused = robot.clean(rooms).ends(GoalStatus.REJECTED, 30.0)
    assert "clean the whole home" in refused.message

    clean = robot.clean(CleanGoal())
    robot.does("cleaning")
    wait_until(lambda: clean.feedback and clean.feedback[-1].covered > 0.3, 30.0, "it cleans")
    covered = states[-1].covered
    # The first that is written from now on may be of before.
    for _ in range(2):
        wait_until_remembered(graph)
    assert is_growing(robot.maps[-1]), "the map is not whole yet"

    graph.signal("mission_node", signal.SIGKILL)
    wait_until(lambda: not graph.answers("mission_node"), 30.0, "it is gone")
    robot.phases.clear()
    states.clear()
    robot.does("cleaning", 30.0)
    wait_until(lambda: states and states[-1].wanted > 0.0, 30.0, "it tells how much there is")
    assert states[-1].covered >= covered, "what was clean is known to be"
    wait_until(lambda: not is_growing(robot.maps[-1]), LONG, "the map becomes whole")
    robot.does("docked", LONG)
    assert "exploring" not in robot.phases
    done = [state for state in states if state.wanted > 0.0][-1]
    assert (1.0 - UNREACHED) * FLOOR < done.wanted < FLOOR
    # On a busy machine it touches a wall now and then, and leaves the floor there for later.
    assert done.fraction > 0.9


def wait_until_remembered(graph: RosGraph) -> None:
    """Wait until the mission writes once more what it did."""
    before = when_remembered(graph)
    wait_until(lambda: when_remembered(graph) != before, 30.0, "it is remembered")


def when_remembered(graph: RosGraph) -> int:
    """Return when the mission last wrote what it did on a map that grows; 0 before it did."""
    path = graph.folder / "ros_home" / "roomba_robot" / "mission" / "robot" / "growing.json"
    return path.stat().st_mtime_ns if path.exists() else 0
