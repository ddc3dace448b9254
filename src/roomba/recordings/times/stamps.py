"""Times of a recorded drive: what its stamps say, mended where they cannot be true.

A message has a stamp, when it was measured by the clock of its driver, and an arrival, when it was
recorded by the clock of the recorder. Stamps are better as long as they go on as arrivals do.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from roomba.arrays import Floats, Ints64, Mask

CLOCKS: Final = 1.0
"""s; delays between stamp and arrival that differ by more are of two clocks."""
_EARLY: Final = 0.1
"""s; if there is one clock, no message is recorded so long before its stamp."""
JUMP: Final = 0.4
"""s; a step between stamps that differs more from that between arrivals is a jump of the clock."""
_COARSE: Final = 0.2
"""Share of stamps equal to the one before, from which a clock is too coarse to go by."""
_SHORT: Final = 12
"""Messages; in a piece of so few, each stamp may be wrong by another amount."""
_HOLE: Final = (0.5, 2.5)
"""Shares of the usual short and long steps: at least and at most so far from the next stamps are
those of messages that came late."""
_SHORT_STEP, _LONG_STEP = 0.1, 0.9
"""Quantiles of the steps: drivers may send at once what came while they were busy."""
_AT_ONCE: Final = 0.5
"""Share of the usual step; a message that comes sooner after another one was held up with it."""
_EVEN: Final = (0.5, 1.5)
"""Shares of the usual step; of evenly sent messages steps are neither shorter nor longer."""
_WORSE: Final = 2
"""If stamps are shifted to where arrivals say and more than so many times as many steps are uneven
then, it was the arrivals that were wrong."""
_BEYOND: Final = 4
"""Times the usual deviation of stamps from where arrivals say; no delay explains a larger one."""
_INFORMATIVE: Final = 0.5
"""Arrivals tell something if there are so many different ones, as a share of the stamps."""


@dataclass(slots=True)
class StampCounts:
    """How many messages there were, and in how many of them which fault of the stamp."""

    messages: int = 0
    without: int = 0
    """Without a stamp: the time of recording counts."""
    jumped: int = 0
    """Of a clock that had jumped: shifted to where arrivals say."""
    coarse: int = 0
    """Of a clock so coarse that many stamps are equal: the time of recording counts."""
    by_order: int = 0
    """Of times, as whole seconds, that most have in common with others: their order counts."""
    out_of_order: int = 0
    """Recorded after a later one of their channel: sorted."""
    equal: int = 0
    """Of the same time as another one of their channel: left out."""

    def add(self, other: StampCounts) -> None:
        """Count what another one did, too."""
        for field in fields(self):
            setattr(self, field.name, getattr(self, field.name) + getattr(other, field.name))

    @property
    def words(self) -> str:
        """All counts that are not zero, in a line."""
        told = (
            (self.without, "without a stamp (by the time of recording)"),
            (self.jumped, "of a clock that had jumped (shifted back)"),
            (self.coarse, "of a coarse clock (by the time of recording)"),
            (self.by_order, "of times that several have, as of whole seconds (by their order)"),
            (self.out_of_order, "out of order (sorted)"),
            (self.equal, "of a time that another one has (left out)"),
        )
        wrong = ", ".join(f"{count} {what}" for count, what in told if count)
        return f"{self.messages} messages: {wrong or 'all in order'}"


def delay_of(stamps: Floats, arrivals: Floats) -> float | None:
    """Return how long after its stamp a message is recorded, s, as a rule.

    It is the median of those that were not held up; None without stamps, and of a coarse clock.
    """
    valid = valid_stamps(stamps)
    if not valid.any() or _is_coarse(stamps[valid], arrivals[valid]):
        return None
    return _usual_delay(stamps[valid], arrivals[valid])


def mended(stamps: Floats, arrivals: Floats, delay: float, counts: StampCounts) -> Floats:
    """Return when the messages of a channel were measured, s, in the order of recording.

    ``delay`` is that of the channel whose clock counts; what was wrong is added to ``counts``.
    """
    counts.messages += len(stamps)
    valid = valid_stamps(stamps)
    own = delay_of(stamps, arrivals)
    if own is None:
        counts.coarse += int(np.count_nonzero(valid))
        counts.without += int(np.count_nonzero(~valid))
        return arrivals - delay
    shift = own - delay if is_of_another_clock(own, delay) else 0.0
    times, expected = stamps + shift, arrivals - (own - shift)
    counts.without += int(np.count_nonzero(~valid))
    times[~valid] = expected[~valid]
    if arrivals_tell(stamps[valid], arrivals):
        times, jumped = _without_jumps(times, expected)
        counts.jumped += jumped
    before = np.maximum.accumulate(times)
    counts.out_of_order += int(np.count_nonzero(times < before))
    return times


def arrivals_tell(stamps: Floats, arrivals: Floats) -> bool:
    """Return whether so many arrivals, [n], differ that they tell something of stamps, [m]."""
    return len(np.unique(arrivals)) > _INFORMATIVE * len(np.unique(stamps))


def in_order(times: Floats, channels: Ints64, ranks: Ints64, counts: StampCounts) -> Ints64:
    """Return the numbers of messages in the order of ``times``, s, without doubles.

    ``channels`` tells of each message the channel; of a time those of the lowest of ``ranks``
    come first.
    """
    by_channel = np.lexsort((times, channels))
    same = (np.diff(times[by_channel]) == 0.0) & (np.diff(channels[by_channel]) == 0)
    is_kept = np.ones(len(times), np.bool_)
    is_kept[by_channel[1:][same]] = False
    counts.equal += int(np.count_nonzero(same))
    order = np.lexsort((ranks, times))
    return np.asarray(order[is_kept[order]], np.int64)


def _usual_delay(stamps: Floats, arrivals: Floats) -> float:
    """Return the median delay, s, of messages after which none came at once.

    Of some that were held up and come all together the last one had to wait least.
    """
    is_last = np.append(np.diff(arrivals) > _AT_ONCE * _usual_step(stamps), True)
    return float(np.median(arrivals[is_last] - stamps[is_last]))


def _usual_step(times: Floats) -> float:
    """Return the median step between ``times``, s, in their order; 0 of a single one."""
    return float(np.median(np.diff(np.sort(times)))) if len(times) > 1 else 0.0


def is_of_another_clock(delay: float, reference: float) -> bool:
    """Whether messages that come ``delay`` s after their stamps are stamped by another clock.

    Those of the clock that counts come ``reference`` s after theirs. None comes before its stamp.
    """
    off = delay - reference
    return abs(off) > CLOCKS or (delay < -_EARLY and off < -2.0 * _EARLY)


def valid_stamps(stamps: Floats) -> Mask:
    """Return which of some stamps, [n], s, tell a time at all."""
    return np.asarray(np.isfinite(stamps) & (stamps > 0.0))


def _is_coarse(stamps: Floats, arrivals: Floats) -> bool:
    """Whether many stamps are equal to the one before, and came as far apart as others."""
    if len(stamps) < 2:
        return False
    is_equal, arrived = np.diff(stamps) == 0.0, np.diff(arrivals)
    if float(np.mean(is_equal)) <= _COARSE:
        return False
    # What is recorded twice comes at nearly the same time.
    return float(np.median(arrived[is_equal])) > 0.5 * float(np.mean(arrived))


def _without_jumps(times: Floats, expected: Floats) -> tuple[Floats, int]:
    """Return ``times``, [n], s, with what had jumped shifted, and how many messages that was.

    It is by the ``expected`` ones, unless all but what stands apart would become too uneven.
    """
    shifted = times.copy()
    jumped = _unjumped(shifted, expected)
    certain = np.where(_stand_apart(times, expected), shifted, times)
    # Those that had jumped among others make steps shorter than they were.
    usual = max(_usual_step(certain), _usual_step(shifted))
    if _uneven_steps(shifted, usual) > _WORSE * _uneven_steps(certain, usual):
        return certain, int(np.count_nonzero(certain != times))
    return shifted, jumped


def _unjumped(times: Floats, expected: Floats) -> int:
    """Shift the pieces of ``times`` in which a clock was wrong; return how many messages that was.

    A piece begins where the step from one time to the next differs from the step that was
    ``expected`` by arrivals, and is the less usual one of both. So messages that were held up and
    then came all at once stay as they are: their stamps are usual. Messages that are late have
    stamps where the others leave a hole, and stay as well; in a short piece that is checked for
    each one.
    """
    if len(times) < 3:
        return 0
    step, arrived = np.diff(times), np.diff(expected)
    ordered = np.sort(times)
    steps = np.diff(ordered)
    usual = float(np.median(steps))
    hole = np.quantile(steps, (_SHORT_STEP, _LONG_STEP)) * _HOLE
    is_jump = np.abs(step - arrived) > JUMP
    is_jump &= np.abs(step - usual) > np.abs(arrived - usual)
    borders = [0, *(1 + np.flatnonzero(is_jump)).tolist(), len(times)]
    shifted = 0
    for first, end in itertools.pairwise(borders):
        off = -_usual_delay(times[first:end], expected[first:end])
        if abs(off) <= JUMP:
            continue
        if off < 0.0 and _fills_hole(times[first:end], ordered, hole):
            continue
        if end - first > _SHORT:
            times[first:end] -= off
            shifted += end - first
        else:
            shifted += _mend_each(times[first:end], expected[first:end], ordered, hole)
    return shifted


def _stand_apart(times: Floats, expected: Floats) -> Mask:
    """Return which of ``times``, [n], s, are far from all those near the ``expected`` ones.

    A clock had jumped there, however unevenly messages come: stamps of late ones lie among others.
    """
    if len(times) < 2:
        return np.zeros(len(times), np.bool_)
    order, off = np.argsort(times), np.abs(times - expected)
    steps = np.diff(times[order])
    gap = max(JUMP, _HOLE[1] * float(np.quantile(steps, _LONG_STEP)))
    groups = np.zeros(len(times), np.int64)
    groups[order[1:]] = np.cumsum(steps > gap)
    near = np.bincount(groups, off <= max(JUMP, _BEYOND * float(np.median(off))))
    return np.asarray(near[groups] == 0.0)


def _uneven_steps(times: Floats, usual: float) -> int:
    """Return how many steps between ``times``, s, in order are much unlike a ``usual`` one."""
    steps = np.diff(np.sort(times))
    least, most = np.multiply(_EVEN, usual)
    return int(np.count_nonzero((steps < least) | (steps > most)))


def _mend_each(times: Floats, expected: Floats, ordered: Floats, hole: Floats) -> int:
    """Set each of some ``times`` that is not just late to the ``expected`` one; return how many."""
    piece = np.sort(times)
    is_late = np.array(
        [
            time < at and _is_between(time, piece, ordered, hole)
            for time, at in zip(times.tolist(), expected.tolist(), strict=True)
        ]
    )
    times[:] = np.where(is_late, times, expected)
    return int(np.count_nonzero(~is_late))


def _is_between(time: float, piece: Floats, ordered: Floats, hole: Floats) -> bool:
    """Whether the stamps ``ordered`` but for those of a ``piece`` leave room for one, s."""
    least, most = hole
    near = ordered[np.searchsorted(ordered, time - most) : np.searchsorted(ordered, time + most)]
    others = near[~np.isin(near, piece)]
    return bool((others < time).any() and (others > time).any()) and bool(
        np.abs(others - time).min() > least and np.count_nonzero(near == time) == 1
    )


def _fills_hole(piece: Floats, ordered: Floats, hole: Floats) -> bool:
    """Whether a piece of the stamps ``ordered`` lies where the others leave room for just it.

    ``hole`` [2] is how far it is from the next ones at least and at most, s.
    """
    low, high = float(piece.min()), float(piece.max())
    first = int(np.searchsorted(ordered, low, "left"))
    end = int(np.searchsorted(ordered, high, "right"))
    if end - first != len(piece) or first == 0 or end == len(ordered):
        return False
    least, most = hole
    before, after = low - float(ordered[first - 1]), float(ordered[end]) - high
    return bool(least < before < most and least < after < most)
