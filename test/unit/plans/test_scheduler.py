"""The scheduler, step by step with a made-up clock: begins, waits, pauses, tries again."""

from __future__ import annotations

import datetime as dt
from dataclasses import replace
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.household import PlansConfig
from roomba.plans.memory import Memory
from roomba.plans.plan import HouseholdPlans, Plan, QuietHours
from roomba.plans.scheduler import (
    PERSON_HOME,
    Act,
    Deed,
    PlanEnd,
    Scheduler,
    Situation,
    next_of,
)

CONFIG = PlansConfig()
BERLIN = ZoneInfo("Europe/Berlin")
READY = Situation()
WORKING = Situation(unfit="the robot is busy", is_working=True)
PAUSED = Situation(unfit="the robot is busy", is_working=True, is_paused=True)
NIGHT = QuietHours(begins=dt.time(22, 0), ends=dt.time(7, 0))


def plan(name: str = "all", *at: str, rule: str = "FREQ=DAILY") -> Plan:
    times = tuple(dt.time.fromisoformat(time) for time in at or ("09:00",))
    return Plan(name=name, rule=rule, at=times)


class Days:
    """A household whose time is set by hand; robot and person do what a test says."""

    def __init__(self, *plans: Plan, quiet: tuple[QuietHours, ...] = ()) -> None:
        self.household = HouseholdPlans(zone="Europe/Berlin", plans=plans, quiet=quiet)
        self.memory = Memory()
        self.now = dt.datetime(2026, 3, 2, 6, 0, tzinfo=BERLIN)
        self.step()

    def step(self, situation: Situation = READY) -> Act | None:
        """Take a step now; a clean that shall begin begins."""
        scheduler = Scheduler(self.household, CONFIG)
        self.memory, act = scheduler.step(self.memory, self.now, situation)
        if act is not None and act.deed is Deed.BEGIN:
            self.memory = scheduler.begun(self.memory, act.plan, self.now)
        return act

    def at(self, time: str, situation: Situation = READY) -> Act | None:
        """Take a step at a time of this day, or of another one (``03-04 09:00``)."""
        day, _, clock = time.rpartition(" ")
        date = f"2026-{day}" if day else self.now.date().isoformat()
        self.now = dt.datetime.fromisoformat(f"{date} {clock}").replace(tzinfo=BERLIN)
        return self.step(situation)

    def person(self, *, is_home: bool) -> None:
        self.household = self.household.model_copy(update={"is_person_home": is_home})

    @property
    def notes(self) -> list[str]:
        return [note.text for note in self.memory.notes]


def begins(act: Act | None) -> str:
    assert act is not None
    assert act.deed is Deed.BEGIN
    return act.plan


def test_a_clean_begins_at_its_time_once() -> None:
    days = Days(plan())
    assert days.at("08:59") is None
    act = days.at("09:00")
    assert begins(act) == "all"
    assert act is not None
    assert act.order == days.household.plans[0].order
    assert days.at("09:01", WORKING) is None
    assert days.at("10:00", Situation(ended=PlanEnd.DONE, message="12.0 of 12.0 m²")) is None
    assert days.at("10:01") is None
    assert days.notes == ["began", "done: 12.0 of 12.0 m²"]
    following = next_of(days.memory)
    assert following is not None
    assert following[1].astimezone(BERLIN).isoformat() == "2026-03-03T09:00:00+01:00"


NEVER_SET = dt.datetime(1970, 1, 1, 0, 0, 20, tzinfo=dt.timezone.utc)


def test_a_clock_that_was_not_set_for_a_while_changes_nothing() -> None:
    days = Days(plan(), plan("later", "20:30"))
    assert begins(days.at("09:00")) == "all"
    assert days.at("09:40", Situation(ended=PlanEnd.DONE)) is None
    before = days.memory
    days.now = NEVER_SET
    assert days.step() is None
    assert Scheduler(days.household, CONFIG).keep_to_plans(before, NEVER_SET) == before
    assert days.at("03-02 20:00") is None
    assert days.memory.since == before.since
    assert begins(days.at("20:30")) == "later"
    days.now = NEVER_SET
    assert days.step(Situation(ended=PlanEnd.DONE)) is None
    assert days.memory.running is None, "its end is told once"


def test_quiet_hours_delay_it() -> None:
    days = Days(plan("night", "23:00"), quiet=(NIGHT,))
    assert days.at("23:00") is None
    assert days.memory.waiting["night"].reason == "quiet hours until 07:00"
    assert days.at("03-03 06:59") is None
    assert begins(days.at("03-03 07:00")) == "night"
    assert days.notes[0] == "waits: quiet hours until 07:00"
    assert days.notes[-1].startswith("began; it was due")
    assert len(days.notes) == 2


def test_what_was_missed_while_the_program_was_off_is_tried_next_time() -> None:
    days = Days(plan())
    assert begins(days.at("03-05 18:00")) == "all"
    assert days.notes[0] == "missed: the robot's program did not run then"
    assert days.at("03-05 19:00", Situation(ended=PlanEnd.DONE)) is None
    assert days.at("03-05 19:01") is None, "of three missed days one is made up for"


def test_an_empty_battery_is_waited_for() -> None:
    days = Days(plan())
    low = Situation(unfit="the battery is below 30 %")
    assert days.at("09:00", low) is None
    assert days.at("09:30", low) is None
    assert days.notes == ["waits: the battery is below 30 %"]
    assert begins(days.at("10:00")) == "all"


def test_a_clean_that_fails_is_tried_three_times() -> None:
    days = Days(plan())
    days.at("09:00")
    stuck = Situation(ended=PlanEnd.FAILED, message="the robot is stuck")
    for failed, too_early, again in (("09:10", "09:39", "09:40"), ("09:50", "10:19", "10:20")):
        assert days.at(failed, stuck) is None
        assert days.at(too_early) is None
        assert begins(days.at(again)) == "all"
    assert days.at("10:30", stuck) is None
    assert days.at("12:00") is None
    assert days.notes[-1] == "given up: the robot is stuck"
    assert begins(days.at("03-03 09:00")) == "all"


def test_what_a_person_stopped_is_not_tried_again() -> None:
    days = Days(plan())
    days.at("09:00")
    assert days.at("09:10", Situation(ended=PlanEnd.STOPPED)) is None
    assert days.at("12:00") is None
    assert days.notes[-1] == "stopped by hand"


def test_a_robot_that_was_switched_off_during_its_clean_tries_again() -> None:
    days = Days(plan())
    days.at("09:00")
    days.at("09:10", WORKING)
    assert days.at("09:11", Situation(unfit="the robot does not answer")) is None
    assert days.at("09:13") is None
    assert "switched off" in days.notes[-1]
    assert begins(days.at("09:43")) == "all"


def test_a_robot_that_stands_for_moments_is_not_taken_for_switched_off() -> None:
    days = Days(plan())
    days.at("09:00")
    for minute in range(1, 10):
        assert days.at(f"09:0{minute}") is None
        assert days.at(f"09:0{minute}:30", WORKING) is None
    assert days.memory.running is not None


def test_a_person_at_home_is_waited_for_and_paused_for() -> None:
    days = Days(plan())
    days.person(is_home=True)
    assert days.at("09:00") is None
    assert days.memory.waiting["all"].reason == PERSON_HOME
    days.person(is_home=False)
    assert begins(days.at("09:30")) == "all"
    days.person(is_home=True)
    assert days.at("09:40", WORKING) == Act(Deed.PAUSE, "all")
    assert days.at("09:45", PAUSED) is None
    days.person(is_home=False)
    assert days.at("09:50", PAUSED) == Act(Deed.RESUME, "all")
    assert days.at("09:51", WORKING) is None


def test_a_long_pause_ends_on_the_station() -> None:
    days = Days(plan())
    days.at("09:00")
    days.person(is_home=True)
    days.at("09:10", WORKING)
    assert days.at("09:39", PAUSED) is None
    assert days.at("09:40", PAUSED) == Act(Deed.DOCK, "all")
    assert days.at("09:50") is None
    days.person(is_home=False)
    assert begins(days.at("11:00")) == "all"


def test_a_person_who_lets_it_go_on_is_obeyed() -> None:
    days = Days(plan())
    days.at("09:00")
    days.person(is_home=True)
    days.at("09:10", WORKING)
    days.at("09:11", PAUSED)
    assert days.at("09:12", WORKING) is None
    assert days.at("09:20", PAUSED) is None, "paused again, by hand"
    assert days.at("09:50", PAUSED) is None, "and not sent home for the person"


def test_a_clean_during_which_the_emergency_stop_was_pressed_is_left_to_people() -> None:
    days = Days(plan(), quiet=(NIGHT,))
    days.at("09:00")
    days.person(is_home=True)
    assert days.at("09:10", WORKING) == Act(Deed.PAUSE, "all")
    held = replace(WORKING, unfit="the emergency stop holds the drive", is_held=True)
    assert days.at("09:11", held) is None
    assert days.at("09:12", held) is None
    days.person(is_home=False)
    assert days.at("09:20", PAUSED) is None, "released, it does not go on by itself"
    assert days.at("22:00", PAUSED) is None
    assert days.notes[-1] == "left to you: the emergency stop was pressed"
    assert days.at("22:10", Situation(ended=PlanEnd.DONE)) is None
    assert begins(days.at("03-03 09:00")) == "all"


@pytest.mark.parametrize("is_at_rest", [False, True])
def test_what_is_left_to_people_is_not_begun_again_if_it_ended_without_word(
    *, is_at_rest: bool
) -> None:
    days = Days(plan())
    days.at("09:00")
    days.at("09:10", WORKING)
    held = Situation(
        unfit="the emergency stop holds the drive", is_working=not is_at_rest, is_held=True
    )
    for minute in range(11, 20):
        assert days.at(f"09:{minute}", held) is None
    assert days.at("09:20") is None
    assert days.at("09:21") is None
    assert days.notes[1:] == [
        "left to you: the emergency stop was pressed",
        "ended: the robot was switched off meanwhile",
    ]
    assert days.at("09:52") is None
    assert days.at("12:00") is None
    assert begins(days.at("03-03 09:00")) == "all"


def test_what_is_left_to_people_is_not_tried_again_if_it_fails() -> None:
    stuck = Situation(ended=PlanEnd.FAILED, message="the robot is stuck")
    days = Days(plan())
    days.at("09:00")
    days.at("09:10", replace(WORKING, is_held=True))
    days.at("09:11", WORKING)
    assert days.at("09:20", stuck) is None
    assert days.notes[-1] == "ended: the robot is stuck"
    assert days.at("12:00") is None
    assert begins(days.at("03-03 09:00")) == "all"
    assert days.at("03-03 09:10", replace(stuck, is_held=True)) is None, "held as it ended"
    assert days.at("03-03 12:00") is None


def test_a_person_who_does_not_mind_is_not_waited_for() -> None:
    days = Days(plan())
    days.household = days.household.model_copy(update={"waits_for_empty_home": False})
    days.person(is_home=True)
    assert begins(days.at("09:00")) == "all"
    assert days.at("09:10", WORKING) is None


def test_quiet_hours_send_a_plans_clean_home() -> None:
    days = Days(plan("late", "21:30"), quiet=(NIGHT,))
    days.at("21:30")
    assert days.at("21:59", WORKING) is None
    assert days.at("22:00", WORKING) == Act(Deed.DOCK, "late")
    assert days.at("22:05", Situation(ended=PlanEnd.STOPPED)) is None
    assert begins(days.at("03-03 07:00")) == "late"


def test_a_clean_by_hand_is_left_alone() -> None:
    days = Days(plan(), quiet=(NIGHT,))
    days.person(is_home=True)
    assert days.at("23:00", WORKING) is None


def test_plans_at_the_same_time_come_one_after_the_other() -> None:
    days = Days(plan("b"), plan("a"))
    assert begins(days.at("09:00")) == "a"
    assert days.at("09:01", WORKING) is None
    assert begins(days.at("09:30", Situation(ended=PlanEnd.DONE))) == "b"


def test_the_next_time_takes_the_place_of_one_that_waits() -> None:
    days = Days(plan("all", "09:00", "12:00"))
    busy = Situation(unfit="the emergency stop holds the drive")
    days.at("09:00", busy)
    days.at("12:00", busy)
    assert "given up for the next time" in days.notes[1]
    assert days.notes[1].endswith("the emergency stop holds the drive")
    assert begins(days.at("12:30")) == "all"
    assert days.at("13:00", Situation(ended=PlanEnd.DONE)) is None
    assert days.at("13:01") is None


def test_a_new_plan_makes_up_for_nothing() -> None:
    days = Days()
    days.at("10:00")
    days.household = days.household.model_copy(update={"plans": (plan(),)})
    assert days.at("10:01") is None
    assert begins(days.at("03-03 09:00")) == "all"


def test_a_plan_that_is_off_or_gone_is_forgotten() -> None:
    days = Days(plan())
    days.at("09:00", Situation(unfit="the robot is busy"))
    off = days.household.plans[0].model_copy(update={"is_on": False})
    days.household = days.household.model_copy(update={"plans": (off,)})
    assert days.at("10:00") is None
    assert days.memory.waiting == {}
    assert next_of(days.memory) is None


def test_a_clock_that_was_years_ahead_ends_no_plan() -> None:
    days = Days(plan())
    days.now = dt.datetime(2031, 1, 1, 8, 0, tzinfo=BERLIN)
    days.step(Situation(unfit="the robot is busy"))
    assert days.at("03-03 08:00") is None
    assert begins(days.at("03-03 09:00")) == "all"


def test_a_refusal_is_told_and_tried_again() -> None:
    days = Days(plan())
    scheduler = Scheduler(days.household, CONFIG)
    days.now = days.now.replace(hour=9)
    memory, act = scheduler.step(days.memory, days.now, READY)
    assert begins(act) == "all"
    days.memory = scheduler.refused(memory, "all", days.now, "there is no room hall")
    assert days.notes == ["tried again 09:30: there is no room hall"]
    assert days.at("09:29") is None
    assert begins(days.at("09:30")) == "all"


@given(
    zone=st.sampled_from(
        ["Europe/Berlin", "America/New_York", "Australia/Lord_Howe", "Asia/Tokyo"]
    ),
    begin=st.datetimes(dt.datetime(2026, 1, 2), dt.datetime(2029, 1, 1)),
    minute=st.integers(0, 24 * 60 - 1),
    step=st.integers(1, 50),
)
def test_each_day_has_one_clean_whatever_the_clock_does(
    zone: str, begin: dt.datetime, minute: int, step: int
) -> None:
    at = (dt.datetime(2000, 1, 1) + dt.timedelta(minutes=minute)).time()
    daily = Plan(name="all", at=(at,), begins=dt.date(2025, 12, 1))
    scheduler = Scheduler(HouseholdPlans(zone=zone, plans=(daily,)), CONFIG)
    now = begin.replace(tzinfo=dt.timezone.utc)
    memory, cleans = Memory(), []
    days = 5
    for _ in range(days * 24 * 60 // step):
        memory, act = scheduler.step(memory, now, READY)
        if act is not None:
            cleans.append(now)
            memory = scheduler.begun(memory, act.plan, now)
            memory, _ = scheduler.step(memory, now, Situation(ended=PlanEnd.DONE))
        now += dt.timedelta(minutes=step)
    assert days - 1 <= len(cleans) <= days + 1
    local = [each.astimezone(ZoneInfo(zone)) for each in cleans]
    assert len({each.date() for each in local}) >= len(local) - 1


def test_what_it_remembers_survives_being_written() -> None:
    days = Days(plan(), plan("b", "10:00"))
    days.at("09:00")
    days.person(is_home=True)
    days.at("10:00", WORKING)
    again = Memory.model_validate(days.memory.model_dump(mode="json"))
    assert again == days.memory
    assert again.running is not None
    assert list(again.waiting) == ["b"]


def test_few_notes_are_kept() -> None:
    days = Days(plan())
    for number in range(100):
        days.at("09:00")
        days.step(Situation(ended=PlanEnd.DONE, message=str(number)))
        days.now += dt.timedelta(days=1)
    assert len(days.notes) == 60
    assert days.notes[-2:] == ["began", "done: 99"]
