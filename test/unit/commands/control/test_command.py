"""``control --demo``: the menu over a robot that lives in a tiny home, typed by a user."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fixtures.homes.tiny_home import tiny_home
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until

from roomba.commands.control.command import main

DEADLINE = 30.0
"""s of wall time."""

Start = Callable[..., Program]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Give a function that starts the menu in a process of its own, on pipes."""
    programs: list[Program] = []

    def begin(*options: str) -> Program:
        module = [sys.executable, "-m", "roomba.commands.control"]
        words = [*module, "--demo", "--home", str(tiny_home(tmp_path)), *options]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
        programs.append(Program(words, environment, tmp_path / f"{len(programs)}.log"))
        programs[-1].says("Select: ", DEADLINE)
        return programs[-1]

    yield begin
    for program in programs:
        program.clean_up()


def choose(menu: Program, *lines: str) -> str:
    """Type an option and its answers; return what is said until the menu asks again."""
    before = menu.output
    for line in lines:
        menu.type(line)

    def asks_again() -> bool:
        return menu.output.count("Select: ") > before.count("Select: ")

    wait_until(asks_again, DEADLINE, lambda: f"the menu to ask again: {menu.output}")
    return menu.output[len(before) :]


def test_each_option_does_what_it_says(start: Start) -> None:
    menu = start("--speed", "100", "--bin", "500")
    assert re.search(r"Current dirt amount: \d\.\d\d g under the robot", choose(menu, "1"))
    assert "Current position: x = 0.3" in choose(menu, "2")
    walk = choose(menu, "3", "far", "2.1", "0.5")
    assert "Expected a number from -100 to 100 (metres), got 'far'" in walk
    assert re.search(r"Distance: [12]\.\d\d m", walk)
    assert "The robot has arrived." in walk
    assert "The robot refuses: (50.00, 50.00) cannot be reached" in choose(menu, "3", "50", "50")
    assert "State: idle" in choose(menu, "9")
    assert "The robot refuses: cannot pause now: the robot is idle" in choose(menu, "6")
    assert "The clean is done" in choose(menu, "5", "3")
    assert "The clean is done" in choose(menu, "5", "2", "1")
    whole = choose(menu, "5", "")
    assert "The clean is done, and the robot is back on its station" in whole
    assert re.search(r"Cleaned: .*\((9\d|100) %\)\n(.*\n)*Dirt picked up: ", whole)
    assert "The robot is on its charging station" in choose(menu, "8")
    assert "The robot has stopped" in choose(menu, "7")
    assert "nothing to explore" in choose(menu, "10")
    assert "its dust bin is empty" in choose(menu, "11")
    assert "already at its charging station" in choose(menu, "4")
    menu.end_of_input()
    assert menu.ends(DEADLINE) == 0


def test_it_makes_a_map_and_cleans_by_it(start: Start) -> None:
    menu = start("--speed", "100", "--map", "none")
    assert "there are no rooms yet" in choose(menu, "5", "2")
    assert "All that can be seen is mapped, and the robot is back on its station" in choose(
        menu, "10"
    )
    assert "The clean is done" in choose(menu, "5", "1")


def test_ctrl_c_cancels_a_walk_and_leaves_a_clean_to_itself(start: Start) -> None:
    menu = start()
    for line in ("3", "2.1", "0.5"):
        menu.type(line)
    menu.says("Distance left", DEADLINE)
    menu.send(signal.SIGINT)
    menu.says("The walk was cancelled", DEADLINE)
    wait_until(lambda: menu.output.count("Select: ") == 2, DEADLINE, "the menu")
    menu.type("5")
    menu.type("")
    menu.says("Cleaned: 0.0 of ", DEADLINE)
    menu.send(signal.SIGINT)
    menu.says("The robot goes on by itself", DEADLINE)
    wait_until(lambda: menu.output.count("Select: ") == 3, DEADLINE, "the menu")
    assert "The robot pauses" in choose(menu, "6")
    assert "State: paused" in choose(menu, "9")
    assert "The robot goes on." in choose(menu, "6")
    assert "State: cleaning" in choose(menu, "9")
    menu.send(signal.SIGINT)
    assert menu.ends(DEADLINE) == 130


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--home", "flat"], "expected --demo"),
        (["--demo", "--speed", "1000"], "from 0.1 to 100"),
        (["--demo", "--map", "moon"], "invalid choice"),
    ],
)
def test_wrong_usage_is_told(
    capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def test_a_home_that_is_none_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--demo", "--home", "castle"]) == 2
    assert "castle" in capsys.readouterr().err
