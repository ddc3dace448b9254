import math

import pytest

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.driving.unknown_things import UnknownThings

CONFIG = RobotConfig()


def things() -> UnknownThings:
    return UnknownThings(CONFIG.walk, CONFIG.body, memory=60.0)


@pytest.mark.parametrize(
    ("left", "right", "side"), [(True, False, 1.0), (False, True, -1.0), (True, True, 0.0)]
)
def test_what_is_felt_touches_the_body_on_the_side_that_felt_it(
    left: bool, right: bool, side: float
) -> None:
    felt = things()
    felt.felt(10.0, Pose(1.0, 2.0, math.pi / 2), left, right)
    obstacles = felt.at(10.0)
    assert obstacles
    for x, y, radius in obstacles:
        assert math.dist((x, y), (1.0, 2.0)) == pytest.approx(CONFIG.body.radius + radius)
    # It looks along y: left of it is the smaller x.
    aside = sum(1.0 - x for x, _, _ in obstacles)
    assert aside * side > 0.0 if side else aside == pytest.approx(0.0)


def test_a_thing_of_another_size_touches_the_body_at_the_same_place() -> None:
    felt = things()
    felt.felt(10.0, Pose(1.0, 2.0, 0.3), True, True)
    for usual, small in zip(felt.at(10.0), felt.at(10.0, 0.01), strict=True):
        assert small[2] == 0.01
        assert math.dist(small[:2], (1.0, 2.0)) == pytest.approx(CONFIG.body.radius + 0.01)
        assert math.dist(small[:2], usual[:2]) == pytest.approx(usual[2] - 0.01)


def test_things_are_forgotten_after_a_while_for_they_move() -> None:
    felt = things()
    felt.felt(10.0, Pose(), True, True)
    assert felt.at(69.0)
    assert not felt.at(71.0)


def test_a_clock_set_back_forgets_nothing() -> None:
    felt = things()
    felt.felt(1000.0, Pose(), True, True)
    assert felt.at(1.0)
