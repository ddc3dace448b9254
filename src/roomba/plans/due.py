"""Which rooms are due by their dirt: how fast each becomes dirty is learned from clean to clean.

It has no clock and asks no robot. Grains are those that the robot's dirt sensor counts.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from pydantic import Field

from roomba.configuration.frozen import Frozen, NotNegative
from roomba.configuration.household import DueConfig
from roomba.plans.moment import Moment, is_set
from roomba.vocabulary import MOST_ZONES, RoomDirt

DAY: Final = 86400.0
"""s."""


class RoomRecord(Frozen):
    """When a room was cleaned last, and how fast it becomes dirty, grains/m2 a day."""

    cleaned: Moment
    rate: NotNegative | None = None
    """None until it was cleaned twice."""


class DirtRecords(Frozen):
    """All that is learned, by the rooms' names."""

    rooms: dict[str, RoomRecord] = Field(default={}, max_length=MOST_ZONES)

    def with_room_names(self, names: Mapping[str, str], rooms: Collection[str]) -> DirtRecords:
        """Return the records with new names; ``names`` has them by the old ones of ``rooms``.

        A room that others were joined to keeps its own record. A record that is left of a room long
        gone is replaced.
        """
        kept = {name: record for name, record in self.rooms.items() if name not in names}
        moved = {now: self.rooms[name] for name, now in names.items() if name in self.rooms}
        of_rooms = {name: record for name, record in kept.items() if name in rooms}
        return DirtRecords(rooms={**kept, **moved, **of_rooms})


@dataclass(frozen=True, slots=True)
class RoomNeed:
    """How often a room is to be cleaned: at ``every`` so many times of a plan, None if not known.

    ``reason`` says why, and ``is_due`` whether it is to be cleaned now.
    """

    room: str
    every: int | None
    is_due: bool
    reason: str


def learned(
    records: DirtRecords, found: Sequence[RoomDirt], at: dt.datetime, config: DueConfig
) -> DirtRecords:
    """Return what is known after a clean that ended ``at`` a moment and ``found`` dirt in rooms.

    A room of which too little was swept counts as not cleaned. While the clock is not set nothing
    is learned.
    """
    if not is_set(at):
        return records
    rooms = dict(records.rooms)
    for each in found:
        if each.share < config.least_share:
            continue
        before = rooms.get(each.room)
        rate = None if before is None else before.rate
        if before is not None:
            days = (at - before.cleaned).total_seconds() / DAY
            if days < 0.0:
                # The clock was ahead before, and by how much is not known.
                rooms[each.room] = RoomRecord(cleaned=at, rate=rate)
                continue
            if days < config.shortest:
                # Cleaned again at once: what lies there says nothing of a day.
                rooms[each.room] = RoomRecord(cleaned=before.cleaned, rate=rate)
                continue
            now = each.grains / days
            rate = now if rate is None else rate + config.learning * (now - rate)
        rooms[each.room] = RoomRecord(cleaned=at, rate=rate)
    return DirtRecords(rooms=rooms)


def needs_of(
    records: DirtRecords,
    names: Sequence[str],
    now: dt.datetime,
    period: float,
    config: DueConfig,
) -> tuple[RoomNeed, ...]:
    """Return what each of some rooms needs ``now``, if the next clean is ``period`` days later.

    The room that becomes dirty the fastest is cleaned each time. No other room may become dirtier
    than that one does from one time to the next: a room is due if it would by the next time. A room
    of which nothing is known is due.
    """
    rates = {name: _rate(records, name) for name in names}
    known = {name: rate for name, rate in rates.items() if rate is not None}
    dirtiest = max(known, key=lambda name: known[name], default="")
    most = known.get(dirtiest, 0.0)
    return tuple(
        _need(name, rates[name], records, now, period, (dirtiest, most), config) for name in names
    )


def _rate(records: DirtRecords, name: str) -> float | None:
    record = records.rooms.get(name)
    return None if record is None else record.rate


def _need(
    name: str,
    rate: float | None,
    records: DirtRecords,
    now: dt.datetime,
    period: float,
    dirtiest: tuple[str, float],
    config: DueConfig,
) -> RoomNeed:
    room, most = dirtiest
    if rate is None:
        return RoomNeed(name, None, True, "how fast it becomes dirty is not known yet")
    times = _times(rate, most * (1.0 + config.spare), max(1, round(config.longest / period)))
    since = (now - records.rooms[name].cleaned).total_seconds() / DAY
    # Half a period: a clean ends some time after its plan's time.
    is_due = since >= (times - 0.5) * period or since < 0.0
    if name == room:
        return RoomNeed(name, times, is_due, "it becomes dirty the fastest")
    share = rate / most if most > 0.0 else 1.0
    return RoomNeed(name, times, is_due, f"it becomes {share:.2f} times as dirty as {room}")


def _times(rate: float, most: float, longest: int) -> int:
    """Return after how many times a room is as dirty as ``most``: 1 to ``longest`` of them."""
    # Divided only where that gives less than ``longest``: by a rate near 0 it would overflow.
    return longest if rate * longest <= most else max(1, int(most / rate))
