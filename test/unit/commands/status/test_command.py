"""``roomba status`` beside the server of a page, and without one."""

from __future__ import annotations

import json
import math
import socket
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot

from roomba.client.plain import state_of
from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.commands.status.asking import NoRobotError, find_robot
from roomba.commands.status.command import main
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen

Told = Callable[[], str]


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def port(robot: WrittenRobot) -> Iterator[int]:
    bound = listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(robot, Guard("the-token")), bound)
    server.start()
    yield bound.getsockname()[1]
    server.stop()


def free_port() -> int:
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        return int(bound.getsockname()[1])


def rows(text: str) -> dict[str, str]:
    return {line.split()[0]: " ".join(line.split()[1:]) for line in text.splitlines()}


def test_it_tells_what_the_robot_does(port: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--port", str(port)]) == 0
    assert rows(capsys.readouterr().out) == {
        "state": "cleaning, in hall",
        "battery": "unknown",
        "cleaned": "1.0 of 4.0 m² (25 %), 60 s to go",
        "dirt": "3.0 g picked up since the bin was emptied",
        "place": "x 1.00 m, y 2.00 m, heading 29°",
        "speed": "0.20 m/s",
    }


def test_it_tells_what_is_wrong_and_how_the_last_errand_ended(
    robot: WrittenRobot, port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    ended = CleanReport(ErrandOutcome.STUCK, "free its wheels", 2.0, 4.0, 1.0, 9.0, 60.0, 0.1)
    vacuum = replace(VIEW.vacuum, state="error", phase="stuck", message="both wheels spin")
    robot.view = replace(
        VIEW, pose=(-1e-4, 2.0, 0.0), vacuum=vacuum, held="a hand", doubt="it is dark", last=ended
    )
    assert main(["--port", str(port)]) == 0
    told = capsys.readouterr().out
    assert rows(told)["state"] == "error, stuck, in hall"
    assert rows(told)["place"] == "x 0.00 m, y 2.00 m, heading 0°"
    assert rows(told)["last"] == "stuck, 2.0 of 4.0 m² (50 %), 2.00 m² a minute, free its wheels"
    troubles = [line.split(maxsplit=1)[1] for line in told.splitlines() if "trouble" in line]
    assert [each.strip() for each in troubles] == ["both wheels spin", "held: a hand", "it is dark"]


@pytest.mark.parametrize("room", ["Kitchen [eg]", "Bad [/]"])
def test_a_name_is_told_as_it_is(
    robot: WrittenRobot, port: int, capsys: pytest.CaptureFixture[str], room: str
) -> None:
    robot.view = replace(VIEW, vacuum=replace(VIEW.vacuum, room=room))
    assert main(["--port", str(port)]) == 0
    assert rows(capsys.readouterr().out)["state"] == f"cleaning, in {room}"


def test_dirt_that_is_not_known_is_not_told(
    robot: WrittenRobot, port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    robot.view = replace(VIEW, dirt=math.nan)
    assert main(["--port", str(port)]) == 0
    assert "dirt" not in rows(capsys.readouterr().out)


def test_for_a_program_it_is_what_the_api_tells(
    port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--json", "--port", str(port)]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(json.dumps(state_of(VIEW)))


def test_without_a_robot_it_says_where_it_looked_and_what_helps(
    capsys: pytest.CaptureFixture[str],
) -> None:
    port = free_port()
    assert main(["--port", str(port)]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert f"port {port}" in told.err
    assert "./roomba play" in told.err


def test_a_robot_that_does_not_tell_is_said_so_with_its_reason(
    robot: WrittenRobot, port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    robot.is_gone = True
    assert main(["--port", str(port)]) == 1
    assert "the robot's program has ended" in capsys.readouterr().err


def test_other_servers_are_passed_over(port: int, tmp_path: Path) -> None:
    handler = partial(SimpleHTTPRequestHandler, directory=str(tmp_path))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as other:
        thread = Thread(target=other.serve_forever)
        thread.start()
        try:
            (tmp_path / "openapi.json").write_text("[1, 2]")
            assert find_robot([free_port(), other.server_port, port]) == port
            with pytest.raises(NoRobotError, match="ports"):
                find_robot([free_port(), other.server_port])
        finally:
            other.shutdown()
            thread.join()


def test_watched_it_tells_again_until_the_robot_is_gone(
    robot: WrittenRobot,
    port: int,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looks = []

    def passes(_: float) -> None:
        looks.append(robot.view.time)
        robot.view = replace(robot.view, time=robot.view.time + 1.0)
        robot.is_gone = len(looks) == 3

    monkeypatch.setattr("roomba.commands.status.command.time.sleep", passes)
    assert main(["--json", "--watch", "--port", str(port)]) == 1
    told = [json.loads(line)["time"] for line in capsys.readouterr().out.splitlines()]
    assert told == [1.0, 2.0, 3.0]
