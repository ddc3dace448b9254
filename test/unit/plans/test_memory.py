"""The scheduler's memory: times noted by a clock that was ahead delay nothing."""

from __future__ import annotations

import datetime as dt

from roomba.configuration.household import PlansConfig
from roomba.plans.memory import Memory, Running, Waiting
from roomba.plans.plan import HouseholdPlans, Plan
from roomba.plans.scheduler import Act, Deed, PlanEnd, Scheduler, Situation

NOW = dt.datetime(2026, 6, 1, 12, 0, tzinfo=dt.timezone.utc)
AHEAD = dt.datetime(2036, 1, 1, 9, 0, tzinfo=dt.timezone.utc)
HALF_AN_HOUR = dt.timedelta(minutes=30)
DAILY = HouseholdPlans(plans=(Plan(name="daily"),))


def test_no_moment_is_later_than_it_can_be() -> None:
    memory = Memory(
        waiting={"daily": Waiting(due=AHEAD, not_before=AHEAD)},
        running=Running(plan="other", due=AHEAD, began=AHEAD, rests_since=AHEAD),
    ).not_ahead(NOW, HALF_AN_HOUR)
    assert memory.waiting["daily"] == Waiting(due=NOW, not_before=NOW + HALF_AN_HOUR)
    assert memory.running == Running(plan="other", due=NOW, began=NOW, rests_since=NOW)
    later = NOW + HALF_AN_HOUR
    assert memory.not_ahead(later, HALF_AN_HOUR) == memory


def test_plans_begin_again_after_a_clock_that_was_ahead() -> None:
    scheduler = Scheduler(DAILY, PlansConfig())
    memory, _ = scheduler.step(Memory(), AHEAD - HALF_AN_HOUR, Situation())
    memory, _ = scheduler.step(memory, AHEAD, Situation())
    memory = scheduler.begun(memory, "daily", AHEAD)
    memory, _ = scheduler.step(memory, AHEAD, Situation())
    assert memory.running is not None
    assert memory.running.rests_since == AHEAD
    now, begun = NOW, []
    while now < NOW + dt.timedelta(days=3):
        memory, act = scheduler.step(memory, now, Situation())
        if act == Act(Deed.BEGIN, "daily", DAILY.plans[0].order):
            begun.append(now.day)
            memory = scheduler.begun(memory, "daily", now)
            memory, _ = scheduler.step(memory, now, Situation(ended=PlanEnd.DONE))
        now += dt.timedelta(minutes=1)
    # What was under way then is tried again, and then each day has its own.
    assert begun == [1, 2, 3, 4]


def test_a_plan_that_was_made_while_the_clock_was_ahead_begins_at_its_time() -> None:
    scheduler = Scheduler(DAILY, PlansConfig())
    memory = scheduler.keep_to_plans(Memory(), AHEAD)
    assert memory.seen is None
    memory = scheduler.keep_to_plans(memory, NOW)
    assert memory.next_at == {"daily": NOW.replace(day=2, hour=9)}
