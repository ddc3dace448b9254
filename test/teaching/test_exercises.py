"""Each exercise about ROS: what it begins with does not pass, and a solution does."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from roomba.commands.exercise.command import main
from roomba.commands.exercise.course import COURSE
from roomba.commands.exercise.verdict import NotYetError
from roomba_ros.exercises import camera_service, dirt_node, walk_action

SOLUTIONS = Path(__file__).with_name("solutions")
NUMBERS = {each.name: number for number, each in enumerate(COURSE, 1)}
NOT_YET = {
    "dirt_node": "your node to hear dirt_raw within 5 s; your program is the node /dirt_pub_node, "
    "which publishes /dirt (std_msgs/Float32), hears nothing, serves nothing",
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


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ("rospy.init_node('dirt')\nrospy.spin()\n", "to be the node dirt_pub_node, it is /dirt\n"),
        ("rospy.init_node('dirt_pub_node')\n", "ended with status 0: does it loop, or spin?"),
    ],
)
def test_a_node_of_another_name_or_that_ends_is_told_at_once(
    lines: str, told: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "dirt_node.py"
    file.write_text(f"import rospy\n{lines}", "utf-8")
    assert main([str(NUMBERS["dirt_node"]), "--check", "--file", str(file)]) == 1
    assert told in capfd.readouterr().out


def test_pictures_of_two_angles_or_with_two_colours_exchanged_are_told_apart() -> None:
    exchanged = [colour[::-1] for colour in camera_service.COLOURS.values()]
    assert len({*camera_service.COLOURS.values(), *exchanged}) == 2 * len(camera_service.COLOURS)


@pytest.mark.parametrize(
    "answer",
    [
        lambda angle: max(-30, min(30, 15 * int(angle / 15 + 0.5))),
        lambda angle: max(-30, min(30, 15 * int(angle / 15))),
        lambda angle: max(-30, min(30, 15 * math.floor(angle / 15))),
        lambda angle: 15 * round(angle / 15),
        lambda angle: abs(max(-30, min(30, 15 * round(angle / 15)))),
    ],
)
def test_an_angle_is_asked_for_which_a_wrong_rule_rounds_to_another_picture(
    answer: Callable[[float], int],
) -> None:
    assert any(answer(degrees) != angle for degrees, angle in camera_service.asked())


@pytest.mark.parametrize(
    ("distances", "told"),
    [
        ([1.0, 0.5], "expected feedback twice a second, got 2"),
        ([1.0, 1.0, 1.0], "0.10 m were left, distance told 1.00"),
        ([1.0, 0.0, 0.0], "0.60 m were left, distance told 0.00"),
    ],
)
def test_a_distance_that_is_not_what_was_left_is_told(distances: list[float], told: str) -> None:
    with pytest.raises(NotYetError, match=told):
        walk_action.expect_distances(list(zip(distances, (1.0, 0.6, 0.1), strict=False)))


def test_a_time_that_a_walk_did_not_take_is_told() -> None:
    with pytest.raises(NotYetError, match=r"a walk took 0.8 s, time_spent is 2.00"):
        walk_action.expect_time("a walk", 0.8, 2.0)


@pytest.mark.parametrize("between", [0.14, 0.33])
def test_another_rate_than_five_a_second_is_told(between: float) -> None:
    dirt_node.expect_rate([0.0, 0.2, 0.4, 0.65])
    with pytest.raises(NotYetError, match=f"one came each {between} s"):
        dirt_node.expect_rate([0.0, between, 2.0 * between])
