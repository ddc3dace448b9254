"""Gaps that a robot had better not go through: which are closed, and with what."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.geometry import RoundObstacle
from roomba.mission.inputs.gaps import closed_gaps

REACH, SPARE = 0.165, 0.06


def pair(gap: float) -> list[RoundObstacle]:
    """Return two thin things with so much room between them."""
    return [(1.0, 1.0, 0.02), (1.0 + gap + 0.04, 1.0, 0.02)]


@pytest.mark.parametrize(
    ("gap", "is_closed"),
    [
        (2.0 * REACH + 0.001, True),
        (2.0 * REACH + SPARE - 0.001, True),
        (2.0 * REACH - 0.001, False),
        (2.0 * REACH + SPARE + 0.001, False),
    ],
    ids=["just wide enough", "hardly wide enough", "closed anyway", "wide"],
)
def test_a_gap_is_closed_that_is_hardly_wide_enough(gap: float, is_closed: bool) -> None:
    closed = closed_gaps(pair(gap), REACH, SPARE)
    if not is_closed:
        assert closed == []
        return
    ((x, y, _),) = closed
    assert (x, y) == pytest.approx((1.02 + 0.5 * gap, 1.0))
    # Nowhere between them is there room for the body any more.
    standing = np.array(pair(gap) + closed)
    between = np.linspace(1.0, 1.04 + gap, 100)
    away = np.abs(between[:, None] - standing[:, 0]) - standing[:, 2]
    assert (away.min(axis=1) < REACH).all()


def test_a_chair_is_closed_on_all_sides() -> None:
    legs = [(x, y, 0.02) for x in (1.0, 1.4) for y in (1.0, 1.4)]
    closed = {(round(x, 3), round(y, 3)) for x, y, _ in closed_gaps(legs, REACH, SPARE)}
    assert closed == {(1.2, 1.0), (1.2, 1.4), (1.0, 1.2), (1.4, 1.2)}


def test_the_corner_of_one_thing_stays_open() -> None:
    walls = [(1.0 + 0.04 * step, 1.0, 0.02) for step in range(20)]
    walls += [(1.0, 1.0 + 0.04 * step, 0.02) for step in range(20)]
    assert closed_gaps(walls, REACH, SPARE) == []


def test_what_is_alone_has_no_gaps() -> None:
    assert closed_gaps([], REACH, SPARE) == []
    assert closed_gaps([(1.0, 1.0, 0.02)], REACH, SPARE) == []
