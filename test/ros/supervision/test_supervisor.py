"""Processes that are killed, stopped, hang or keep ending; and the end of all of them."""

import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.processes.programs import Program, is_running
from fixtures.waiting import wait_until

HEAD = """
import os, signal, sys, time
from roomba.configuration.nodes import SupervisionConfig
from roomba_ros.runtime.timing.heart import HEART
from roomba_ros.supervision.supervisor import Supervisor

def live():
    ended = []
    signal.signal(signal.SIGINT, lambda *_: ended.append(1))
    HEART.begin()
    while not ended:
        HEART.beat()
        time.sleep(0.01)

def hang():
    HEART.begin()
    HEART.beat()
    time.sleep(1000.0)

def stubborn():
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    HEART.begin()
    while True:
        HEART.beat()
        time.sleep(0.01)

config = SupervisionConfig(
    busy=0.5, stopped=1.0, hung=2.0, back_after=0.05, most_short_lives=4, short_life=20.0
)
supervisor = Supervisor(config)
"""
TAIL = "\nstatus = supervisor.run()\nprint('all ended')\nsys.stdout.flush()\nos._exit(status)\n"


class Supervised:
    """A supervisor with some processes."""

    def __init__(self, folder: Path, *lines: str) -> None:
        script = folder / "supervised.py"
        script.write_text(HEAD + "\n".join(lines) + TAIL, encoding="utf-8")
        self.program = Program([sys.executable, str(script)], dict(os.environ), folder / "log")

    def pids(self, name: str) -> list[int]:
        """Return the ids of a process, one for each start."""
        lines = [line for line in self.program.output.splitlines() if f"] {name}: started" in line]
        return [int(line.rpartition(" ")[2]) for line in lines]

    def starts(self, name: str, times: int) -> int:
        """Wait until a process was started so often; return its newest id."""
        wait_until(lambda: len(self.pids(name)) >= times, 20.0, lambda: self.program.output)
        return self.pids(name)[-1]


@pytest.fixture
def run(tmp_path: Path, request: pytest.FixtureRequest) -> Callable[..., Supervised]:
    """Run a supervisor until the test ends."""

    def begin(*lines: str) -> Supervised:
        made = Supervised(tmp_path, *lines)
        request.addfinalizer(made.program.clean_up)
        return made

    return begin


Run = Callable[..., Supervised]


def test_a_killed_process_is_back_and_the_others_stay(run: Run) -> None:
    robot = run("supervisor.add('one', live)", "supervisor.add('two', live)")
    one, two = robot.starts("one", 1), robot.starts("two", 1)
    os.kill(two, signal.SIGKILL)
    assert robot.starts("two", 2) != two
    assert "two was ended by SIGKILL; it is started anew" in robot.program.output
    assert robot.pids("one") == [one]


def test_a_stopped_process_is_told_and_replaced(run: Run) -> None:
    robot = run("supervisor.add('one', live)")
    os.kill(robot.starts("one", 1), signal.SIGSTOP)
    robot.program.says("one is stopped; if it stays so, it is started anew", 20.0)
    robot.starts("one", 2)


def test_a_process_that_hangs_is_told_and_replaced(run: Run) -> None:
    robot = run("supervisor.add('one', hang)")
    robot.program.says("one has not answered for 1 s", 20.0)
    robot.starts("one", 2)


def test_a_process_that_keeps_ending_is_given_up_and_the_others_go_on(run: Run) -> None:
    robot = run("supervisor.add('one', live)", "supervisor.add('two', lambda: sys.exit(7))")
    robot.program.says("two keeps ending (ended with status 7) and is not started any more", 20.0)
    assert len(robot.pids("two")) == 4
    assert is_running(robot.starts("one", 1))
    assert robot.program.status is None


def test_lives_without_a_master_do_not_count(run: Run, tmp_path: Path) -> None:
    up = tmp_path / "up"
    robot = run(
        "def be_master():",
        "    time.sleep(1.5)",
        f"    open({str(up)!r}, 'w').close()",
        "    live()",
        "supervisor.add('master', be_master, is_master=True)",
        f"supervisor.add('one', lambda: live() if os.path.exists({str(up)!r}) else sys.exit(1))",
        "supervisor.add('two', lambda: sys.exit(7))",
    )
    robot.starts("one", 8)
    wait_until(up.exists, 20.0, "the master is up")
    robot.program.says("two keeps ending (ended with status 7) and is not started any more", 20.0)
    assert len(robot.pids("two")) > 8
    wait_until(lambda: is_running(robot.pids("one")[-1]), 20.0, "it lives")
    assert "one keeps ending" not in robot.program.output


def test_all_end_with_a_required_one_and_with_its_status(run: Run) -> None:
    robot = run(
        "supervisor.add('one', live)",
        "supervisor.add('two', lambda: sys.exit(3), is_required=True)",
    )
    assert robot.program.ends(20.0) == 3
    assert not is_running(robot.pids("one")[0])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_told_to_end_all_end_and_the_stubborn_are_killed(run: Run, number: signal.Signals) -> None:
    robot = run("supervisor.add('one', live)", "supervisor.add('two', stubborn)")
    pids = [robot.starts("one", 1), robot.starts("two", 1)]
    robot.program.says("two: started", 10.0)
    wait_until(lambda: _ignores(pids[1]), 20.0, "it is stubborn")
    robot.program.send_to_leader(number)
    assert robot.program.ends(20.0) == 0
    assert "two has not ended yet: SIGKILL" in robot.program.output
    assert "one has not ended yet" not in robot.program.output
    assert not any(map(is_running, pids))


def test_under_nohup_it_goes_on_when_its_terminal_is_lost(run: Run) -> None:
    ignores = "(signal.signal(signal.SIGHUP, signal.SIG_IGN), Supervisor(SupervisionConfig()))[1]"
    robot = run(f"supervisor = {ignores}", "supervisor.add('one', live)")
    pid = robot.starts("one", 1)
    robot.program.send_to_leader(signal.SIGHUP)
    os.kill(pid, signal.SIGKILL)
    robot.starts("one", 2)
    robot.program.send_to_leader(signal.SIGTERM)
    assert robot.program.ends(20.0) == 0


def test_all_end_when_the_supervisor_is_killed(run: Run) -> None:
    robot = run("supervisor.add('one', live)", "supervisor.add('two', stubborn)")
    pids = [robot.starts("one", 1), robot.starts("two", 1)]
    robot.program.send_to_leader(signal.SIGKILL)
    wait_until(lambda: not any(map(is_running, pids)), 10.0, "all ended")


def test_each_change_is_told_to_the_pipe(run: Run) -> None:
    robot = run(
        "pipe = supervisor.tell_to()",
        "def tell():\n    HEART.begin()\n    while True:\n"
        "        print('heard', os.read(pipe, 99999).decode(), flush=True)",
        "supervisor.add('one', live)",
        "supervisor.add('two', tell)",
    )
    os.kill(robot.starts("one", 1), signal.SIGKILL)
    robot.starts("one", 2)
    robot.program.says('"one": ""', 20.0)
    # A reader may get several lines at once.
    told = [line[line.index("{") :] for line in robot.program.output.splitlines() if "{" in line]
    assert any("it is started anew" in json.loads(line)["one"] for line in told)


def _ignores(pid: int) -> bool:
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    (mask,) = (int(line.split()[1], 16) for line in lines if line.startswith("SigIgn"))
    return bool(mask >> (signal.SIGTERM - 1) & 1)


def test_a_program_without_signs_of_life_is_watched_for_its_end_alone(run: Run) -> None:
    sleep = "lambda: os.execv('/bin/sleep', ['sleep', '1000'])"
    robot = run(f"supervisor.add('one', {sleep})")
    first = robot.starts("one", 1)
    os.kill(first, signal.SIGKILL)
    second = robot.starts("one", 2)
    os.kill(second, signal.SIGSTOP)
    assert robot.starts("one", 3) not in (first, second)
    assert "has not answered" not in robot.program.output


def test_what_is_not_kept_may_end(run: Run) -> None:
    sleep = "lambda: os.execv('/bin/sleep', ['sleep', '1000'])"
    robot = run("supervisor.add('one', live)", f"supervisor.add('window', {sleep}, is_kept=False)")
    window = robot.starts("window", 1)
    # Before it is another program it has the supervisor's way with signals.
    comm = Path(f"/proc/{window}/comm")
    wait_until(lambda: comm.read_text(encoding="ascii") == "sleep\n", 20.0, "it is a program")
    os.kill(window, signal.SIGTERM)
    wait_until(lambda: "window was ended by SIGTERM" in robot.program.output, 20.0)
    one = robot.starts("one", 1)
    os.kill(one, signal.SIGKILL)
    robot.starts("one", 2)
    assert len(robot.pids("window")) == 1
    assert "it is started anew" in robot.program.output
    assert "window was ended by SIGTERM; " not in robot.program.output
