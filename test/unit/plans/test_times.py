"""Moments of plans through changes of the clock, against a slow reference, in several zones."""

from __future__ import annotations

import datetime as dt
from itertools import pairwise
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.plans.plan import Plan, QuietHours
from roomba.plans.times import UTC, last_until, moment_of, next_after, quiet_until

ZONES = (
    "Europe/Berlin",
    "America/New_York",
    "America/Sao_Paulo",  # until 2019 the clock changed at midnight
    "Australia/Lord_Howe",  # by half an hour
    "Pacific/Apia",  # in 2011 a whole day was left out
    "Africa/Casablanca",  # back and forth around Ramadan
    "Asia/Kathmandu",  # never, and 5:45 off
)
zones = st.sampled_from(ZONES).map(ZoneInfo)
minutes = st.builds(dt.time, st.integers(0, 23), st.integers(0, 59))
moments = st.datetimes(dt.datetime(2009, 1, 1), dt.datetime(2030, 1, 1), timezones=st.just(UTC))


def plan(rule: str = "FREQ=DAILY", *at: dt.time, begins: dt.date = dt.date(2008, 1, 1)) -> Plan:
    return Plan(name="all", rule=rule, at=at or (dt.time(9, 0),), begins=begins)


def local(moment: dt.datetime | None, zone: str) -> str:
    assert moment is not None
    return f"{moment.astimezone(ZoneInfo(zone)):%Y-%m-%d %H:%M}"


def test_nine_stays_nine_in_summer_and_in_winter() -> None:
    berlin = ZoneInfo("Europe/Berlin")
    begin = dt.datetime(2026, 3, 28, 12, tzinfo=UTC)
    first = next_after(plan(), berlin, begin)
    assert first == dt.datetime(2026, 3, 29, 7, 0, tzinfo=UTC)  # one hour of the night is left out
    before = next_after(plan(), berlin, begin - dt.timedelta(days=1))
    assert before == dt.datetime(2026, 3, 28, 8, 0, tzinfo=UTC)


def test_a_time_that_is_left_out_comes_an_hour_later_by_the_clock() -> None:
    berlin = ZoneInfo("Europe/Berlin")
    at = next_after(
        plan("FREQ=DAILY", dt.time(2, 30)), berlin, dt.datetime(2026, 3, 28, 12, tzinfo=UTC)
    )
    assert local(at, "Europe/Berlin") == "2026-03-29 03:30"


def test_quiet_hours_that_end_at_a_time_that_comes_twice_end_with_the_second() -> None:
    berlin, ends = ZoneInfo("Europe/Berlin"), dt.time(2, 30)
    quiet = QuietHours(begins=dt.time(1, 0), ends=ends)
    over = quiet_until([quiet], berlin, dt.datetime(2026, 10, 24, 23, 30, tzinfo=UTC))
    assert over == dt.datetime(2026, 10, 25, 1, 30, tzinfo=UTC)
    # A time that is left out comes an hour later, as ever.
    over = quiet_until([quiet], berlin, dt.datetime(2026, 3, 29, 0, 30, tzinfo=UTC))
    assert local(over, "Europe/Berlin") == "2026-03-29 03:30"


def test_of_a_time_that_comes_twice_the_first_counts() -> None:
    berlin = ZoneInfo("Europe/Berlin")
    half_past_two = plan("FREQ=DAILY", dt.time(2, 30))
    at = next_after(half_past_two, berlin, dt.datetime(2026, 10, 24, 12, tzinfo=UTC))
    assert at is not None
    assert at == dt.datetime(2026, 10, 25, 0, 30, tzinfo=UTC)
    following = next_after(half_past_two, berlin, at)
    assert following == dt.datetime(2026, 10, 26, 1, 30, tzinfo=UTC)


def test_a_day_that_is_left_out_is_made_up_for() -> None:
    apia = ZoneInfo("Pacific/Apia")
    found = [dt.datetime(2011, 12, 29, 20, tzinfo=UTC)]
    for _ in range(3):
        following = next_after(plan(), apia, found[-1])
        assert following is not None
        found.append(following)
    # Of the 30th, which there was not, the clean is on the 31st at the same time.
    assert [local(each, "Pacific/Apia") for each in found[1:]] == [
        "2011-12-31 09:00",
        "2012-01-01 09:00",
        "2012-01-02 09:00",
    ]


def test_a_plan_that_is_over_has_no_next_time() -> None:
    over = plan("FREQ=DAILY;COUNT=3")
    assert next_after(over, ZoneInfo("UTC"), dt.datetime(2026, 1, 1, tzinfo=UTC)) is None


@given(zones, moments, st.lists(minutes, min_size=1, max_size=3))
def test_next_and_last_are_those_of_all_moments_around(
    zone: ZoneInfo, moment: dt.datetime, at: list[dt.time]
) -> None:
    daily = plan("FREQ=DAILY", *at, begins=moment.date() - dt.timedelta(days=20))
    today = moment.astimezone(zone).date()
    days = [today + dt.timedelta(days=offset) for offset in range(-5, 6)]
    around = sorted({moment_of(day, time, zone) for day in days for time in daily.at})
    assert next_after(daily, zone, moment) == min(each for each in around if each > moment)
    begin = moment - dt.timedelta(days=3)
    assert last_until(daily, zone, begin, moment) == max(each for each in around if each <= moment)


@given(zones, moments, minutes)
def test_each_day_has_its_time_once(zone: ZoneInfo, moment: dt.datetime, time: dt.time) -> None:
    begins = moment.date() - dt.timedelta(days=5)
    daily, found = plan("FREQ=DAILY", time, begins=begins), [moment]
    for _ in range(12):
        following = next_after(daily, zone, found[-1])
        assert following is not None
        assert following > found[-1]
        found.append(following)
    gaps = [after - before for before, after in pairwise(found[1:])]
    # Days of 23 to 25 hours; one that was left out whole counts as the next.
    assert all(dt.timedelta(hours=22.9) <= gap <= dt.timedelta(hours=25.1) for gap in gaps)
    for each in found[1:]:
        wall = each.astimezone(zone)
        early = dt.datetime.combine(wall.date(), time)
        assert wall.replace(tzinfo=None) - early in (
            dt.timedelta(0),
            dt.timedelta(minutes=30),  # Lord Howe
            dt.timedelta(hours=1),
        )


NIGHT = QuietHours(begins=dt.time(22, 0), ends=dt.time(7, 0))


@pytest.mark.parametrize(
    ("at", "ends"),
    [
        ("2026-03-02 21:59", None),
        ("2026-03-02 22:00", "2026-03-03 07:00"),
        ("2026-03-03 06:59", "2026-03-03 07:00"),
        ("2026-03-03 07:00", None),
        ("2026-03-28 23:00", "2026-03-29 07:00"),
    ],
)
def test_quiet_hours_go_over_midnight(at: str, ends: str | None) -> None:
    berlin = ZoneInfo("Europe/Berlin")
    moment = dt.datetime.fromisoformat(at).replace(tzinfo=berlin)
    found = quiet_until([NIGHT], berlin, moment)
    assert (None if found is None else local(found, "Europe/Berlin")) == ends


def test_quiet_hours_of_some_days_begin_on_these() -> None:
    sunday = QuietHours(begins=dt.time(20, 0), ends=dt.time(10, 0), days=(6,))
    utc = ZoneInfo("UTC")
    monday = dt.datetime(2026, 3, 2, 9, tzinfo=UTC)
    assert quiet_until([sunday], utc, monday) == dt.datetime(2026, 3, 2, 10, tzinfo=UTC)
    assert quiet_until([sunday], utc, monday + dt.timedelta(days=1)) is None


def test_quiet_hours_that_follow_on_one_another_are_one() -> None:
    noon = QuietHours(begins=dt.time(7, 0), ends=dt.time(14, 0))
    utc = ZoneInfo("UTC")
    found = quiet_until([NIGHT, noon], utc, dt.datetime(2026, 3, 2, 23, tzinfo=UTC))
    assert found == dt.datetime(2026, 3, 3, 14, tzinfo=UTC)
    evening = QuietHours(begins=dt.time(14, 0), ends=dt.time(22, 0))
    assert quiet_until([NIGHT, noon, evening], utc, dt.datetime(2026, 3, 2, tzinfo=UTC)) is not None


@given(zones, moments, minutes, minutes)
def test_quiet_hours_end_and_are_over_then(
    zone: ZoneInfo, moment: dt.datetime, begins: dt.time, ends: dt.time
) -> None:
    if begins == ends:
        return
    quiet = [QuietHours(begins=begins, ends=ends)]
    over = quiet_until(quiet, zone, moment)
    if over is not None:
        assert over > moment
        assert over - moment < dt.timedelta(hours=25.1)
        assert quiet_until(quiet, zone, over) is None
