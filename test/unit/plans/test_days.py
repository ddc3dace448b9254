"""Days by rules of iCalendar; what is none is refused with a sentence."""

from __future__ import annotations

import datetime as dt
from itertools import islice

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.plans.days import days_from, require_days

MONDAY = dt.date(2026, 3, 2)
WEEKDAYS = ("MO", "TU", "WE", "TH", "FR", "SA", "SU")


def first(rule: str, count: int = 3, begins: dt.date = MONDAY) -> list[str]:
    return [day.isoformat() for day in islice(days_from(rule, begins, begins), count)]


def test_days_of_common_rules() -> None:
    assert first("FREQ=DAILY;INTERVAL=2") == ["2026-03-02", "2026-03-04", "2026-03-06"]
    assert first("FREQ=WEEKLY;BYDAY=TU,SA") == ["2026-03-03", "2026-03-07", "2026-03-10"]
    assert first("freq=weekly;interval=2;byday=mo") == ["2026-03-02", "2026-03-16", "2026-03-30"]
    assert first("FREQ=MONTHLY;BYDAY=1SA") == ["2026-03-07", "2026-04-04", "2026-05-02"]
    assert first("FREQ=MONTHLY;BYMONTHDAY=-1") == ["2026-03-31", "2026-04-30", "2026-05-31"]
    assert first("FREQ=DAILY;COUNT=2") == ["2026-03-02", "2026-03-03"]
    assert first("FREQ=DAILY;UNTIL=20260302") == ["2026-03-02"]


def test_days_from_a_later_day_on_are_those_of_the_same_rule() -> None:
    days = days_from("FREQ=WEEKLY;INTERVAL=2;BYDAY=MO", MONDAY, dt.date(2026, 3, 10))
    assert next(days) == dt.date(2026, 3, 16)


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("", "such as FREQ=WEEKLY"),
        ("every day", "such as FREQ=WEEKLY"),
        ("FREQ=WEEKLY;BYDAY=;INTERVAL=2", "a day of the week at least, got none"),
        ("FREQ=HOURLY", "FREQ to be one of DAILY"),
        ("BYDAY=MO", "FREQ to be one of DAILY"),
        ("FREQ=DAILY;BYHOUR=9", "got BYHOUR"),
        ("FREQ=DAILY;BYMONTH=2;BYMONTHDAY=30", "got BYMONTH, BYMONTHDAY"),
        ("FREQ=WEEKLY;BYDAY=XX", "rule of iCalendar"),
        ("FREQ=WEEKLY;INTERVAL=x", "INTERVAL from 1"),
        ("FREQ=DAILY;INTERVAL=0", "INTERVAL from 1"),
        ("FREQ=WEEKLY;BYDAY=MO\nFREQ=DAILY", "expected one rule"),
        ("FREQ=YEARLY;BYMONTH=2;BYMONTHDAY=30", "which has none"),
        ("FREQ=DAILY;UNTIL=20200101", "which has none"),
    ],
)
def test_what_is_no_rule_is_refused(rule: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        require_days(rule, MONDAY)


def test_a_first_day_far_away_is_refused() -> None:
    with pytest.raises(ValueError, match="2000 to 2100, got 1026"):
        require_days("FREQ=DAILY", dt.date(1026, 1, 1))


@given(
    days=st.sets(st.sampled_from(WEEKDAYS), min_size=1),
    begins=st.dates(dt.date(2000, 1, 1), dt.date(2100, 12, 31)),
)
def test_a_weekly_rule_has_its_weekdays_and_no_others(days: set[str], begins: dt.date) -> None:
    found = set(islice(days_from(f"FREQ=WEEKLY;BYDAY={','.join(days)}", begins, begins), 20))
    span = [begins + dt.timedelta(days=offset) for offset in range((max(found) - begins).days + 1)]
    assert found == {day for day in span if WEEKDAYS[day.weekday()] in days}


NEARLY = st.from_regex(
    r"FREQ=(DAILY|WEEKLY)(;(INTERVAL|BYDAY|WKST|COUNT|UNTIL|[A-Z]{3,8})=[-0-9A-Z,+]{0,8}){0,3}"
)


@given(st.text(max_size=40) | NEARLY)
def test_any_text_is_taken_or_refused_by_a_sentence(rule: str) -> None:
    try:
        require_days(rule, MONDAY)
    except ValueError as refusal:
        sentence = str(refusal)
    else:
        sentence = "expected"
        assert next(days_from(rule, MONDAY, MONDAY)) >= MONDAY
    assert sentence.startswith("expected")
