"""``roomba top``: where it finds a robot, without a terminal, and on one."""

from __future__ import annotations

import os
import pty
import select
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fixtures.households.written_robot import WrittenRobot

from roomba.commands.top.command import main
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen

TOKEN = "the-token-of-twenty-two-and-more"


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def port(robot: WrittenRobot) -> Iterator[int]:
    bound = listen("127.0.0.1", 0, is_fixed=True)
    server = PageServer(create_app(robot, Guard(TOKEN)), bound)
    server.start()
    yield bound.getsockname()[1]
    server.stop()


@pytest.mark.parametrize("address", ["{}", "http://127.0.0.1:{}/#token=" + TOKEN])
def test_without_a_terminal_it_tells_the_state_once(
    port: int, address: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([address.format(port)]) == 0
    assert "cleaning, in hall" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("address", "status", "said"),
    [
        ("1", 1, "none answers"),
        ("nowhere", 2, "expected a port up to 65535, or the address"),
        ("http://127.0.0.1:x/", 2, "expected a port up to 65535, or the address"),
    ],
)
def test_it_says_where_it_looked_and_what_it_expects(
    address: str, status: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([address]) == status
    assert said in capsys.readouterr().err


def test_a_home_without_a_robot_of_its_own_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--home", "studio"])
    assert ended.value.code == 2
    assert "--home: of a robot in a simulated home, so expected --demo" in capsys.readouterr().err


def test_an_unknown_home_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--demo", "--home", "nowhere"]) == 2
    assert "nowhere" in capsys.readouterr().err


def test_on_a_terminal_it_fills_it_commands_by_the_kept_token_and_the_end_of_input_ends_it(
    robot: WrittenRobot, port: int, tmp_path: Path
) -> None:
    kept = tmp_path / "token"
    kept.touch(0o600)
    kept.write_text(TOKEN)
    ours, its = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "roomba.commands.program", "top", str(port)],
        stdin=its,
        stdout=its,
        stderr=its,
        env={
            **os.environ,
            "TERM": "xterm-256color",
            "COLUMNS": "100",
            "LINES": "30",
            "ROOMBA_TOKEN_FILE": str(kept),
        },
        start_new_session=True,
    ) as program:
        os.close(its)
        try:
            seen = read_until(ours, lambda seen: "cleaning, in hall" in seen)
            assert "\x1b[?1049h" in seen, "the other screen of the terminal"
            os.write(ours, b"l")
            read_until(ours, lambda _: ("locate", ()) in robot.told)
            os.write(ours, b"\x04")
            rest = read_until(ours, lambda seen: "\x1b[?1049l" in seen)
            assert program.wait(30.0) == 0, rest
        finally:
            program.kill()
            os.close(ours)


def read_until(terminal: int, is_there: Callable[[str], bool]) -> str:
    """Return what a program wrote on its terminal until something is so; fails after 60 s."""
    seen, deadline = "", time.monotonic() + 60.0
    while not is_there(seen):
        assert time.monotonic() < deadline, seen
        ready, _, _ = select.select([terminal], [], [], 0.2)
        if ready:
            seen += os.read(terminal, 65536).decode(errors="replace")
    return seen
