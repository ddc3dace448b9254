"""A lidar that turns while the robot turns: known times of its beams make it as good as any."""

from __future__ import annotations

import math

import pytest
from fixtures.drives.made_lidars import Errors, Lidar, mapped, outlines

from roomba.geometry import Pose

WALLS = outlines((0.0, 0.0, 5.0, 4.0), (3.3, 3.1, 3.8, 4.0), (0.0, 1.4, 0.3, 1.9))


def turning(time: float) -> Pose:
    """It drives around the room, and turns to and fro at up to 1 rad/s beside that."""
    time = max(time - 1.0, 0.0)
    angle = 0.3 * time
    swing = 0.7 * 4.5 / math.pi * (1.0 - math.cos(math.pi / 4.5 * time))
    return Pose(2.5 + math.cos(angle), 2.0 + 0.9 * math.sin(angle), angle + 0.5 * math.pi + swing)


def errors_of(lidar: Lidar, *, tells_time: bool = True) -> Errors:
    _, errors = mapped(lidar, turning, WALLS, 25.0, tells_time=tells_time)
    return errors


@pytest.mark.parametrize("step", [math.radians(1.0), -math.radians(1.0)], ids=["left", "right"])
def test_its_map_is_as_good_as_that_of_a_lidar_that_measures_at_once(step: float) -> None:
    instant = errors_of(Lidar(step=step, turns=False))
    swept, unknown = errors_of(Lidar(step=step)), errors_of(Lidar(step=step), tells_time=False)
    assert swept.way < 1.5 * instant.way
    assert swept.turn < 1.5 * instant.turn
    assert unknown.way > 5.0 * swept.way
    assert unknown.turn > 5.0 * swept.turn


def test_what_is_learned_of_its_latency_is_only_what_the_times_of_beams_do_not_say() -> None:
    mapper, _ = mapped(Lidar(), turning, WALLS, 25.0)
    assert mapper.latency == 0.0
