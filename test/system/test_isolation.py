"""A robot in a network of its own: its page is reached from outside, and nothing else is."""

import ctypes
import http.client
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial

import pytest
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.processes.forked import run_forked
from fixtures.processes.programs import Program, listening, processes_of
from fixtures.waiting import promised, wait_until

from roomba_ros.supervision.isolation import FLAG
from roomba_ros.supervision.namespace import IsolationError, has_own_network, isolate

STRANGER = 65534
"""A user without rights."""
SET_DUMPABLE = 4
"""PR_SET_DUMPABLE of prctl(2)."""
ENDED = 3.0
BACK = 5.0
"""s of wall time, as promised: until nothing is left after Ctrl-C, until a killed node is back."""


def _can(*options: str) -> bool:
    return subprocess.run(["unshare", *options, "true"], check=False, timeout=20.0).returncode == 0


needs_namespaces = pytest.mark.skipif(
    not (_can("--net") or _can("--user", "--net")),
    reason="this kernel gives no network namespaces to this user",
)


@pytest.fixture(scope="module")
def isolated(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A robot with its page in a network of its own; all of it is asked by commands inside."""
    with RosGraph(tmp_path_factory.mktemp("robot")) as own:
        run = own.start_run(FLAG, "page:=true", "page_port:=0", "home:=studio")
        run.says("The page: ", START_DEADLINE)
        yield own


def page_port(run: Program) -> int:
    found = re.search(r"The page: http://127\.0\.0\.1:(\d+)/", run.output)
    assert found, run.output
    return int(found[1])


def state_code(port: int) -> int:
    """Ask the page's server for the robot's state; return the code of the answer, 0 without one."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10.0)
    try:
        connection.request("GET", "/api/v1/state")
        return connection.getresponse().status
    except OSError:
        return 0
    finally:
        connection.close()


def inside(graph: RosGraph, *command: str) -> subprocess.CompletedProcess[str]:
    """Run a command in the robot's network, as ``./roomba exec --isolated`` does."""
    return subprocess.run(
        [sys.executable, "-m", "roomba_ros.supervision.enter", *command],
        env=graph.environment,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )


@needs_namespaces
def test_only_the_page_is_reached_from_outside(isolated: RosGraph) -> None:
    (run,) = isolated.programs
    port = page_port(run)
    wait_until(lambda: state_code(port) == 200, 30.0, "the page tells the robot's state")
    assert listening(processes_of(run.process.pid)) == {("127.0.0.1", port)}
    assert not isolated.master_answers()


@needs_namespaces
def test_commands_find_it_inside_and_nothing_outside(isolated: RosGraph) -> None:
    listed = inside(isolated, "rostopic", "list")
    assert "/vacuum/state" in listed.stdout, listed.stderr
    with socket.create_server(("127.0.0.1", 0)) as other:
        ask = f"import socket; socket.create_connection(('127.0.0.1', {other.getsockname()[1]}), 5)"
        assert "ConnectionRefusedError" in inside(isolated, sys.executable, "-c", ask).stderr
    assert inside(isolated, "no-such-program").returncode == 127


@needs_namespaces
def test_a_second_one_is_refused(isolated: RosGraph) -> None:
    second = isolated.start_run(FLAG)
    assert second.ends(30.0) == 2
    assert "expected no isolated robot" in second.output


@needs_namespaces
def test_a_page_that_was_killed_is_back_at_its_port(isolated: RosGraph) -> None:
    (run, *_) = isolated.programs
    port = page_port(run)
    os.kill(isolated.process("dashboard_node"), signal.SIGKILL)
    promised(lambda: state_code(port) == 200, BACK, "the page answers at the same port")
    # Its line may be read a moment after the page answers.
    wait_until(lambda: run.output.count("The page: ") == 2, 5.0, "the page is told again")


@needs_namespaces
def test_it_ends_as_any_robot_and_leaves_nothing(isolated: RosGraph) -> None:
    (run, *_) = isolated.programs
    processes = processes_of(run.process.pid)

    def nothing_is_left() -> bool:
        left = any(os.path.exists(f"/proc/{process}/exe") for process in processes)
        return run.status is not None and not left

    os.kill(run.process.pid, signal.SIGINT)
    promised(nothing_is_left, ENDED, "it has ended, and all that it started")
    assert "has not ended yet" not in run.output
    assert "expected an isolated robot, and none runs" in inside(isolated, "true").stderr


def _as_stranger(check: Callable[[], None]) -> None:
    if os.geteuid() == 0:
        os.setgroups([])
        os.setresgid(STRANGER, STRANGER, STRANGER)
        os.setresuid(STRANGER, STRANGER, STRANGER)
        # So that its files in /proc are its own, as those of a program that it starts are.
        assert ctypes.CDLL(None).prctl(SET_DUMPABLE, 1) == 0
    check()


def _isolates_and_stays_who_it_is() -> None:
    before = os.geteuid(), os.getegid()
    assert not has_own_network()
    isolate()
    assert has_own_network()
    assert (os.geteuid(), os.getegid()) == before
    with socket.create_server(("127.0.0.1", 0)) as server:
        socket.create_connection(server.getsockname(), 5.0).close()


@pytest.mark.skipif(not _can("--user", "--net"), reason="this kernel gives no namespaces to users")
def test_a_user_without_rights_gets_one_too() -> None:
    run_forked(partial(_as_stranger, _isolates_and_stays_who_it_is), 30.0)


def test_without_the_right_to_it_the_reason_is_told() -> None:
    def refuse(_: int) -> None:
        raise PermissionError(1, "Operation not permitted")

    with pytest.raises(IsolationError, match="needs root, or a kernel that gives namespaces"):
        isolate(refuse)
