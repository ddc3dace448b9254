"""``./roomba play`` of a robot on a serial line releases it, however the command ends."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pty
import signal
import subprocess
import sys
import termios
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fixtures.robots.create2_rig import create2_in_studio
from fixtures.waiting import unchanged, wait_until

from roomba.drivers.create2.open_interface import OpenMode
from roomba.emulators.create2.robot import Create2Robot
from roomba.emulators.create2.server import Create2Server
from roomba.emulators.living import LivingWorld
from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.geometry import Pose

DEADLINE = 30.0
"""s of wall time."""
AWAY = Pose(-0.6, 0.0, 0.0)
"""From the station, as the robot on it sees it."""
IMPATIENT = 0.005
"""s between two presses of Ctrl-C."""


class Played:
    """A made-up Create 2, and ``play`` over it, whose terminal may be lost."""

    def __init__(self, folder: Path) -> None:
        docked = create2_in_studio().pose
        self.robot = Create2Robot(create2_in_studio(docked.compose(AWAY)))
        self._line, self._world = PseudoTerminal(), LivingWorld(self.robot.advance)
        self._server = Create2Server(self.robot, self._line, self._world)
        self._world.start()
        self._server.start()
        self._log = folder / "log"
        self._terminal: int | None = None
        self._program: subprocess.Popen[bytes] | None = None

    def play(
        self, prepare: Callable[[], object] = lambda: None, *, has_terminal: bool = True
    ) -> None:
        """Let the program take the robot over, on a terminal of its own, or one that is gone."""
        self._terminal, inside = pty.openpty()
        words = ("--robot", "create2", "--line", self._line.name, "--lidar", "none")
        with self._log.open("wb") as log:
            self._program = subprocess.Popen(
                [
                    *(sys.executable, "-m", "roomba.commands.program", "play", *words),
                    *("--no-open", "--port", "0"),
                ],
                stdin=inside,
                stdout=log,
                stderr=inside,
                start_new_session=True,
                preexec_fn=prepare,
            )
        os.close(inside)
        if not has_terminal:
            self.lose_terminal()
        program = self._program
        wait_until(
            lambda: "Ctrl-C ends it" in self.output or program.poll() is not None,
            DEADLINE,
            lambda: self.output,
        )
        assert program.poll() is None, self.output
        wait_until(lambda: self.robot.mode is OpenMode.SAFE, DEADLINE, "it is taken over")

    @property
    def output(self) -> str:
        return self._log.read_text("utf-8")

    def tell(self, number: signal.Signals) -> None:
        assert self._program is not None
        self._program.send_signal(number)

    def lose_terminal(self) -> None:
        assert self._terminal is not None
        os.close(self._terminal)
        self._terminal = None

    def ends(self) -> int:
        assert self._program is not None
        return self._program.wait(DEADLINE)

    def close(self) -> None:
        if self._program is not None:
            self._program.kill()
            self._program.wait()
        if self._terminal is not None:
            self.lose_terminal()
        self._server.end()
        self._world.end()
        self._line.close()


@pytest.fixture
def household(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("HOUSEHOLD", "HISTORY", "MAPS"):
        monkeypatch.setenv(f"ROOMBA_{name}", str(tmp_path / name.lower()))
    monkeypatch.setenv("ROOMBA_TOKEN_FILE", str(tmp_path / "token"))
    return tmp_path / "household"


@pytest.fixture
def played(tmp_path: Path, household: Path) -> Iterator[Played]:
    with contextlib.closing(Played(tmp_path)) as made:
        yield made


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_told_again_and_again_it_gives_the_robot_back(
    played: Played, number: signal.Signals
) -> None:
    played.play()

    def is_given_back() -> bool:
        played.tell(number)
        return played.robot.mode is OpenMode.OFF

    wait_until(is_given_back, DEADLINE, "it is given back", pause=IMPATIENT)
    played.ends()


def test_when_its_terminal_is_lost_it_gives_the_robot_back(played: Played) -> None:
    played.play(_on_terminal)
    played.lose_terminal()
    assert played.ends() == 0
    assert played.robot.mode is OpenMode.OFF


def test_nohup_lets_it_go_on_without_its_terminal(played: Played) -> None:
    played.play(lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    played.tell(signal.SIGHUP)
    assert unchanged(lambda: played.robot.mode, 0.5)
    played.tell(signal.SIGINT)
    assert played.ends() == 0


def test_what_it_warns_of_without_a_terminal_ends_nothing(played: Played, household: Path) -> None:
    household.mkdir()
    (household / "plans.json").write_text("damaged", "utf-8")
    played.play(lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN), has_terminal=False)
    played.tell(signal.SIGINT)
    assert played.ends() == 0
    assert played.robot.mode is OpenMode.OFF


def _on_terminal() -> None:
    """Make standard input the terminal of this new session."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)
