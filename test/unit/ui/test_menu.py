"""The menu: what it asks and tells, and that nothing (input, Ctrl-C, a lost robot) can hold it."""

from __future__ import annotations

import io
import os
import re
import signal
import sys

import pytest
from fixtures.typed_answers import TypedAnswers
from rich.console import Console

from roomba.client.fake.robot import FakeRobot, SteppedClock, Turn, WalkScript
from roomba.errors import RoombaError
from roomba.ui.menu import OPTIONS, Menu, Option
from roomba.ui.prompt import LONGEST_LINE, Keyboard, explain, read_number


def use(
    robot: FakeRobot, *lines: str | type[BaseException], options: tuple[Option, ...] | None = None
) -> tuple[int, list[str], TypedAnswers]:
    """Run a menu on prepared lines; returns its status, what it printed and what it asked."""
    output = io.StringIO()
    answers = TypedAnswers(lines)
    console = Console(file=output, force_terminal=False)
    status = Menu(robot, answers, console, options=options, clock=robot.clock).run()
    return status, output.getvalue().splitlines(), answers


def test_the_menu_is_shown_and_end_of_input_leaves() -> None:
    status, lines, answers = use(FakeRobot())
    assert status == 0
    assert "press 1-4" in lines[1]
    assert [line.split(".")[0].strip() for line in lines[2:6]] == ["1", "2", "3", "4"]
    assert answers.prompts == ["Select: "]


@pytest.mark.parametrize("choice", ["0", "5", "-1", "1.0", "one", "", "   ", "11", "²", "\x1b[A"])
def test_a_wrong_choice_is_asked_again(choice: str) -> None:
    status, lines, answers = use(FakeRobot(), choice)
    assert status == 0
    assert lines.count("Please choose a valid number") == 1
    assert answers.prompts == ["Select: ", "Select: "]
    assert sum("press 1-4" in line for line in lines) == 1


def test_dirt_is_told_in_grams_and_the_position_in_metres() -> None:
    _, lines, _ = use(FakeRobot(dirt=0.125, position=(1.5, -2.25)), "1", " 2 ")
    assert "Current dirt amount: 0.12 g under the robot" in lines
    assert "Current position: x = 1.50 m, y = -2.25 m" in lines
    assert not any("not sure" in line for line in lines)


def test_a_robot_that_does_not_know_its_place_well_says_why() -> None:
    _, lines, _ = use(FakeRobot(doubt="the lidar sends no scans"), "2")
    assert "The robot is not sure of that: the lidar sends no scans" in lines


def test_a_walk_is_told_before_during_and_after() -> None:
    robot = FakeRobot(detour=1.2)
    _, lines, answers = use(robot, "3", "3", "4")
    assert answers.prompts[1:3] == [" X is equal to ", " Y is equal to "]
    walk = lines[lines.index("Distance: 6.00 m") :]
    assert walk[1] == "Expected time: 12.0 s"
    assert walk[2:6] == [
        f"Distance left: {left} m, current speed: 0.50 m/s"
        for left in ("6.00", "4.50", "3.00", "1.50")
    ]
    assert walk[6:10] == [
        "The robot has arrived.",
        "Position reached: x = 3.00 m, y = 4.00 m",
        "Distance travelled: 6.00 m",
        "Time taken: 12.0 s",
    ]


def test_home_is_the_station() -> None:
    robot = FakeRobot(position=(3.0, 4.0), station=(3.0, 1.0))
    _, lines, _ = use(robot, "4", "4")
    assert "Distance: 3.00 m" in lines
    assert "Position reached: x = 3.00 m, y = 1.00 m" in lines
    assert "The robot is already at its charging station: x = 3.00 m, y = 1.00 m" in lines
    assert len(robot.walks) == 1


@pytest.mark.parametrize(("x", "there"), [("0.05", True), ("-0.05", True), ("0.06", False)])
def test_where_it_already_is_it_says_so(x: str, there: bool) -> None:
    robot = FakeRobot()
    _, lines, _ = use(robot, "3", x, "0")
    assert any("already at the destination" in line for line in lines) is there
    assert bool(robot.walks) is not there


@pytest.mark.parametrize(
    "wrong", ["", "abc", "nan", "inf", "-Infinity", "1e999", "100.01", "1,5", "1_0", "\udcff"]
)
def test_a_coordinate_that_is_none_is_asked_again(wrong: str) -> None:
    robot = FakeRobot()
    _, lines, answers = use(robot, "3", wrong, "1", wrong, "0")
    complaints = [line for line in lines if line.startswith("Expected a number")]
    assert len(complaints) == 2
    assert all("from -100 to 100 (metres), got " + ascii(wrong) in line for line in complaints)
    assert answers.prompts[1:5] == [" X is equal to "] * 2 + [" Y is equal to "] * 2
    assert len(robot.walks) == 1


@pytest.mark.parametrize("edge", ["100", "-100", "1e2", " 7.5 "])
def test_coordinates_up_to_the_limits_are_taken(edge: str) -> None:
    robot = FakeRobot()
    use(robot, "3", edge, "0")
    assert robot.state().x == pytest.approx(float(edge))


@pytest.mark.parametrize("lines", [("3",), ("3", "1"), ("3", "x")])
def test_end_of_input_leaves_from_any_question(lines: tuple[str, ...]) -> None:
    robot = FakeRobot()
    status, _, _ = use(robot, *lines)
    assert status == 0
    assert not robot.walks


@pytest.mark.parametrize("lines", [(), ("3",), ("3", "1")])
def test_ctrl_c_leaves_from_any_question(lines: tuple[str, ...]) -> None:
    robot = FakeRobot()
    status, _, _ = use(robot, *lines, KeyboardInterrupt)
    assert status == 130
    assert not robot.walks


@pytest.mark.parametrize(
    ("script", "told"),
    [
        (WalkScript(Turn.REFUSED, 0, "in a\nwall"), "The robot refuses: in a wall"),
        (WalkScript(Turn.FAILS, 3, "stuck"), "The robot gave up after 1.50 m and 3.0 s: stuck"),
        (WalkScript(Turn.VANISHES, 3, "gone"), "The robot was lost after 1.50 m and 4.0 s: gone"),
        (WalkScript(Turn.FREEZES, 3), "it has not answered for 6 s"),
        (WalkScript(Turn.ABSENT, 0, "no server"), "The robot does not answer: no server"),
    ],
)
def test_a_walk_gone_wrong_is_one_line_and_the_menu_goes_on(script: WalkScript, told: str) -> None:
    robot = FakeRobot(scripts=[script])
    status, lines, answers = use(robot, "3", "3", "4")
    assert sum(told in line for line in lines) == 1
    assert not any("arrived" in line for line in lines)
    assert lines[-2].strip().startswith("4.")  # the menu is there again
    assert (status, answers.prompts[-1]) == (0, "Select: ")
    assert robot.clock.monotonic() < 15.0


def test_a_destination_without_a_way_is_refused_with_the_reason() -> None:
    robot = FakeRobot(blocked={(1.0, 2.0): "inside a wall; (1.2, 2.0) can be reached"})
    _, lines, _ = use(robot, "3", "1", "2")
    assert "The robot refuses: inside a wall; (1.2, 2.0) can be reached" in lines
    assert not robot.walks


@pytest.mark.parametrize("choice", ["1", "2", "4"])
def test_a_silent_robot_is_told_and_the_menu_goes_on(choice: str) -> None:
    robot = FakeRobot()
    robot.answers = False
    status, lines, answers = use(robot, choice)
    assert sum("The robot does not answer: " in line for line in lines) == 1
    assert (status, len(answers.prompts)) == (0, 2)


def test_messages_of_the_robot_are_printed_as_they_are() -> None:
    message = "[red]no[/red] :smile: " + "x" * 100
    _, lines, _ = use(FakeRobot(scripts=[WalkScript(Turn.REFUSED, 0, message)]), "3", "1", "1")
    assert f"The robot refuses: {message}" in lines


def interrupting_clock(*moments: float) -> SteppedClock:
    """A clock at whose moments Ctrl-C is pressed."""
    return SteppedClock((moment, lambda: signal.raise_signal(signal.SIGINT)) for moment in moments)


def test_ctrl_c_during_a_walk_cancels_it_and_returns_to_the_menu() -> None:
    robot = FakeRobot(clock=interrupting_clock(2.0))
    status, lines, answers = use(robot, "3", "3", "4", "2")
    assert status == 0
    assert robot.walks[0].cancels == 1
    end = lines.index("The walk was cancelled.")
    assert re.fullmatch(r"Position reached: x = 0\.[67]\d m, y = [01]\.\d\d m", lines[end + 1])
    assert re.fullmatch(r"Distance travelled: 1\.[01]\d m", lines[end + 2])
    assert re.fullmatch(r"Time taken: 2\.[0-3] s", lines[end + 3])
    assert answers.prompts[-2:] == ["Select: ", "Select: "]


def test_a_walk_that_another_program_ended_says_why() -> None:
    robot = FakeRobot(scripts=[WalkScript(message="another goal took over")])
    robot.clock = SteppedClock([(2.0, lambda: robot.walks[0].preempt())])
    _, lines, _ = use(robot, "3", "3", "4")
    assert "The walk was cancelled: another goal took over" in lines


def test_a_second_ctrl_c_leaves_a_robot_that_does_not_stop() -> None:
    robot = FakeRobot(clock=interrupting_clock(2.0, 3.0), scripts=[WalkScript(obeys=False)])
    status, _, _ = use(robot, "3", "3", "4", "2")
    assert status == 130
    assert robot.walks[0].cancels >= 1
    assert robot.clock.monotonic() < 4.0


def test_ctrl_c_after_a_cancelled_walk_is_a_first_one_again() -> None:
    robot = FakeRobot(clock=interrupting_clock(2.0, 6.0))
    status, lines, _ = use(robot, "3", "30", "40", "3", "30", "40")
    assert status == 0
    assert lines.count("The walk was cancelled.") == 2


class SlowPlanner(FakeRobot):
    def path_length(self, x: float, y: float) -> float:
        self.clock.sleep(3.0)
        return super().path_length(x, y)


def test_ctrl_c_before_the_walk_begins_starts_none() -> None:
    robot = SlowPlanner(clock=interrupting_clock(1.0))
    status, lines, _ = use(robot, "3", "3", "4")
    assert "Cancelled before the robot set out." in lines
    assert (status, robot.walks) == (0, [])


class BrokenRobot(FakeRobot):
    def state(self, timeout: float = 5.0) -> object:  # type: ignore[override]
        if self.walks:
            raise ZeroDivisionError("a mistake of a client")
        return super().state(timeout)


def test_a_menu_that_breaks_leaves_no_robot_walking() -> None:
    robot = BrokenRobot()
    with pytest.raises(ZeroDivisionError):
        use(robot, "3", "3", "4")
    assert robot.walks[0].cancels == 1


def test_the_handler_of_before_is_put_back() -> None:
    before = signal.getsignal(signal.SIGINT)
    use(FakeRobot(), "2")
    assert signal.getsignal(signal.SIGINT) is before


def test_a_later_issue_adds_an_option_as_a_line() -> None:
    options = (*OPTIONS, Option("Sing", lambda menu: menu.say("la la")))
    _, lines, _ = use(FakeRobot(), "5", "6", options=options)
    assert any("press 1-5" in line for line in lines)
    assert "  5. Sing" in lines
    assert "la la" in lines
    assert "Please choose a valid number" in lines


def test_numbers_and_errors_for_people() -> None:
    assert read_number("-1.5e1") == -15.0
    assert [read_number(text) for text in ("1_0", "nan", "inf", "x")] == [None] * 4
    assert explain(RoombaError("")) == "That did not work: no reason given"


def test_a_line_too_long_is_cut_and_the_next_one_is_whole(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    inner, outer = os.pipe()
    os.write(outer, b"1" * 60_000 + b"\nnext\nlast")
    os.close(outer)
    with os.fdopen(inner) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        keyboard = Keyboard()
        assert keyboard("? ") == "1" * LONGEST_LINE
        assert keyboard("? ") == "next"
        assert keyboard("? ") == "last"
        with pytest.raises(EOFError):
            keyboard("? ")
    assert capsys.readouterr().out == "? \n? \n? \n? "


# whole processes: a real stdin, real signals, real time
