"""The time of a device that counts for itself, as time of the clock here."""

from __future__ import annotations

from typing import Final

_MOST_DRIFT: Final = 0.0005
"""Share; so much faster than the clock here a device's may go (crystals: 0.0001)."""
_LARGEST_OFFSET: Final = 0.5
"""s; a device that is farther off began anew."""


class DeviceClock:
    """Bytes come late by what they wait on the way, never early: the least delay is that of none.

    The device counts ms and begins anew after ``lap``.
    """

    def __init__(self, lap: int) -> None:
        self._lap = lap
        self._before: tuple[int, float] | None = None
        self._counted = 0.0
        self._offset = 0.0

    def host_time(self, told: int, arrived: float) -> float:
        """Return when ``told``, ms, was, in s of the clock by which it ``arrived``."""
        if self._before is not None:
            before, at = self._before
            self._counted += 1e-3 * ((told - before) % self._lap)
            self._offset = min(self._offset + _MOST_DRIFT * (arrived - at), arrived - self._counted)
            if arrived - self._counted - self._offset > _LARGEST_OFFSET:
                self._before = None
        if self._before is None:
            self._counted, self._offset = 0.0, arrived
        self._before = told, arrived
        return self._counted + self._offset
