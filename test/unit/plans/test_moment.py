"""Moments that are kept: what lies at an end of the calendar is refused."""

from __future__ import annotations

import datetime as dt
import zoneinfo

import pytest
from fixtures.households.kept_household import FIRST_AND_LAST
from pydantic import TypeAdapter, ValidationError

from roomba.plans.moment import Moment, is_set

MOMENTS: TypeAdapter[dt.datetime] = TypeAdapter(Moment)


@pytest.mark.parametrize("text", [*FIRST_AND_LAST, "9000-01-01T00:00:00Z", "1969-12-31T23:59:59Z"])
def test_a_moment_near_which_no_day_can_be_reckoned_is_refused(text: str) -> None:
    with pytest.raises(ValidationError, match=r"1970|9000"):
        MOMENTS.validate_python(text)


@pytest.mark.parametrize("text", ["1970-01-01T00:00:00Z", "8999-12-31T23:59:59Z"])
def test_each_other_one_has_days_before_and_after_in_any_zone(text: str) -> None:
    moment = MOMENTS.validate_python(text)
    for zone in ("Pacific/Kiritimati", "Pacific/Niue"):
        there = moment.astimezone(zoneinfo.ZoneInfo(zone))
        assert there - dt.timedelta(days=400) < moment < there + dt.timedelta(days=400)


@pytest.mark.parametrize(
    ("text", "can_be"), [("1970-01-01", False), ("2025-12-31", False), ("2026-01-01", True)]
)
def test_a_clock_that_tells_a_day_before_the_program_was_never_set(text: str, can_be: bool) -> None:
    assert is_set(dt.datetime.fromisoformat(text).replace(tzinfo=dt.timezone.utc)) is can_be
