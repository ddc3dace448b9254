"""What is learned of the rooms' dirt, live: each clean that ends tells how dirty they were."""

from __future__ import annotations

import datetime as dt
from collections.abc import Collection, Mapping, Sequence

from roomba.client.protocol import CleanReport
from roomba.configuration.household import DueConfig
from roomba.household.folder import KeptValues
from roomba.plans.due import DirtRecords, RoomNeed, learned, needs_of


class DirtKeeper:
    """Learns from reports, and keeps what it learned."""

    def __init__(self, kept: KeptValues, config: DueConfig) -> None:
        """Read what was kept."""
        self._kept, self._config = kept, config
        self._records = self._written = kept.read(DirtRecords())

    def note(self, report: CleanReport | None, at: dt.datetime) -> None:
        """Learn from a clean if one ended, and keep what is not kept yet; raises OSError."""
        records = self._records
        if report is not None:
            records = learned(records, report.rooms, at, self._config)
        self.keep(records)

    def renamed(self, names: Mapping[str, str], rooms: Collection[str]) -> DirtRecords:
        """Return what was learned with new names of ``rooms``, in ``names`` by the old ones."""
        return self._records.with_room_names(names, rooms)

    def keep(self, records: DirtRecords) -> None:
        """Use ``records`` from now on, and write them; raises OSError, but uses them even then."""
        self._records = records
        if records != self._written:
            self._kept.write(records)
            self._written = records

    def needs(self, rooms: Sequence[str], now: dt.datetime, period: float) -> tuple[RoomNeed, ...]:
        """Return what rooms need now, if the next time is ``period`` days later."""
        return needs_of(self._records, rooms, now, period, self._config)
