"""The state as published to a smart home: plain values, rounded so that they seldom change."""

from __future__ import annotations

import math
from typing import Any, Final

from roomba.client.under_way import is_running
from roomba.client.view import HomeView, RobotView
from roomba.vocabulary import Phase

_LONGEST: Final = 255
"""Characters of a state in Home Assistant."""
_STEP: Final = 5
"""s; times are rounded to it, so that they change less often than the robot is looked at."""


class StateTeller:
    """Makes the published state of one robot, and measures the time of its runs."""

    def __init__(self) -> None:
        """Begin before the first look."""
        self._began: float | None = None

    def state_of(self, view: RobotView, fan: str) -> dict[str, Any]:
        """Return the state; m2, s, g, battery in %. What is not known is None.

        ``area`` and ``time`` are of the run under way, else of the last one. ``fan`` is the level
        with which a clean begins.
        """
        vacuum, last = view.vacuum, view.last
        running = is_running(vacuum, before=self._began is not None)
        if not running:
            self._began = None
        elif self._began is None or self._began > view.time:
            self._began = view.time
        area = vacuum.covered if running or last is None else last.covered
        since = view.time - self._began if self._began is not None else math.nan
        time = since if running or last is None else last.duration
        return {
            "state": vacuum.state,
            "phase": vacuum.phase,
            "fan_speed": fan,
            "battery": _rounded(100.0 * vacuum.battery, 0),
            "area": _rounded(area, 1),
            "time": _in_steps(time),
            "to_go": _in_steps(vacuum.seconds_to_go),
            "bin": _rounded(view.dirt, 1),
            "bag": _rounded(100.0 * view.bag, 0),
            "bin_full": vacuum.phase == Phase.BIN_FULL,
            "room": vacuum.room[:_LONGEST] or "none",
            "error": shortened(vacuum.message or view.held or view.doubt) or "none",
        }


def attributes_of(home: HomeView) -> dict[str, Any]:
    """Return what seldom changes: names that commands take, and where the station is, m."""
    return {
        "rooms": [room.name for room in home.rooms],
        "zones": [zone.name for zone in home.zones],
        "station": [round(value, 2) for value in home.station[:2]],
    }


def shortened(text: str) -> str:
    """Return a text as long as the state of a sensor may be."""
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def _rounded(value: float, digits: int) -> float | None:
    return round(value, digits) + 0.0 if math.isfinite(value) else None


def _in_steps(seconds: float) -> int | None:
    return _STEP * round(seconds / _STEP) if math.isfinite(seconds) else None
