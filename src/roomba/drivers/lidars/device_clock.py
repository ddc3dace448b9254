"""The time of a device with a counter of its own, converted to the clock here."""

from __future__ import annotations

from typing import Final

_MOST_DRIFT: Final = 0.0005
"""Share by which a device's clock may run slower than the one here (crystals: 0.0001)."""
_LARGEST_OFFSET: Final = 0.5
"""s; when bytes seem to be later than this, the device began to count anew."""


class DeviceClock:
    """Converts times; bytes come late, never early, so the least delay is taken to be none.

    The device counts ms and begins anew after ``lap`` ms.
    """

    def __init__(self, lap: int) -> None:
        self._lap = lap
        self._before: tuple[int, float] | None = None
        self._counted = 0.0
        self._offset = 0.0

    def host_time(self, told: int, arrived: float) -> float:
        """Return the device's time ``told``, ms, in s of the clock by which it ``arrived``."""
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
