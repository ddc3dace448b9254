"""The requests of the documents, typed as they stand: each is answered as the text says."""

from __future__ import annotations

import itertools
import json
import os
import re
import signal
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event, Thread

import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.kept_token import kept_token
from roomba.ui.web.server import PageServer, listen

PAGE = Path(__file__).parents[3] / "docs" / "page.md"
PRINTED = "127.0.0.1:8400"
TOKEN = "TOKEN=$(cat ~/.local/state/roomba_robot/token)"


@dataclass
class Typed:
    """A terminal of a user whose page has another port than the documents say."""

    robot: WrittenRobot
    port: int
    environment: dict[str, str]

    def starts(self, line: str) -> subprocess.Popen[str]:
        """Type a line, after the one that reads the token."""
        return subprocess.Popen(
            ["bash", "-c", f"{TOKEN}\n{line.replace(PRINTED, f'127.0.0.1:{self.port}')}"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=self.environment,
            start_new_session=True,
        )

    def says(self, line: str) -> str:
        """Type a line that ends by itself; return what it said."""
        said, trouble = self.starts(line).communicate(timeout=20.0)
        assert said, trouble
        return said


@pytest.fixture
def typed(tmp_path: Path) -> Iterator[Typed]:
    own = ("ROS_HOME", "XDG_STATE_HOME", "ROOMBA_TOKEN_FILE")
    environment = {name: value for name, value in os.environ.items() if name not in own}
    environment |= {"HOME": str(tmp_path), "NO_PROXY": "*"}
    token = kept_token(tmp_path / ".local" / "state" / "roomba_robot" / "token")
    robot, bound = WrittenRobot(), listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(robot, Guard(token)), bound)
    server.start()
    yield Typed(robot, bound.getsockname()[1], environment)
    server.stop()


def lines() -> list[str]:
    """Return the lines of shell that the page has for programs, continued ones as one."""
    part = PAGE.read_text("utf-8").split("## For programs")[1].split("\n## ")[0]
    blocks = re.findall(r"^    (.*(?:(?<=\\)\n.*)*)", part, re.MULTILINE)
    return [line for line in blocks if re.match(r"TOKEN=|curl ", line)]


def line_with(words: str) -> str:
    (found,) = [line for line in lines() if words in line]
    return found


def test_all_of_them_are_tried_here() -> None:
    assert lines()[0] == TOKEN
    assert len(lines()) == 5


def test_the_state_is_told(typed: Typed) -> None:
    assert json.loads(typed.says(line_with("api/v1/state")))["vacuum"]["phase"] == "cleaning"


def test_a_room_is_cleaned(typed: Typed) -> None:
    typed.says(line_with("api/v1/clean"))
    ((name, wish),) = typed.robot.told
    assert name == "clean"
    assert "kitchen" in str(wish)


def test_events_are_told(typed: Typed) -> None:
    with typed.starts(line_with("curl -N")) as program:
        assert program.stdout is not None
        try:
            assert program.stdout.readline() == ":\n"
            vacuum = replace(VIEW.vacuum, state="paused", phase="paused")
            typed.robot.view = replace(VIEW, vacuum=vacuum)
            while "paused" not in (line := program.stdout.readline()):
                assert program.poll() is None
        finally:
            os.killpg(program.pid, signal.SIGKILL)
    assert json.loads(line.removeprefix("data: "))["type"] == "state"


def test_something_is_done_at_the_end_of_a_run(typed: Typed) -> None:
    ended = CleanReport(ErrandOutcome.COMPLETED, "", 3.0, 4.0, 1.0, 9.0, 60.0, 0.5)
    is_heard = Event()

    def end_runs() -> None:
        """Let runs end until one is heard of: the line does not tell when it listens."""
        for number in itertools.count():
            typed.robot.view = replace(VIEW, last=replace(ended, duration=float(number)))
            if is_heard.wait(0.3):
                return

    with typed.starts(line_with("curl -sN")) as program:
        assert program.stdout is not None
        ending = Thread(target=end_runs)
        ending.start()
        try:
            said = program.stdout.readline()
        finally:
            is_heard.set()
            ending.join()
            os.killpg(program.pid, signal.SIGKILL)
    assert said.startswith("done: ")
    assert json.loads(said.removeprefix("done: "))["outcome"] == "completed"
