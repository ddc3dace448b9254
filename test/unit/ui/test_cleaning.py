"""The menu's options for cleaning: what they ask and tell, and that a clean outlives the menu."""

from __future__ import annotations

import dataclasses
import io
import math
import signal

import pytest
from fixtures.typed_answers import TypedAnswers
from rich.console import Console

from roomba.clean_request import CleanRequest
from roomba.client.fake.errands import ErrandScript
from roomba.client.fake.robot import FakeRobot, SteppedClock
from roomba.client.protocol import CleanProgress, ErrandOutcome, MissedFloor
from roomba.ui.cleaning import CLEANING, CLEANING_HEADING
from roomba.ui.errand_progress import (
    ERRAND_SILENCE_LIMIT,
    CleanLines,
    area_text,
    clean_view,
    percent,
    time_text,
)
from roomba.ui.menu import Menu
from roomba.vocabulary import CleanMode

WHAT = " What to clean (Enter: the whole home): "
ROOMS = " Rooms, by name or number, with commas between: "


def use(robot: FakeRobot, *lines: str | type[BaseException]) -> tuple[int, list[str], TypedAnswers]:
    """Run the whole menu on prepared lines; returns its status, what it printed and asked."""
    output = io.StringIO()
    answers = TypedAnswers(lines)
    console = Console(file=output, force_terminal=False)
    menu = Menu(
        robot,
        answers,
        console,
        more=CLEANING,
        more_heading=CLEANING_HEADING,
        clock=robot.clock,
    )
    return menu.run(), output.getvalue().splitlines(), answers


def test_the_seeds_menu_is_as_it_was_and_the_rest_is_below() -> None:
    status, lines, answers = use(FakeRobot())
    assert status == 0
    assert lines[1:12] == [
        "Please press 1-4 to choose what the robot does:",
        "  1. Current dirt amount",
        "  2. Current position",
        "  3. Traverse to a specified destination",
        "  4. Return to the charging station",
        "Or press 5-9 to clean:",
        "  5. Clean",
        "  6. Pause, or go on",
        "  7. Stop, and stay",
        "  8. Dock: onto the charging station, by its beams",
        "  9. What the robot does",
    ]
    assert answers.prompts == ["Select: "]


@pytest.mark.parametrize("choice", ["0", "10", "5.", "five", ""])
def test_a_wrong_choice_is_asked_again(choice: str) -> None:
    status, lines, answers = use(FakeRobot(), choice)
    assert status == 0
    assert lines.count("Please choose a valid number") == 1
    assert answers.prompts == ["Select: ", "Select: "]


def test_a_clean_is_told_during_and_after() -> None:
    missed = (
        MissedFloor(0.5, 1.25, -2.0, "kitchen", "something stands there"),
        MissedFloor(0.25, 0.0, 0.0, "", "it was stopped before"),
    )
    script = ErrandScript(missed=missed)
    robot = FakeRobot(room_names=("kitchen", "hall"), errands=[script])
    _, lines, answers = use(robot, "5", "")
    assert answers.prompts[:2] == ["Select: ", WHAT]
    assert robot.asked == [CleanRequest()]
    begin = lines.index("Cleaned: 0.0 of 8.0 m² (0 %), cleaning, kitchen, battery 80 %, 16 s to go")
    assert lines[begin + 1 : begin + 14] == [
        "Cleaned: 4.0 of 8.0 m² (50 %), cleaning, hall, battery 80 %, 8 s to go",
        "Cleaned: 8.0 of 8.0 m² (100 %), returning, hall, battery 80 %",
        "The clean is done, and the robot is back on its station.",
        "Cleaned: 8.0 of 8.0 m² (100 %)",
        "Distance travelled: 5.00 m",
        "Time taken: 20 s, 24.00 m² a minute",
        "Where it went: sweeping at full speed 10 s, ways, and floor passed twice 5 s, turning on "
        "the spot 5 s",
        "Energy used: 0.20 Wh",
        "Dirt picked up: 12.00 g",
        "Missed: 0.50 m² in kitchen, at x = 1.25 m, y = -2.00 m: something stands there",
        "Missed: 0.25 m², at x = 0.00 m, y = 0.00 m: it was stopped before",
        "",
        "Please press 1-4 to choose what the robot does:",
    ]


@pytest.mark.parametrize("choice", ["1", " "])
def test_the_whole_home_has_a_number_too(choice: str) -> None:
    robot = FakeRobot()
    use(robot, "5", choice)
    assert robot.asked == [CleanRequest()]


def test_here_around_is_a_spot() -> None:
    robot = FakeRobot()
    _, lines, _ = use(robot, "5", "4", "3")
    assert robot.asked == [CleanRequest(CleanMode.SPOT)]
    assert lines.count("Please choose a valid number") == 1


@pytest.mark.parametrize(
    ("text", "rooms"),
    [
        ("2", ("hall",)),
        ("Kitchen, 3", ("kitchen", "1")),
        ("1", ("1",)),  # a room's name counts more than a number
        ("hall,,hall, ", ("hall",)),
    ],
)
def test_rooms_by_name_or_number(text: str, rooms: tuple[str, ...]) -> None:
    robot = FakeRobot(room_names=("kitchen", "hall", "1"))
    _, lines, answers = use(robot, "5", "2", text)
    first = lines.index("  1. kitchen")
    assert lines[first + 1 : first + 3] == ["  2. hall", "  3. 1"]
    assert answers.prompts[2] == ROOMS
    assert robot.asked == [CleanRequest(CleanMode.ROOMS, rooms)]


@pytest.mark.parametrize("wrong", ["", ",", "attic", "4", "kitchen; hall", "kitchen, 0"])
def test_rooms_that_are_none_are_asked_again(wrong: str) -> None:
    robot = FakeRobot()
    _, lines, answers = use(robot, "5", "2", wrong, "kitchen")
    complaint = f"Expected rooms of this list, got {wrong!a}. Please try again."
    assert lines.count(complaint) == 1
    assert answers.prompts[2:4] == [ROOMS, ROOMS]
    assert robot.asked == [CleanRequest(CleanMode.ROOMS, ("kitchen",))]


@pytest.mark.parametrize("lines", [("5",), ("5", "2")])
def test_end_of_input_and_ctrl_c_leave_from_the_questions(lines: tuple[str, ...]) -> None:
    for key, expected in ((EOFError, 0), (KeyboardInterrupt, 130)):
        robot = FakeRobot()
        status, _, _ = use(robot, *lines, key)
        assert (status, robot.cleans) == (expected, [])


@pytest.mark.parametrize(
    ("outcome", "told"),
    [
        (ErrandOutcome.STOPPED, "The clean was stopped: because"),
        (ErrandOutcome.BATTERY, "The battery did not last: because"),
        (ErrandOutcome.STUCK, "The robot is stuck: because"),
        (ErrandOutcome.LOST, "The robot does not know where it is: because"),
        (
            ErrandOutcome.NOT_DOCKED,
            "The floor is done, but the robot is not on its station: because",
        ),
        (ErrandOutcome.FAULT, "The robot gave up: because"),
        (ErrandOutcome.DISCONNECTED, "The connection to the clean was lost: because"),
    ],
)
def test_a_clean_gone_wrong_says_why_and_how_far_it_came(outcome: ErrandOutcome, told: str) -> None:
    script = ErrandScript(outcome, after=4.0, message="because")
    status, lines, answers = use(FakeRobot(errands=[script]), "5", "")
    end = lines.index(told)
    assert lines[end + 1].startswith("Cleaned: ")
    assert ("Energy used: 0.04 Wh" in lines) is (outcome is not ErrandOutcome.DISCONNECTED)
    assert not any("nan" in line or "unknown" in line for line in lines)
    tip = "Press 9 to see whether the robot goes on with it."
    assert (tip in lines) is (outcome is ErrandOutcome.DISCONNECTED)
    assert (status, answers.prompts[-1]) == (0, "Select: ")


def test_a_refused_clean_is_one_line() -> None:
    script = ErrandScript(ErrandOutcome.REFUSED, message="the robot\nis not ready")
    _, lines, _ = use(FakeRobot(errands=[script]), "5", "")
    assert "The robot refuses: the robot is not ready" in lines
    assert not any(line.startswith("Cleaned") for line in lines)


def test_many_missed_areas_are_counted() -> None:
    missed = tuple(MissedFloor(1.0, 0.0, 0.0, "hall", "why") for _ in range(12))
    _, lines, _ = use(FakeRobot(errands=[ErrandScript(missed=missed)]), "5", "")
    assert sum(line.startswith("Missed: ") for line in lines) == 11
    assert "Missed: 2 smaller areas more" in lines


def test_a_clean_that_tells_nothing_gives_the_menu_back_and_is_not_cancelled() -> None:
    robot = FakeRobot(errands=[ErrandScript(after=2.0, freezes=True)])
    status, lines, answers = use(robot, "5", "")
    expected = "The robot does not answer: it has told nothing for 15 s; it may go on by itself"
    assert expected in lines
    assert (status, len(answers.prompts)) == (0, 3)
    assert robot.clock.monotonic() <= 2.0 + ERRAND_SILENCE_LIMIT + 1.0
    assert robot.cleans[0].cancels == 0


def interrupting_clock(*moments: float) -> SteppedClock:
    """A clock at whose moments Ctrl-C is pressed."""
    return SteppedClock((moment, lambda: signal.raise_signal(signal.SIGINT)) for moment in moments)


GOES_ON = "The robot goes on by itself: press 6 to pause it, 7 to stop it, 9 to see how far it is."


def test_ctrl_c_leaves_a_clean_to_itself() -> None:
    robot = FakeRobot(clock=interrupting_clock(3.0))
    status, lines, answers = use(robot, "5", "", "9", "6", "9", "6", "7", "9")
    assert status == 0
    end = lines.index(GOES_ON)
    assert robot.cleans[0].cancels == 0
    told = [line for line in lines[end:] if line.startswith(("State", "The robot"))]
    amount = "battery 80 %, cleaned 1.5 of 12.0 m² (12 %), 21 s to go"
    assert told[1:] == [
        f"State: cleaning, in kitchen, {amount}",
        "The robot pauses; press 6 to let it go on.",
        f"State: paused, in kitchen, {amount}",
        "The robot goes on.",
        "The robot has stopped, and stays where it is.",
        "State: idle, battery 80 %",
    ]
    assert answers.prompts[2:] == ["Select: "] * 7


def test_a_second_ctrl_c_leaves_the_menu_and_the_robot_cleans() -> None:
    robot = FakeRobot(clock=interrupting_clock(3.05, 3.1))
    status, _, _ = use(robot, "5", "")
    assert status == 130
    assert robot.vacuum().state == "cleaning"


def test_docking_tells_what_it_does_and_its_result() -> None:
    robot = FakeRobot()
    robot.undock()
    robot.clock.sleep(5.0)
    _, lines, _ = use(robot, "8", "9")
    begin = lines.index("The robot is returning.")
    assert lines[begin + 1] == "The robot is on its charging station."
    assert lines.count("The robot is returning.") == 1
    assert "State: docked, battery 80 %" in lines


@pytest.mark.parametrize(
    ("outcome", "told"),
    [
        (ErrandOutcome.FAULT, "The robot did not get onto its station: no beam"),
        (ErrandOutcome.REFUSED, "The robot refuses: no beam"),
        (ErrandOutcome.STOPPED, "The way to the station was stopped: no beam"),
        (ErrandOutcome.DISCONNECTED, "The connection to the robot was lost: no beam"),
    ],
)
def test_docking_gone_wrong_says_why(outcome: ErrandOutcome, told: str) -> None:
    scripts = [ErrandScript(), ErrandScript(outcome, after=2.0, message="no beam")]
    robot = FakeRobot(errands=scripts)
    robot.undock()
    robot.clock.sleep(5.0)
    _, lines, _ = use(robot, "8")
    assert told in lines
    assert "The robot is on its charging station." not in lines


def test_ctrl_c_leaves_docking_to_itself() -> None:
    robot = FakeRobot(clock=interrupting_clock(6.0))
    robot.undock()
    robot.clock.sleep(5.0)
    status, lines, _ = use(robot, "8", "9")
    assert status == 0
    assert GOES_ON in lines
    assert any(line.startswith("State: returning") for line in lines)


def test_a_robot_with_nothing_to_pause_says_so() -> None:
    _, lines, _ = use(FakeRobot(), "6", "7")
    assert "The robot refuses: cannot pause now: the robot is docked" in lines
    assert "The robot has stopped, and stays where it is." in lines


@pytest.mark.parametrize("choice", [("5", ""), ("5", "2"), ("6",), ("7",), ("8",), ("9",)])
def test_a_silent_robot_is_told_and_the_menu_goes_on(choice: tuple[str, ...]) -> None:
    robot = FakeRobot()
    robot.answers = False
    status, lines, answers = use(robot, *choice)
    assert sum("The robot does not answer: " in line for line in lines) == 1
    assert (status, answers.prompts[-1]) == (0, "Select: ")


PROGRESS = CleanProgress(
    state="cleaning",
    room="[red]den",
    covered=2.5,
    wanted=10.0,
    fraction=0.25,
    seconds_to_go=7500.0,
    battery=math.nan,
)


def test_a_terminal_gets_a_live_bar() -> None:
    console = Console(
        file=io.StringIO(),
        force_terminal=True,
        force_interactive=True,
        width=120,
        _environ={"TERM": "xterm"},
    )
    with clean_view(console, SteppedClock()) as view:
        view.show(dataclasses.replace(PROGRESS, state="returning"))
    assert isinstance(console.file, io.StringIO)
    output = console.file.getvalue()
    for text in ("Returning", "━", "2.5 of 10.0 m² (25 %)", "[red]den", "2 h 05 min to go"):
        assert text in output
    assert "battery unknown" in output


def test_plain_lines_are_few() -> None:
    console, clock = Console(file=io.StringIO(), force_terminal=False), SteppedClock()
    view = CleanLines(console, clock)
    for _ in range(31):
        view.show(PROGRESS)
        clock.sleep(1.0)
    assert isinstance(console.file, io.StringIO)
    assert console.file.getvalue().count("Cleaned: 2.5 of 10.0 m² (25 %), cleaning") == 4


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (-1.0, "0 s"),
        (99.4, "99 s"),
        (100.0, "2 min"),
        (5940.0, "99 min"),
        (6000.0, "1 h 40 min"),
        (math.nan, "unknown"),
    ],
)
def test_times_for_people(seconds: float, text: str) -> None:
    assert time_text(seconds) == text


def test_shares_and_areas_for_people() -> None:
    assert [percent(share) for share in (0.0, 0.999, 1.0, math.nan)] == [
        "0 %",
        "99 %",
        "100 %",
        "unknown",
    ]
    assert percent(1.012) == "100 %"
    assert area_text(0.0, 0.0) == "0.0 of 0.0 m² (100 %)"
    assert area_text(10.1, 10.0) == "10.1 of 10.0 m² (100 %)"
    assert area_text(math.nan, 1.0) == "unknown"
