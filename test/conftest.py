"""Settings of all tests: the hypothesis profile, their order, and ROS graphs for those that ask."""

from __future__ import annotations

import gc
import os
import signal
import time
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.processes.forked import run_forked
from fixtures.thoroughness import examples, is_thorough
from fixtures.waiting import wait_until
from hypothesis import HealthCheck, settings

# The same examples in every run, and no deadline on slow machines.
settings.register_profile(
    "project",
    max_examples=examples(100),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    derandomize=True,
)
settings.load_profile("project")

RosGraph.forks = True

# A container may have no time zone set, about which the programs print a warning.
os.environ["TZ"] = "UTC"
time.tzset()

# Tests that are started in the background inherit that Ctrl-C is ignored, and so would the
# programs that they start: these would end after their deadlines only.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def own_history(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Keep runs and token of the tests, and of programs that they start, away from the user's."""
    os.environ["ROOMBA_HISTORY"] = str(tmp_path_factory.mktemp("history"))
    os.environ["ROOMBA_HOUSEHOLD"] = str(tmp_path_factory.mktemp("household"))
    os.environ["ROOMBA_TOKEN_FILE"] = str(tmp_path_factory.mktemp("token") / "token")


TESTS = Path(__file__).resolve().parent
LONGEST_FIRST = (
    "test_standstill.py",
    "test_tutorials.py",
    "test_conformance.py",
    "test_faults.py",
    "test_supervision.py",
    "test_page.py",
    "test_turn_camera.py",
    "test_map_topics.py",
    "test_mission_node.py",
    "test_refused_messages.py",
    "test_bags.py",
    "test_clean.py",
    "test_pictures.py",
    "test_walk_to_point_action_server.py",
    "test_programs.py",
    "test_home_sim_sensors.py",
    "test_seed.py",
    "test_menu.py",
    "test_home_sim_node.py",
    "test_map_kept.py",
    "test_foreign_robot.py",
    "test_namespaces.py",
    "test_walk.py",
    "test_speed_pub_node.py",
    "test_localization.py",
    "test_position_pub_node.py",
    "test_explore.py",
    "test_page_on_graph.py",
    "test_clock.py",
    "test_control_node.py",
    "test_record.py",
    "test_connections.py",
    "test_ros_interface.py",
)
"""Files that take longest run first, so that no worker still has one when the others have ended;
files that wait alternate with files that compute."""


SLOW = (
    "unit/roomba_bench",
    "unit/commands/localize",
    "unit/commands/map",
    "unit/commands/pictures/test_pictures.py",
    "unit/headless",
    "unit/mission/test_mission.py",
    "unit/mission/walking",
    "unit/perception/floors",
    "unit/perception/slam",
    "unit/planning/coverage",
    "unit/robot/test_any_fault.py",
    "unit/robot/test_told_is_true.py",
    "unit/test_spoiled_files.py",
    "unit/ui",
    "unit/world/engine",
    "unit/world/test_fleet.py",
)
"""Folders and files whose tests take two thirds of the time of all unit tests."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Run the files that take longest first, and mark slow tests.

    Tests that are marked ``thorough`` are left out unless a thorough run is asked for.
    """
    left_out = set() if is_thorough() else {item for item in items if "thorough" in item.keywords}
    items[:] = [item for item in items if item not in left_out]
    config.hook.pytest_deselected(items=list(left_out))
    for item in items:
        path = item.path.relative_to(TESTS).as_posix()
        if path.startswith(SLOW):
            item.add_marker(pytest.mark.slow)
    rank = {name: rank for rank, name in enumerate(LONGEST_FIRST)}
    items.sort(key=lambda item: rank.get(item.path.name, len(rank)))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect no garbage while tests are collected, and later ignore the objects made meanwhile.

    There are millions of these objects, and all of them stay alive.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Run a test that uses a graph in a process of its own: so each can be a node of its graph."""
    if not any(isinstance(value, RosGraph) for value in pyfuncitem.funcargs.values()):
        return None
    names = pyfuncitem._fixtureinfo.argnames
    arguments = {name: pyfuncitem.funcargs[name] for name in names}
    run_forked(lambda: pyfuncitem.obj(**arguments))
    return True


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    """A bare master."""
    with RosGraph(tmp_path) as own:
        own.start_master()
        yield own


@pytest.fixture(scope="module")
def master(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A bare master for a module whose tests leave it as it was."""
    with RosGraph(tmp_path_factory.mktemp("master")) as own:
        own.start_master()
        yield own


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[RosGraph]:
    """The whole robot, launched for one test; it may be broken."""
    with RosGraph(tmp_path) as own:
        own.launch()
        yield own


@pytest.fixture(scope="module")
def robot_with_page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot with its web page, launched once for a module."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch("page:=true", "page_port:=0")
        wait_until(lambda: "The page: " in own.programs[-1].output, START_DEADLINE, "the page")
        yield own


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot, once for a module whose tests leave it as it was."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        own.launch()
        yield own
