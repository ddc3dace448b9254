"""What a look at the robot means for plans."""

from __future__ import annotations

import datetime as dt
import math
from dataclasses import replace

import pytest
from fixtures.households.written_robot import VIEW

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.configuration.household import PlansConfig
from roomba.household.situation import EndedErrands, situation_of
from roomba.plans.memory import Memory, Running
from roomba.plans.plan import HouseholdPlans, QuietHours
from roomba.plans.scheduler import Deed, PlanEnd, Scheduler, Situation

REPORT = CleanReport(ErrandOutcome.COMPLETED, "", 5.0, 6.0, 1.0, 30.0, 60.0, 1.0)
UNTOLD = replace(REPORT, covered=math.nan, wanted=math.nan)
DOCKED = replace(VIEW, vacuum=replace(VIEW.vacuum, state="docked", phase="docked"))


@pytest.mark.parametrize(
    ("report", "end", "message"),
    [
        (REPORT, PlanEnd.DONE, "5.0 of 6.0 m²"),
        (
            replace(REPORT, message="the hall is left"),
            PlanEnd.DONE,
            "5.0 of 6.0 m²; the hall is left",
        ),
        (UNTOLD, PlanEnd.DONE, ""),
        (replace(UNTOLD, message="by itself"), PlanEnd.DONE, "by itself"),
        (replace(REPORT, outcome=ErrandOutcome.NOT_DOCKED), PlanEnd.DONE, "5.0 of 6.0 m²"),
        (replace(REPORT, outcome=ErrandOutcome.STOPPED), PlanEnd.STOPPED, ""),
        (replace(REPORT, outcome=ErrandOutcome.STUCK), PlanEnd.FAILED, "stuck"),
    ],
)
def test_how_an_errand_ended_is_told_with_what_is_known(
    report: CleanReport, end: PlanEnd, message: str
) -> None:
    situation = situation_of(DOCKED, report, 0.3)
    assert (situation.ended, situation.message) == (end, message)


def test_an_end_is_news_once_and_that_of_another_program_never() -> None:
    errands, other = EndedErrands(), replace(DOCKED, last=REPORT)
    assert errands.news(None) is None
    assert errands.news(other) is None
    assert errands.news(None) is None
    assert errands.news(other) is None
    ended = replace(DOCKED, last=UNTOLD)
    assert errands.news(None) is None
    assert errands.news(ended) is UNTOLD
    assert errands.news(ended) is None


def test_why_it_cannot_begin() -> None:
    low = replace(DOCKED, vacuum=replace(DOCKED.vacuum, battery=0.2))
    assert situation_of(DOCKED, None, 0.3) == Situation()
    assert situation_of(None, None, 0.3).unfit == "the robot does not answer"
    assert situation_of(VIEW, None, 0.3) == Situation("the robot is busy", is_working=True)
    assert situation_of(low, None, 0.3).unfit == "the battery is below 30 %"
    assert situation_of(replace(low, held="the cat"), None, 0.3).is_held


@pytest.mark.parametrize("is_quiet", [False, True])
def test_a_plans_clean_that_is_done_is_neither_paused_nor_broken_off(*, is_quiet: bool) -> None:
    now = dt.datetime(2026, 3, 2, 22, 30, tzinfo=dt.timezone.utc)
    quiet = (QuietHours(begins=dt.time(22, 0), ends=dt.time(7, 0)),) if is_quiet else ()
    household = HouseholdPlans(zone="UTC", quiet=quiet, is_person_home=not is_quiet)
    memory = Memory(running=Running(plan="all", due=now, began=now))
    scheduler = Scheduler(household, PlansConfig())

    def deed(to_go: float) -> Deed | None:
        home = replace(VIEW.vacuum, state="returning", phase="returning", seconds_to_go=to_go)
        _, act = scheduler.step(memory, now, situation_of(replace(VIEW, vacuum=home), None, 0.3))
        return None if act is None else act.deed

    assert deed(60.0) is (Deed.DOCK if is_quiet else Deed.PAUSE)
    assert deed(0.0) is None
