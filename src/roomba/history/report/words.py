"""Figures in words, as reports and tables show them."""

from __future__ import annotations

import math
import time
from typing import Final

from roomba.history.run import RunFigures
from roomba.vocabulary import places_told

_SMALLEST: Final = 0.01
"""m2 that are told in numbers."""


def outcome_of(run: RunFigures) -> str:
    """Return how a run ended, as a sentence begins."""
    return run.outcome[:1].upper() + run.outcome[1:]


def number(value: float, digits: int, unit: str) -> str:
    """Return a number with its unit; a dash where it is not known."""
    return f"{value:.{digits}f} {unit}" if math.isfinite(value) else "–"


def area(value: float) -> str:
    """Return an area, m2, as a text that does not show a tiny one as 0."""
    return number(value, 2, "m²") if not value < _SMALLEST else f"< {_SMALLEST} m²"


def place(x: float, y: float) -> str:
    """Return a place, m."""
    return f"({x:.1f}, {y:.1f})"


def share(value: float) -> str:
    """Return a share, 0..1, in percent."""
    return number(100.0 * value, 1, "%")


def duration(seconds: float) -> str:
    """Return a time, s, as hours, minutes and seconds."""
    if not math.isfinite(seconds):
        return "–"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"


def moment(began: float) -> str:
    """Return a time of the wall clock."""
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(began))


def rate_of(run: RunFigures) -> str:
    """Return how much floor became clean in a minute, beside the least time for it."""
    if run.rate is None:
        return "–"
    told = f"{run.rate:.2f} m² a minute"
    times = run.times.times_least
    return told if times is None else f"{told}, {times:.2f} times the least time for that floor"


def time_rows(run: RunFigures) -> list[tuple[str, str, str]]:
    """Return where the time went: names, times, and shares; nothing where that was not counted."""
    whole = sum(seconds for _, seconds in run.times.parts)
    return [
        (name[:1].upper() + name[1:], duration(seconds), share(seconds / whole))
        for name, seconds in run.times.parts
        if seconds > 0.0
    ]


def figure_rows(run: RunFigures) -> list[tuple[str, str]]:
    """Return what a run achieved: names, and numbers with units."""
    source = run.source
    mapped = [("Mapped", area(run.mapped))] if math.isfinite(run.mapped) else []
    return [
        ("Began", moment(run.began)),
        ("Home", source.home),
        ("Seed", "–" if source.seed is None else str(source.seed)),
        ("Program", source.program),
        ("Outcome", outcome_of(run)),
        ("Clean", f"{number(run.covered, 2, 'm²')} of {number(run.wanted, 2, 'm²')}"),
        ("Share", share(run.fraction)),
        ("Missed", places_told(len(run.missed))),
        *mapped,
        ("Time", duration(run.duration)),
        ("Rate", rate_of(run)),
        ("Way", number(run.distance, 1, "m")),
        ("Turning", number(run.turning, 1, "rad")),
        ("Dirt", number(run.dirt, 2, "g")),
        ("Energy", number(run.energy, 2, "Wh")),
    ]
