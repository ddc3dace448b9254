"""Times of recording that fall: the recorder's clock was set back, or parts were moved."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from typing import Final

import numpy as np

from roomba.arrays import Floats, Ints64

_SET_BACK: Final = 1.0
"""s; a recorder's clock that is set back by more begins another run."""
_LASTING: Final = 10
"""Messages; if so many are earlier than what was recorded before, the clock was set back."""
_CUTS: Final = 4
"""Cuts at most for each part that was moved; a clock that was set back makes many more."""
_JOINT: Final = 5.0
"""Usual steps, at most, between two parts of one recording where it was cut."""


def gone_on(times: Floats, kinds: Sequence[Hashable]) -> Floats:
    """Return times of recording, s, that go on where the clock of the recorder was set back.

    They are of messages as :func:`clock_shifts` takes them.
    """
    return times + clock_shifts(times, kinds)


def clock_shifts(times: Floats, kinds: Sequence[Hashable]) -> Floats:
    """Return what to add to times of recording, s: they go on where the clock was set back.

    The times are in the order of recording, of messages of some ``kinds``. A message counts as
    earlier only beside others of its own kind: some logs are written kind by kind. What is added
    stays the same until the clock is set back again. It is 0 where the parts of a recording merely
    lie in another order, so that by their own times each fits beside the others.
    """
    shifts = _shifts_where_set_back(times, kinds)
    if not shifts.any():
        return shifts
    parts = np.cumsum(np.diff(shifts, prepend=0.0) != 0.0)
    by_kind = (np.array([each == kind for each in kinds]) for kind in set(kinds))
    fit = all(_fit_together(times[own], parts[own]) for own in by_kind)
    return np.zeros(len(times)) if fit else shifts


def _shifts_where_set_back(times: Floats, kinds: Sequence[Hashable]) -> Floats:
    """Return what to add if the clock was set back wherever time falls, and goes on from there."""
    usual = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    told = times.tolist()
    newest: dict[Hashable, float] = {}
    shift = 0.0
    shifts = np.zeros(len(told))
    for first in range(len(told)):
        next_ones = range(first, min(first + _LASTING, len(told)))
        if (
            len(next_ones) == _LASTING
            and all(
                told[at] + shift < newest.get(kinds[at], -math.inf) - _SET_BACK for at in next_ones
            )
            and _go_forward([(kinds[at], told[at]) for at in next_ones])
        ):
            shift = max(newest.values()) + usual - told[first]
        shifts[first] = shift
        newest[kinds[first]] = max(newest.get(kinds[first], -math.inf), told[first] + shift)
    return shifts


def _go_forward(messages: Sequence[tuple[Hashable, float]]) -> bool:
    """Whether times do not fall again from one message to the next of its kind."""
    before: dict[Hashable, float] = {}
    for kind, time in messages:
        if time < before.get(kind, -math.inf) - _SET_BACK:
            return False
        before[kind] = time
    return True


def _fit_together(times: Floats, parts: Ints64) -> bool:
    """Whether parts of one kind's times lie beside each other, as if they were cut and moved.

    Each fills a hole of the others, or begins where another one ends.
    """
    order = np.argsort(times, kind="stable")
    steps, changes = np.diff(times[order]), np.diff(parts[order]) != 0
    if not changes.any():
        return True
    most = _JOINT * float(np.median(steps[~changes])) if (~changes).any() else 0.0
    cuts = _CUTS * (len(np.unique(parts)) - 1)
    return np.count_nonzero(changes) <= cuts and float(steps[changes].max()) <= most
