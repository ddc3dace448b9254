"""Each exercise about ROS: what it begins with does not pass, and a solution does."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.commands.exercise.command import main
from roomba.commands.exercise.course import COURSE

SOLUTIONS = Path(__file__).with_name("solutions")
NUMBERS = {each.name: number for number, each in enumerate(COURSE, 1)}
NOT_YET = {
    "dirt_node": "your node to hear dirt_raw",
    "camera_service": "expected a picture of 64 x 48 pixels",
    "walk_action": "the robot is 1.00 m from (0.8, 0.6)",
}
"""What is told of the file that a learner begins with."""


@pytest.mark.parametrize("name", NOT_YET)
def test_a_solution_passes(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    file = SOLUTIONS / f"{name}.py"
    status = main([str(NUMBERS[name]), "--check", "--file", str(file)])
    told = capfd.readouterr()
    assert told.out.startswith("passed: "), told
    assert status == 0


@pytest.mark.parametrize("name", NOT_YET)
def test_what_a_learner_begins_with_does_not_pass_yet(
    name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    start = COURSE[NUMBERS[name] - 1].start
    assert main([str(NUMBERS[name]), "--check", "--file", str(start)]) == 1
    assert NOT_YET[name] in capfd.readouterr().out
