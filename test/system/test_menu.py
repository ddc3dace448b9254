"""The menu on the whole robot, typed as a user does."""

import re
import signal
from collections.abc import Iterator

import pytest
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes.forked import run_forked
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot, twice as fast as real time."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch("speed:=2")
        run_forked(lambda: Probe(own).position())
        yield own


def menu_of(graph: RosGraph) -> Program:
    menu = graph.rosrun("control_node.py")
    menu.says("Select: ", 30.0)
    return menu


def test_all_four_choices(shared_robot: RosGraph) -> None:
    menu = menu_of(shared_robot)
    menu.type("1")
    menu.says(" g", 30.0)
    menu.type("2")
    wait_until(lambda: menu.output.count("Select: ") == 3, 30.0)
    menu.type("3")
    menu.says(" X is equal to ", 30.0)
    menu.type("far away")
    menu.type("1000")
    menu.type("1.2")
    menu.says(" Y is equal to ", 30.0)
    menu.type("1.6")
    wait_until(lambda: menu.output.count("Select: ") == 4, 30.0, menu.output)
    menu.type("4")
    wait_until(lambda: menu.output.count("Select: ") == 5, 30.0)
    menu.type("4")
    wait_until(lambda: menu.output.count("Select: ") == 6, 30.0)
    menu.end_of_input()
    assert menu.ends(30.0) == 0
    output = menu.output
    assert output.count(" X is equal to ") == 3
    assert re.search(r"2\.0\d? m", output)
    assert "already" in output.lower()


def test_ctrl_c_during_a_walk_cancels_it_and_leads_back(shared_robot: RosGraph) -> None:
    menu = menu_of(shared_robot)
    for line in ("3", "3.0", "4.0"):
        menu.type(line)
    wait_until(lambda: len(re.findall(r"m left|left", menu.output)) >= 2, 20.0, menu.output)
    menu.send(signal.SIGINT)
    wait_until(lambda: menu.output.count("Select: ") == 2, 30.0, menu.output)
    menu.type("4")
    wait_until(lambda: menu.output.count("Select: ") == 3, 40.0)
    menu.send(signal.SIGINT)
    assert menu.ends(30.0) == 130


def test_a_refused_destination_is_told_with_the_reason(shared_robot: RosGraph) -> None:
    menu = menu_of(shared_robot)
    for line in ("3", "60", "60"):
        menu.type(line)
    menu.says("nearest reachable point", 30.0)
    menu.end_of_input()
    assert menu.ends(30.0) == 0


@pytest.mark.thorough
def test_a_clean_is_left_held_up_stopped_and_the_robot_docked(shared_robot: RosGraph) -> None:
    menu = menu_of(shared_robot)
    menu.type("5")
    menu.says("What to clean", 30.0)
    menu.type("3")
    menu.says("Cleaned: ", 60.0)
    menu.send(signal.SIGINT)
    menu.says("The robot goes on by itself", 30.0)
    menu.type("9")
    menu.says("State: cleaning", 30.0)
    menu.type("6")
    menu.says("The robot pauses", 30.0)
    menu.type("6")
    menu.says("The robot goes on.", 30.0)
    menu.type("7")
    menu.says("The robot has stopped", 30.0)
    menu.type("8")
    menu.says("The robot is on its charging station.", 60.0)
    menu.send(signal.SIGINT)
    assert menu.ends(30.0) == 130
