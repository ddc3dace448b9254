"""Moments of plans and quiet hours: times of the clock on the wall, through changes of the clock.

A time that a day does not have, because the clock goes forward over it, counts by the clock as it
was before (02:30 becomes 03:30); of a time that a day has twice, the first counts. So each day of a
plan has each of its times once. Quiet hours that end at a time that a day has twice end with the
second.
"""

from __future__ import annotations

import datetime as dt
import zoneinfo
from collections.abc import Iterable, Iterator
from typing import Final

from roomba.plans.days import days_from
from roomba.plans.plan import Plan, QuietHours

UTC: Final = dt.timezone.utc
_DAY: Final = dt.timedelta(days=1)
_ALL_QUIET: Final = 8 * _DAY
"""Quiet hours that leave no gap for a week never end: the search for their end stops here."""
_ASTRAY: Final = 2 * _DAY
"""No change of any clock moved a time farther: a whole day was left out in Samoa in 2011."""


def moment_of(day: dt.date, time: dt.time, zone: zoneinfo.ZoneInfo) -> dt.datetime:
    """Return when a time of a day is, in UTC."""
    return dt.datetime.combine(day, time.replace(fold=0), zone).astimezone(UTC)


def _end_of(day: dt.date, time: dt.time, zone: zoneinfo.ZoneInfo) -> dt.datetime:
    """Return when quiet hours end, in UTC: when the clock has shown that time for the last time."""
    both = [dt.datetime.combine(day, time.replace(fold=fold), zone) for fold in (0, 1)]
    return max(moment.astimezone(UTC) for moment in both)


def next_after(plan: Plan, zone: zoneinfo.ZoneInfo, moment: dt.datetime) -> dt.datetime | None:
    """Return the first time of a plan after a moment, in UTC; None if there is no more."""
    found: dt.datetime | None = None
    begin = moment.astimezone(zone).date() - _ASTRAY
    for day, at in _moments(plan, zone, begin):
        if found is not None and day > found.astimezone(zone).date() + _ASTRAY:
            break
        if at > moment and (found is None or at < found):
            found = at
    return found


def last_until(
    plan: Plan, zone: zoneinfo.ZoneInfo, after: dt.datetime, moment: dt.datetime
) -> dt.datetime | None:
    """Return the last time of a plan after one moment and up to another, in UTC; None without."""
    found: dt.datetime | None = None
    last = moment.astimezone(zone).date() + _ASTRAY
    for day, at in _moments(plan, zone, after.astimezone(zone).date() - _ASTRAY):
        if day > last:
            break
        if after < at <= moment and (found is None or at > found):
            found = at
    return found


def quiet_until(
    quiet: Iterable[QuietHours], zone: zoneinfo.ZoneInfo, moment: dt.datetime
) -> dt.datetime | None:
    """Return when the quiet hours of a moment end, in UTC; None if it is in none.

    Quiet hours that follow on one another end with the last of them.
    """
    windows, ends = list(quiet), moment
    while ends - moment < _ALL_QUIET:
        around = _windows(windows, zone, ends)
        latest = max((end for begin, end in around if begin <= ends < end), default=None)
        if latest is None:
            break
        ends = latest
    return ends.astimezone(UTC) if ends > moment else None


def _windows(
    quiet: list[QuietHours], zone: zoneinfo.ZoneInfo, moment: dt.datetime
) -> Iterator[tuple[dt.datetime, dt.datetime]]:
    """Yield begin and end of all quiet hours around a moment."""
    today = moment.astimezone(zone).date()
    for day in (today - _ASTRAY, today - _DAY, today):
        for hours in quiet:
            if day.weekday() in hours.days:
                last = day if hours.begins < hours.ends else day + _DAY
                yield moment_of(day, hours.begins, zone), _end_of(last, hours.ends, zone)


def _moments(
    plan: Plan, zone: zoneinfo.ZoneInfo, first: dt.date
) -> Iterator[tuple[dt.date, dt.datetime]]:
    """Yield the days of a plan from ``first`` on, each with each of its moments."""
    for day in days_from(plan.rule, plan.begins, first):
        for time in plan.at:
            yield day, moment_of(day, time, zone)
