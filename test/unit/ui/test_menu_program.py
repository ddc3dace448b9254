"""The menu as a program of its own: real input, a real terminal, real Ctrl-C."""

from __future__ import annotations

import os
import pty
import re
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import pytest

DEADLINE = 20.0
"""s that a process of these tests has for anything; far more than it needs."""
PROMPT = 1.0
"""s of wall time, promised; alone on the machine it takes a tenth of a second."""


WALKING = r"(m left at|m, current speed:) 2\.00 m/s"
"""What a terminal or a pipe shows of a walk that has begun."""

PROGRAM = """
import signal, sys
signal.signal(signal.SIGINT, lambda number, frame: None)  # rospy's swallows a Ctrl-C, too
from roomba.client.protocol import Limits
from roomba.client.fake.robot import REAL_TIME, FakeRobot, Turn, WalkScript
from roomba.ui.menu import Menu
limits = Limits(low=-100.0, high=100.0, max_speed=2.0)
sys.exit(Menu(FakeRobot(clock=REAL_TIME, limits=limits, scripts=[{scripts}])).run())
"""


def environment() -> dict[str, str]:
    kept = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
    return kept | {"PYTHONPATH": os.pathsep.join(sys.path), "TERM": "xterm"}


class Session:
    """A menu in a process of its own, read with a deadline."""

    def __init__(self, process: subprocess.Popen[bytes], output: int, keyboard: int) -> None:
        self.process = process
        self._output = output
        self._keyboard = keyboard
        self.text = ""

    def type(self, keys: str) -> None:
        os.write(self._keyboard, keys.encode())

    def expect(self, pattern: str) -> None:
        """Read on until a new match of ``pattern``; forget what came before its end."""
        end = time.monotonic() + DEADLINE
        while (match := re.search(pattern, self.text)) is None:
            wait = max(0.0, end - time.monotonic())
            ready, _, _ = select.select([self._output], [], [], wait)
            assert ready, f"no {pattern!r} in {self.text!r}"
            try:
                data = os.read(self._output, 65536)
            except OSError:  # the other end of a pseudo-terminal is closed
                data = b""
            assert data, f"ended without {pattern!r} in {self.text!r}"
            self.text += data.decode(errors="replace")
        self.text = self.text[match.end() :]


Start = Callable[..., Session]


@pytest.fixture(params=["pipe", "terminal"])
def start(request: pytest.FixtureRequest) -> Iterator[Start]:
    """Give a function that starts a menu on a pipe or on a pseudo-terminal."""
    sessions: list[Session] = []
    descriptors: list[int] = []

    def begin(scripts: str = "") -> Session:
        if request.param == "pipe":
            (stdin, keyboard), (output, stdout) = os.pipe(), os.pipe()
            inner = {stdin, stdout}
        else:
            output, stdin = pty.openpty()
            keyboard, stdout, inner = output, stdin, {stdin}
        process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM.format(scripts=scripts)],
            stdin=stdin,
            stdout=stdout,
            stderr=subprocess.STDOUT,
            env=environment(),
            start_new_session=True,
        )
        for descriptor in inner:
            os.close(descriptor)
        descriptors.extend({output, keyboard})
        sessions.append(Session(process, output, keyboard))
        return sessions[-1]

    yield begin
    for session in sessions:
        session.process.kill()
        session.process.wait()
    for descriptor in descriptors:
        os.close(descriptor)


def test_real_ctrl_c_at_the_prompt_leaves_at_once(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    pressed = time.monotonic()
    menu.process.send_signal(signal.SIGINT)
    assert menu.process.wait(DEADLINE) == 130
    assert time.monotonic() - pressed < PROMPT


def test_real_ctrl_c_during_a_walk_returns_to_the_menu(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    menu.type("3\n80\n60\n")
    menu.expect(WALKING)
    menu.process.send_signal(signal.SIGINT)
    menu.expect("The walk was cancelled")
    menu.expect("Select: ")
    menu.process.send_signal(signal.SIGINT)
    assert menu.process.wait(DEADLINE) == 130


def test_real_ctrl_c_after_a_finished_walk_leaves(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    menu.type("3\n1\n0\n")
    menu.expect("The robot has arrived")
    menu.expect("Select: ")
    menu.process.send_signal(signal.SIGINT)
    assert menu.process.wait(DEADLINE) == 130


def test_real_second_ctrl_c_leaves_a_deaf_robot(start: Start) -> None:
    menu = start("WalkScript(obeys=False)")
    menu.expect("Select: ")
    menu.type("3\n80\n60\n")
    menu.expect(WALKING)
    menu.process.send_signal(signal.SIGINT)
    # two signals at the same moment would be one; the menu looks every quarter of a second
    with pytest.raises(subprocess.TimeoutExpired):
        menu.process.wait(0.5)
    menu.process.send_signal(signal.SIGINT)
    assert menu.process.wait(DEADLINE) == 130


@pytest.mark.parametrize("start", ["pipe"], indirect=True)
def test_a_real_frozen_robot_gives_the_menu_back(start: Start) -> None:
    menu = start("WalkScript(Turn.FREEZES, 0.5)")
    menu.expect("Select: ")
    menu.type("3\n80\n60\n")
    menu.expect("The robot was lost after .* has not answered for 6 s")
    menu.expect("Select: ")


@pytest.mark.parametrize("start", ["terminal"], indirect=True)
def test_a_terminal_shows_the_walk_live(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    menu.type("3\n6\n0\n")
    menu.expect("Expected time: 3.0 s")
    menu.expect(r"\x1b\[\?25l")
    menu.expect(r"━.*[3-6]\.\d\d m left at 2.00 m/s")
    menu.expect(r"━.*[0-2]\.\d\d m left at 2.00 m/s")
    menu.expect("━.*0.00 m left at 0.00 m/s")
    menu.expect(r"\x1b\[\?25h")
    menu.expect("The robot has arrived")
    menu.type("\x04")  # Ctrl-D
    assert menu.process.wait(DEADLINE) == 0


@pytest.mark.parametrize("start", ["terminal"], indirect=True)
def test_odd_keys_are_a_wrong_choice(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    menu.type("\x00\x1b[A\n")
    menu.expect("Please choose a valid number")
    menu.expect("Select: ")


def run_on(stdin: bytes, **more: str) -> subprocess.CompletedProcess[bytes]:
    """Run a menu to its end; in 5 s of it the original wrote half a million lines."""
    return subprocess.run(
        [sys.executable, "-c", PROGRAM.format(scripts="")],
        input=stdin,
        capture_output=True,
        env=environment() | more,
        timeout=DEADLINE,
        check=False,
    )


@pytest.mark.parametrize("stdin", [b"", b"2", b"9\n", b"3\n", b"3\n1\n", b"3\nx", b"\xff\n\xfe"])
def test_end_of_input_ends_and_never_spins(stdin: bytes) -> None:
    done = run_on(stdin)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.count(b"\n") < 30


def test_no_input_at_all_ends_the_menu() -> None:
    done = subprocess.run(
        ["sh", "-c", 'exec "$0" -c "$1" <&-', sys.executable, PROGRAM.format(scripts="")],
        capture_output=True,
        env=environment(),
        timeout=DEADLINE,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")


def test_bytes_that_are_no_text_are_a_wrong_choice() -> None:
    done = run_on(b"\xff\n2\n", PYTHONIOENCODING="utf-8:strict")
    assert done.returncode == 0
    assert b"Please choose a valid number" in done.stdout


def test_an_endless_line_fills_no_memory(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    for _ in range(100):
        menu.type("1" * 4000)  # a terminal drops what is too long for it
    menu.type("\n")
    menu.expect("Please choose a valid number")
    menu.expect("Select: ")
    menu.type("2\n")
    menu.expect("Current position")


def test_waiting_for_input_costs_nothing(start: Start) -> None:
    menu = start()
    menu.expect("Select: ")
    ticks = os.sysconf("SC_CLK_TCK")

    def spent() -> float:
        with open(f"/proc/{menu.process.pid}/stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / ticks

    before = spent()
    with pytest.raises(subprocess.TimeoutExpired):
        menu.process.wait(1.0)
    assert spent() - before < 0.1
