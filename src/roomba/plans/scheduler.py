"""Decides when a plan begins, waits, pauses and is tried again: one step at a time.

It has no clock and asks no robot: each step is given the moment and the situation, and returns what
it remembers and what is to be done.
"""

from __future__ import annotations

import datetime as dt
import zoneinfo
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from typing import Final

from roomba.configuration.household import PlansConfig
from roomba.plans.memory import Memory, Note, Running, Waiting
from roomba.plans.moment import is_set
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder
from roomba.plans.times import UTC, last_until, next_after, quiet_until

_DAY: Final = dt.timedelta(days=1)
_OVERRULED_AFTER: Final = dt.timedelta(seconds=30)
"""A robot that works so long after it was told to pause was told to go on by a person."""
_ENDED_WITHOUT_WORD: Final = dt.timedelta(seconds=60)
"""A robot that stands so long without telling how its clean ended was switched off meanwhile."""
PERSON_HOME: Final = "a person is at home"


class PlanEnd(Enum):
    """How a clean that a plan began ended."""

    DONE = "done"
    """Also if the robot then did not find its station."""
    STOPPED = "stopped"
    """By a person, who does not want it tried again."""
    FAILED = "failed"
    """It is tried again."""


@dataclass(frozen=True, slots=True)
class Situation:
    """What the robot does now.

    ``unfit`` says why it cannot begin a clean, empty if it can. ``is_held``: the emergency stop
    holds it; ``is_done``: its floor is done, and it is on its way home. ``ended`` and ``message``
    tell of an errand that ended since the last step.
    """

    unfit: str = ""
    is_working: bool = False
    is_paused: bool = False
    is_held: bool = False
    is_done: bool = False
    ended: PlanEnd | None = None
    message: str = ""


class Deed(Enum):
    """What is to be done with the robot."""

    BEGIN = "begin"
    PAUSE = "pause"
    RESUME = "resume"
    DOCK = "dock"


@dataclass(frozen=True, slots=True)
class Act:
    """A deed for a plan; ``order`` is what BEGIN begins."""

    deed: Deed
    plan: str
    order: PlannedOrder | None = None


@dataclass(frozen=True, slots=True)
class Scheduler:
    """The rules of one household."""

    household: HouseholdPlans
    config: PlansConfig

    def step(
        self, memory: Memory, now: dt.datetime, situation: Situation
    ) -> tuple[Memory, Act | None]:
        """Return what is remembered after a moment (aware of its zone), and what is to be done.

        After a BEGIN the caller is to call :meth:`begun`, :meth:`refused` or :meth:`not_due`. While
        the clock is not set nothing is to be done.
        """
        if not is_set(now):
            return self._follow_end(memory, now, situation), None
        memory = self.keep_to_plans(memory, now)
        memory = memory.not_ahead(now, self._seconds(self.config.retry_after))
        memory = self._note_due(memory, now)
        memory, act = self._follow_running(memory, now, situation)
        if act is None and memory.running is None:
            memory, act = self._choose(memory, now, situation)
        return memory.model_copy(update={"seen": now}), act

    def begun(self, memory: Memory, plan: str, now: dt.datetime, unanswered: str = "") -> Memory:
        """Return what is remembered once the robot began the clean of a plan.

        ``unanswered`` is why it is not known whether the robot began. It did if it is then seen to
        work, and it did not if it stays at rest.
        """
        waits = memory.waiting[plan]
        running = Running(
            plan=plan, due=waits.due, began=now, tries=waits.tries, unanswered=unanswered
        )
        memory = _running(memory.without_waiting(plan), running)
        return memory if unanswered else self._noting_begin(memory, running)

    def refused(self, memory: Memory, plan: str, now: dt.datetime, reason: str) -> Memory:
        """Return what is remembered once the robot refused the clean of a plan."""
        waits = memory.waiting[plan]
        return self._again(memory.without_waiting(plan), plan, waits.due, waits.tries, now, reason)

    def not_due(self, memory: Memory, plan: str, now: dt.datetime) -> Memory:
        """Return what is remembered once no room of a plan was due by its dirt."""
        told = Note(at=now, plan=plan, text="no room is due by its dirt")
        return memory.without_waiting(plan).noting(told)

    def keep_to_plans(self, memory: Memory, now: dt.datetime) -> Memory:
        """Return the memory without plans that are gone, and with plans that are new.

        A plan with other days or times than before counts as new, also where its file was edited by
        hand. While the clock is not set, the memory stays as it is.
        """
        if not is_set(now):
            return memory
        # A clock that is set back by less than a day must not let anything be cleaned twice.
        is_back = any(at - now > _DAY for at in (memory.seen or now, *memory.since.values()))
        times = {plan.name: self._times_of(plan) for plan in self.household.plans if plan.is_on}
        before = {**times, **memory.reckoned}
        for name in set(memory.since) | set(memory.waiting):
            if is_back or name not in times or times[name] != before[name]:
                memory = memory.forgetting(name)
        memory = memory.model_copy(update={"reckoned": times})
        new = {name: now for name in times if name not in memory.since}
        if not new:
            return memory
        memory = memory.model_copy(update={"since": {**memory.since, **new}})
        nexts = {plan.name: next_after(plan, self._zone, now) for plan in self._plans(new)}
        known = {name: at for name, at in nexts.items() if at is not None}
        return memory.model_copy(update={"next_at": {**memory.next_at, **known}})

    def _note_due(self, memory: Memory, now: dt.datetime) -> Memory:
        """Let the newest time of each plan that has come wait, in place of older ones."""
        for plan in self._plans(memory.next_at):
            if now < memory.next_at[plan.name]:
                continue
            due = last_until(plan, self._zone, memory.since[plan.name], now)
            memory = self._dealt_with(memory, plan, now)
            if due is not None:
                memory = self._wait(memory, plan.name, due, now)
        return memory

    def _dealt_with(self, memory: Memory, plan: Plan, now: dt.datetime) -> Memory:
        nexts = {name: at for name, at in memory.next_at.items() if name != plan.name}
        following = next_after(plan, self._zone, now)
        if following is not None:
            nexts[plan.name] = following
        since = {**memory.since, plan.name: now}
        return memory.model_copy(update={"since": since, "next_at": nexts})

    def _wait(self, memory: Memory, plan: str, due: dt.datetime, now: dt.datetime) -> Memory:
        before = memory.waiting.get(plan)
        if before is not None:
            told = f"given up for the next time: it was due {self._clock(before.due, now)}"
            why = f", but {before.reason}" if before.reason else ""
            memory = memory.noting(Note(at=now, plan=plan, text=told + why))
        was_off = now - due > self._seconds(self.config.on_time)
        reason = "the robot's program did not run then" if was_off else ""
        if was_off:
            memory = memory.noting(Note(at=now, plan=plan, text=f"missed: {reason}"))
        return memory.with_waiting(plan, Waiting(due=due, not_before=now, reason=reason))

    def _follow_running(
        self, memory: Memory, now: dt.datetime, situation: Situation
    ) -> tuple[Memory, Act | None]:
        running = memory.running
        if running is None:
            return memory, None
        if situation.is_held and situation.ended in (None, PlanEnd.FAILED):
            memory, running = self._left_to_people(memory, running, now)
        if situation.ended is not None:
            return self._finish(memory, running, now, situation), None
        is_under_way = situation.is_working or situation.is_paused
        if is_under_way and running.unanswered:
            memory = self._noting_begin(memory, running)
            running = running.model_copy(update={"unanswered": ""})
        if is_under_way or situation.is_held:
            lasts = running.model_copy(update={"rests_since": None})
            return self._hold(_running(memory, lasts), lasts, now, situation)
        since = running.rests_since or now
        if now - since >= _ENDED_WITHOUT_WORD:
            why = running.unanswered or "the robot was switched off meanwhile"
            off = Situation(ended=PlanEnd.FAILED, message=why)
            return self._finish(memory, running, now, off), None
        return _running(memory, running.model_copy(update={"rests_since": since})), None

    def _noting_begin(self, memory: Memory, running: Running) -> Memory:
        late = running.began - running.due > self._seconds(self.config.on_time)
        due = f"; it was due {self._clock(running.due, running.began)}" if late else ""
        return memory.noting(Note(at=running.began, plan=running.plan, text=f"began{due}"))

    def _follow_end(self, memory: Memory, now: dt.datetime, situation: Situation) -> Memory:
        """Finish what runs if it ended."""
        if memory.running is None or situation.ended is None:
            return memory
        return self._finish(memory, memory.running, now, situation)

    def _finish(
        self, memory: Memory, running: Running, now: dt.datetime, situation: Situation
    ) -> Memory:
        memory = memory.model_copy(update={"running": None})
        if situation.ended is PlanEnd.FAILED:
            reason = situation.message or "it did not get to its end"
            if running.is_left_to_people:
                return memory.noting(Note(at=now, plan=running.plan, text=f"ended: {reason}"))
            return self._again(memory, running.plan, running.due, running.tries, now, reason)
        said = "stopped by hand" if situation.ended is PlanEnd.STOPPED else "done"
        text = f"{said}: {situation.message}" if situation.message else said
        return memory.noting(Note(at=now, plan=running.plan, text=text))

    def _again(
        self,
        memory: Memory,
        plan: str,
        due: dt.datetime,
        tries: int,
        now: dt.datetime,
        reason: str,
    ) -> Memory:
        """Let a time of a plan be tried again later, unless that was the last try."""
        newer = memory.waiting.get(plan)
        is_last = tries + 1 >= self.config.most_tries
        if is_last or newer is not None:
            text = f"given up: {reason}" if is_last else f"given up for the next time: {reason}"
            return memory.noting(Note(at=now, plan=plan, text=text))
        later = now + self._seconds(self.config.retry_after)
        memory = memory.noting(
            Note(at=now, plan=plan, text=f"tried again {self._clock(later, now)}: {reason}")
        )
        waits = Waiting(due=due, not_before=later, tries=tries + 1, reason=reason)
        return memory.with_waiting(plan, waits)

    def _hold(
        self, memory: Memory, running: Running, now: dt.datetime, situation: Situation
    ) -> tuple[Memory, Act | None]:
        """Send the robot home in quiet hours, and pause it while a person is at home.

        Once a person pressed the emergency stop the clean is left to people. One that is done goes
        home all the same.
        """
        if running.is_left_to_people or situation.is_done:
            return memory, None
        quiet = self._quiet(now)
        if quiet and not running.is_overruled:
            return self._home(memory, running, now, quiet)
        if running.held is None:
            if self._person() and not running.is_overruled and not situation.is_paused:
                held = running.model_copy(update={"held": now})
                memory = memory.noting(
                    Note(at=now, plan=running.plan, text=f"paused: {self._person()}")
                )
                return _running(memory, held), Act(Deed.PAUSE, running.plan)
            return memory, None
        if not situation.is_paused:
            if now - running.held < _OVERRULED_AFTER:
                return memory, None  # it may not have heard yet
            overruled = running.model_copy(update={"held": None, "is_overruled": True})
            return _running(memory, overruled), None
        if not self._person():
            free = running.model_copy(update={"held": None})
            return _running(memory, free), Act(Deed.RESUME, running.plan)
        if now - running.held >= self._seconds(self.config.longest_pause):
            return self._home(memory, running, now, self._person())
        return memory, None

    @staticmethod
    def _left_to_people(
        memory: Memory, running: Running, now: dt.datetime
    ) -> tuple[Memory, Running]:
        """Return what is remembered of a clean during which the emergency stop was pressed."""
        if running.is_left_to_people:
            return memory, running
        theirs = running.model_copy(update={"held": None, "is_left_to_people": True})
        told = Note(at=now, plan=running.plan, text="left to you: the emergency stop was pressed")
        return _running(memory.noting(told), theirs), theirs

    def _home(
        self, memory: Memory, running: Running, now: dt.datetime, reason: str
    ) -> tuple[Memory, Act]:
        """Break a clean off: the robot goes to its station, and begins again when it may."""
        memory = memory.model_copy(update={"running": None})
        memory = memory.noting(Note(at=now, plan=running.plan, text=f"broken off: {reason}"))
        if running.plan not in memory.waiting:
            waits = Waiting(due=running.due, not_before=now, tries=running.tries, reason=reason)
            memory = memory.with_waiting(running.plan, waits)
        return memory, Act(Deed.DOCK, running.plan)

    def _choose(
        self, memory: Memory, now: dt.datetime, situation: Situation
    ) -> tuple[Memory, Act | None]:
        """Begin with what waits longest, or say why nothing begins."""
        plans = {plan.name: plan for plan in self.household.plans}
        ready = [
            (waits.due, name)
            for name, waits in memory.waiting.items()
            if now >= waits.not_before and name in plans
        ]
        if not ready:
            return memory, None
        reason = self._quiet(now) or self._person() or situation.unfit
        if not reason:
            _, name = min(ready)
            return memory, Act(Deed.BEGIN, name, plans[name].order)
        for _, name in sorted(ready):
            waits = memory.waiting[name]
            if waits.reason != reason:
                memory = memory.noting(Note(at=now, plan=name, text=f"waits: {reason}"))
                told = waits.model_copy(update={"reason": reason})
                memory = memory.with_waiting(name, told)
        return memory, None

    def _times_of(self, plan: Plan) -> str:
        """Return the days and times of a plan as a text, which differs where they differ."""
        times = " ".join(f"{time:%H:%M}" for time in plan.at)
        return f"{plan.rule} from {plan.begins} at {times} {self.household.zone}"

    @property
    def _zone(self) -> zoneinfo.ZoneInfo:
        return self.household.clock

    def _plans(self, names: Collection[str]) -> list[Plan]:
        return [plan for plan in self.household.plans if plan.is_on and plan.name in names]

    def _person(self) -> str:
        """Why no clean is wanted because of a person; empty if there is no such reason."""
        waits = self.household.waits_for_empty_home and self.household.is_person_home
        return PERSON_HOME if waits else ""

    def _quiet(self, now: dt.datetime) -> str:
        """Until when quiet hours last, in words; empty outside of them."""
        ends = quiet_until(self.household.quiet, self._zone, now)
        return "" if ends is None else f"quiet hours until {self._clock(ends, now)}"

    def _clock(self, moment: dt.datetime, now: dt.datetime) -> str:
        """Return a moment as a person reads it: with its day unless that is near."""
        at = moment.astimezone(self._zone)
        return f"{at:%H:%M}" if abs(moment - now) < _DAY else f"{at:%a %d %b %H:%M}"

    @staticmethod
    def _seconds(seconds: float) -> dt.timedelta:
        return dt.timedelta(seconds=seconds)


def _running(memory: Memory, running: Running) -> Memory:
    return memory.model_copy(update={"running": running})


def next_of(memory: Memory) -> tuple[str, dt.datetime] | None:
    """Return the plan that comes next, and when, in UTC; None if none does."""
    if not memory.next_at:
        return None
    name = min(memory.next_at, key=lambda each: (memory.next_at[each], each))
    return name, memory.next_at[name].astimezone(UTC)
