"""Days by a rule of iCalendar (RRULE of RFC 5545), without times of the day."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from dateutil.rrule import rrule, rrulestr

_KEYS: Final = {
    "DAILY": {"INTERVAL"},
    "WEEKLY": {"INTERVAL", "BYDAY", "WKST", "BYMONTH"},
    "MONTHLY": {"INTERVAL", "BYDAY", "BYMONTHDAY", "BYSETPOS", "BYMONTH"},
    "YEARLY": {"INTERVAL", "BYDAY", "BYMONTHDAY", "BYSETPOS", "BYMONTH"},
}
"""What a rule of each frequency may have beside COUNT and UNTIL.

Other keys say times, or what another frequency can say. With these keys alone it takes less than a
second to find that a rule never matches (a daily one is tried day by day, up to the year 9999).
"""
_ENDS: Final = {"COUNT", "UNTIL"}
_YEARS: Final = (2000, 2100)
"""The first day of a plan lies between these."""
_MOST: Final = 366
"""The greatest INTERVAL of a rule."""
_KEPT: Final = 256
"""Rules that are kept parsed."""


def require_days(rule: str, begins: dt.date) -> None:
    """Raise ValueError, with what was expected, for a rule that is invalid or has no day."""
    if not _YEARS[0] <= begins.year <= _YEARS[1]:
        raise ValueError(f"expected a first day from {_YEARS[0]} to {_YEARS[1]}, got {begins}")
    if next(days_from(rule, begins, begins), None) is None:
        raise ValueError(f"expected a rule with a day at least, got {rule!r}, which has none")


def days_from(rule: str, begins: dt.date, first: dt.date) -> Iterator[dt.date]:
    """Yield the days, from ``first`` on, of a rule that begins on a day; raises ValueError."""
    parsed = _parsed(rule, begins)
    for day in parsed.xafter(dt.datetime.combine(first, dt.time()), inc=True):
        yield day.date()


@lru_cache(_KEPT)
def _parsed(rule: str, begins: dt.date) -> rrule:
    parts = dict(_part_of(part, rule) for part in rule.upper().split(";"))
    allowed = _KEYS.get(parts.get("FREQ", ""))
    if allowed is None:
        raise ValueError(f"expected FREQ to be one of {', '.join(_KEYS)}, got {rule!r}")
    others = set(parts) - allowed - _ENDS - {"FREQ"}
    if others:
        raise ValueError(
            f"expected of a {parts['FREQ'].lower()} rule {', '.join(sorted(allowed | _ENDS))}, "
            f"got {', '.join(sorted(others))}"
        )
    if not parts.get("INTERVAL", "1").isdecimal() or not 0 < int(parts.get("INTERVAL", 1)) <= _MOST:
        raise ValueError(f"expected an INTERVAL from 1 to {_MOST}, got {rule!r}")
    try:
        parsed = rrulestr(rule.upper(), dtstart=dt.datetime.combine(begins, dt.time()))
    except (ValueError, TypeError, KeyError, IndexError, OverflowError) as error:
        raise ValueError(f"expected days by a rule of iCalendar, got {rule!r}: {error}") from error
    if not isinstance(parsed, rrule):
        raise ValueError(f"expected one rule, got {rule!r}")
    return parsed


def _part_of(part: str, rule: str) -> tuple[str, str]:
    key, equals, value = part.partition("=")
    if key == "BYDAY" and not value:
        raise ValueError("expected a day of the week at least, got none")
    if not (equals and key and value):
        raise ValueError(f"expected a rule such as FREQ=WEEKLY;BYDAY=MO,TH, got {rule!r}")
    return key, value
