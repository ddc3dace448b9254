"""Carpet felt by the brush's motor."""

from __future__ import annotations

import numpy as np

from roomba.configuration.body import BrushConfig
from roomba.mission.phases.carpet import CarpetSense
from roomba.mission.phases.carpet_kernels import changes_floor

CONFIG = BrushConfig()
FLOOR, CARPET = 3.0 / 14.4, 6.0 / 14.4
"""A."""


def noted(sense: CarpetSense, *currents: float) -> list[bool]:
    """Return whether it is on carpet after each current, and compare with what was foretold."""
    found = []
    for current in currents:
        was_on, changes = sense.is_on, changes_floor(sense.rows, current)
        sense.note(current)
        assert changes is (sense.is_on is not was_on)
        found.append(sense.is_on)
    return found


def test_it_is_on_carpet_within_some_ticks_and_off_it_again() -> None:
    sense = CarpetSense(CONFIG)
    assert not any(noted(sense, *[FLOOR] * 20))
    onto = noted(sense, *[CARPET] * 20)
    assert 1 <= onto.index(True) <= 5
    assert all(onto[6:])
    off = noted(sense, *[FLOOR] * 20)
    assert 1 <= off.index(False) <= 5
    assert not any(off[6:])


def test_what_lies_between_is_what_it_was() -> None:
    between = 0.5 * (CONFIG.carpet_current + CONFIG.floor_current)
    sense = CarpetSense(CONFIG)
    assert not any(noted(sense, FLOOR, *[between] * 50))
    noted(sense, *[CARPET] * 20)
    assert all(noted(sense, *[between] * 50))


def test_noise_changes_nothing() -> None:
    random = np.random.default_rng(1)
    sense = CarpetSense(CONFIG)
    for mean, is_on in ((FLOOR, False), (CARPET, True)):
        noted(sense, *[mean] * 20)
        currents = (mean + 0.02 * random.standard_normal(10_000)).tolist()
        assert set(noted(sense, *currents)) == {is_on}


def test_a_brush_at_rest_tells_nothing() -> None:
    sense = CarpetSense(CONFIG)
    noted(sense, *[CARPET] * 20)
    assert all(noted(sense, *[0.01] * 200))
