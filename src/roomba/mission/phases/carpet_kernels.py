"""Feeling carpet by the brush's motor, compiled: one function for ticks and for bursts of them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part

CARPET_SENSE: Final = np.dtype(
    [
        ("carpet_from", "f8"),  # A; a mean current from which it is on carpet
        ("floor_below", "f8"),  # A; and below which it is off it
        ("rests_below", "f8"),  # A; with less the brush rests, which tells nothing
        ("share", "f8"),  # 0..1; of the newest current in the mean
        ("mean", "f8"),  # A; nan before the first
        ("is_on", "?"),
    ],
    align=True,
)
"""What the brush's current tells of the floor, one row."""


@entry
def note_current(rows: NDArray[np.void], current: float) -> None:
    """Take the current of a tick, A."""
    row: Any = rows[0]
    row.mean, row.is_on = _felt(row, current)


@entry
def changes_floor(rows: NDArray[np.void], current: float) -> bool:
    """Tell whether the current of a tick, A, would show another floor; it is not taken."""
    row: Any = rows[0]
    return bool(_felt(row, current)[1] != row.is_on)


@inner_part
def _felt(row: Any, current: float) -> tuple[float, bool]:
    """Return the mean current, A, and whether that is one on carpet."""
    if current < row.rests_below:
        return row.mean, row.is_on
    mean = current if np.isnan(row.mean) else row.mean + row.share * (current - row.mean)
    if row.is_on:
        return mean, mean >= row.floor_below
    return mean, mean >= row.carpet_from
