"""The menu's option for making a map, with a fake robot and typed answers."""

import io
from collections.abc import Iterable

import pytest
from fixtures.typed_answers import TypedAnswers
from rich.console import Console

from roomba.client.fake.errands import ErrandScript
from roomba.client.fake.robot import FakeRobot
from roomba.client.protocol import ErrandOutcome
from roomba.ui.cleaning import CLEANING_HEADING
from roomba.ui.exploring import TASKS
from roomba.ui.menu import Menu


def use(robot: FakeRobot, lines: Iterable[str]) -> list[str]:
    """Run the whole menu on prepared lines; return what it printed."""
    output, answers = io.StringIO(), TypedAnswers(lines)
    console = Console(file=output, force_terminal=False)
    menu = Menu(
        robot, answers, console, more=TASKS, more_heading=CLEANING_HEADING, clock=robot.clock
    )
    assert menu.run() == 0
    return output.getvalue().splitlines()


def test_it_comes_after_cleaning_and_the_others_keep_their_numbers() -> None:
    lines = use(FakeRobot(), [])
    assert lines[6:12] == [
        "Or press 5-11 to clean:",
        "  5. Clean",
        "  6. Pause, or go on",
        "  7. Stop, and stay",
        "  8. Dock: onto the charging station, by its beams",
        "  9. What the robot does",
    ]
    assert lines[12] == "  10. Explore: make a map of a home that it does not know"


def test_a_robot_whose_bin_is_full_is_told_that_it_was_emptied() -> None:
    robot = FakeRobot()
    robot.is_bin_full = True
    lines = use(robot, ["9", "11", "9"])
    states = [line for line in lines if line.startswith("State: ")]
    assert ["bin full" in state for state in states] == [True, False]
    assert "The robot knows that its dust bin is empty." in lines


def test_an_exploration_is_told_during_and_after() -> None:
    lines = use(FakeRobot(), ["10"])
    told = [line for line in lines if line.startswith("The robot knows")]
    assert told[0] == "The robot knows 0.00 m²."
    assert 5 <= len(told) <= 8
    end = lines.index("All that can be seen is mapped, and the robot is back on its station.")
    assert lines[end + 1 : end + 4] == [
        "Known: 40.00 m²",
        "Distance travelled: 5.00 m",
        "Time taken: 20 s",
    ]


def test_a_refusal_is_told_with_its_reason_and_nothing_else() -> None:
    script = ErrandScript(ErrandOutcome.REFUSED, message="there is nothing to explore")
    lines = use(FakeRobot(errands=[script]), ["10"])
    assert "The robot refuses: there is nothing to explore" in lines
    assert not any(line.startswith("Known") for line in lines)


@pytest.mark.parametrize(
    ("outcome", "text"),
    [
        (ErrandOutcome.STUCK, "The robot is stuck: below a chair"),
        (ErrandOutcome.BATTERY, "The battery did not last: below a chair"),
        (ErrandOutcome.NOT_DOCKED, "All was seen, but the robot is not on its station: below a"),
    ],
)
def test_what_went_wrong_is_told(outcome: ErrandOutcome, text: str) -> None:
    script = ErrandScript(outcome, after=3.0, message="below a chair")
    lines = use(FakeRobot(errands=[script]), ["10"])
    assert any(line.startswith(text) for line in lines)
    assert "Time taken: 3 s" in lines


def test_who_does_it_may_fall_silent() -> None:
    script = ErrandScript(ErrandOutcome.DISCONNECTED, after=3.0, message="no word of it")
    lines = use(FakeRobot(errands=[script]), ["10"])
    assert any(line.startswith("The connection to the exploration was lost") for line in lines)
    assert not any(line.startswith("Distance") for line in lines)
