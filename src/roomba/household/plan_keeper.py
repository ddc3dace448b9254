"""The plans of one household, live: looks at the robot become steps of the scheduler."""

from __future__ import annotations

import contextlib
import datetime as dt
import threading
from collections.abc import Callable, Iterator
from typing import Final

from pydantic import ValidationError

from roomba.clean_request import CleanRequest
from roomba.client.household import PlansView, PlanView
from roomba.client.observed import ObservedRobot
from roomba.client.protocol import (
    CleanReport,
    RequestRefusedError,
    RobotUnavailableError,
)
from roomba.client.view import RobotView
from roomba.configuration.household import PlansConfig
from roomba.household.dirt_keeper import DirtKeeper
from roomba.household.folder import KeptValues
from roomba.household.plan_changes import Change
from roomba.household.rooms_follower import RoomsFollower
from roomba.household.situation import EndedErrands, situation_of
from roomba.plans.due import DAY, RoomNeed
from roomba.plans.memory import Memory, Note
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder
from roomba.plans.scheduler import Act, Deed, Scheduler, next_of
from roomba.plans.times import next_after, quiet_until
from roomba.vocabulary import CleanMode, listed

_SHORTEST: Final = 0.01
"""Days; the least time to a plan's next time that rooms' needs are reckoned with."""


class PlanKeeper:
    """Begins, pauses and breaks off cleans as the scheduler says; may be used from any thread."""

    def __init__(
        self,
        robot: ObservedRobot,
        *,
        plans: KeptValues,
        memory: KeptValues,
        config: PlansConfig,
        now: Callable[[], dt.datetime],
        zone: str,
        dirt: DirtKeeper,
        rooms: KeptValues,
    ) -> None:
        """Read what was kept; ``now`` is the wall clock, ``zone`` that of a new household."""
        self._robot, self._kept, self._kept_memory = robot, plans, memory
        self._config, self._now, self._dirt = config, now, dirt
        self._lock = threading.Lock()
        self._household = plans.read(HouseholdPlans(zone=zone))
        self._memory = self._written = memory.read(Memory())
        self._version, self._view_of_version = 0, PlansView()
        self._ended = EndedErrands()
        self._rooms = RoomsFollower(robot, rooms, dirt, self._on_disk, self._by_other_names)
        self._show()

    def view(self) -> PlansView:
        """Return the plans and what became of them, at once: it does not wait for a command."""
        return self._view_of_version

    def is_quiet(self) -> bool:
        """Whether it is in quiet hours now."""
        household = self._household
        return quiet_until(household.quiet, household.clock, self._now()) is not None

    def look(self, view: RobotView | None) -> None:
        """Take a step; ``view`` is None while the robot does not answer. Raises OSError.

        What goes wrong with the rooms' names or their dirt does not hold up the plans.
        """
        with self._lock:
            try:
                self._rooms.follow()
            finally:
                self._learn_and_step(view)

    def follow_rooms(self) -> None:
        """Let plans, presets and what is learned go by the rooms' names as they are now.

        Raises OSError; then it is tried again with the next look.
        """
        with self._lock:
            self._rooms.follow()

    def _learn_and_step(self, view: RobotView | None) -> None:
        """Learn of the rooms' dirt, which plans may go by, before a step; raises OSError."""
        now, ended = self._now(), self._ended.news(view)
        try:
            self._dirt.note(ended, now)
        finally:
            self._step(view, ended, now)

    def _step(self, view: RobotView | None, ended: CleanReport | None, now: dt.datetime) -> None:
        """Let the scheduler take a step, and the robot do what it asks for; raises OSError."""
        scheduler = Scheduler(self._household, self._config)
        situation = situation_of(view, ended, self._config.least_battery)
        self._memory, act = scheduler.step(self._memory, now, situation)
        if act is not None:
            self._memory = self._carried_out(scheduler, act, now)
        # A clean that ended may have told of dirt.
        self._keep_memory(is_changed=ended is not None)

    @contextlib.contextmanager
    def _by_other_names(self, change: Change, why: str) -> Iterator[None]:
        """Let plans go by other names of rooms, and show them after the block; raises OSError."""
        with contextlib.suppress(RequestRefusedError):  # for a name that no plan can have
            before, changed = self._write(change)
            for plan in changed.plans:
                if plan not in before.plans:
                    note = Note(at=self._now(), plan=plan.name, text=why)
                    self._memory = self._memory.noting(note)
        yield
        self._keep_memory(is_changed=True)

    def _carried_out(self, scheduler: Scheduler, act: Act, now: dt.datetime) -> Memory:
        """Let the robot do an act; return what is remembered then."""
        if act.deed is Deed.BEGIN and act.order is not None:
            return self._begun(scheduler, act.plan, act.order, now)
        deeds = {
            Deed.PAUSE: self._robot.pause,
            Deed.RESUME: self._robot.resume,
            Deed.DOCK: self._robot.dock,
        }
        try:
            deeds[act.deed]()
        except (RequestRefusedError, RobotUnavailableError) as refusal:
            text = f"the robot did not obey ({act.deed.value}): {refusal}"
            return self._memory.noting(Note(at=now, plan=act.plan, text=text))
        return self._memory

    def _begun(
        self, scheduler: Scheduler, plan: str, order: PlannedOrder, now: dt.datetime
    ) -> Memory:
        """Let the robot begin the clean of a plan; return what is remembered then."""
        try:
            wanted = self._order_now(plan, order, now)
            if wanted is None:
                return scheduler.not_due(self._memory, plan, now)
            unanswered = self._asked(wanted.request())
        except (RequestRefusedError, RobotUnavailableError) as refusal:
            return scheduler.refused(self._memory, plan, now, str(refusal))
        return scheduler.begun(self._memory, plan, now, unanswered)

    def _asked(self, request: CleanRequest) -> str:
        """Ask the robot for a clean; return why it may not have heard that, empty if it has."""
        try:
            self._robot.clean(request)
        except RobotUnavailableError as silence:
            return str(silence)
        return ""

    def _order_now(self, plan: str, order: PlannedOrder, now: dt.datetime) -> PlannedOrder | None:
        """Return what is to be cleaned of an order; None if nothing of it is due."""
        if not order.only_due:
            return order
        needs = self._needs(plan, order, now)
        if not needs:
            # Without rooms all floor is due.
            return order
        rooms = tuple(need.room for need in needs if need.is_due)
        mode = {"mode": CleanMode.ROOMS, "rooms": rooms}
        return order.model_copy(update=mode) if rooms else None

    def _needs(self, plan: str, order: PlannedOrder, now: dt.datetime) -> tuple[RoomNeed, ...]:
        """Return what the rooms of a plan need; raises RobotUnavailableError."""
        rooms = order.rooms or tuple(room.name for room in self._robot.home().rooms)
        following = self._memory.next_at.get(plan)
        period = 1.0 if following is None else (following - now).total_seconds() / DAY
        return self._dirt.needs(rooms, now, max(period, _SHORTEST))

    def _shown_needs(self) -> tuple[RoomNeed, ...]:
        """Return what rooms need, for the first plan that cleans only rooms that are due."""
        for plan in self._household.plans:
            if plan.order.only_due and plan.is_on:
                with contextlib.suppress(RobotUnavailableError):
                    return self._needs(plan.name, plan.order, self._now())
        return ()

    def require_day_to_come(self, plan: Plan) -> None:
        """Raise RequestRefusedError for a plan whose last day is over."""
        if next_after(plan, self._household.clock, self._now()) is None:
            raise RequestRefusedError(
                f"expected a plan with a day to come, got {plan.rule} from {plan.begins} on, whose "
                "last day is over; choose a later first day, or another rule"
            )

    def change(self, change: Change) -> None:
        """Change the plans; raises RequestRefusedError for what makes no sense, OSError.

        What another program changed in their file meanwhile stays.
        """
        with self._lock:
            before, changed = self._write(change)
            self._forget_changed(before, changed)
            scheduler = Scheduler(changed, self._config)
            self._memory = scheduler.keep_to_plans(self._memory, self._now())
            self._keep_memory(is_changed=True)

    def _write(self, change: Change) -> tuple[HouseholdPlans, HouseholdPlans]:
        """Change the plans on the disk; return how they were there, and how they are."""
        before = self._on_disk()
        try:
            changed = HouseholdPlans.model_validate(change(before).model_dump())
        except ValidationError as error:
            reason = error.errors()[0]["msg"].removeprefix("Value error, ")
            raise RequestRefusedError(reason) from error
        self._kept.write(changed)
        self._household = changed
        return before, changed

    def _on_disk(self) -> HouseholdPlans:
        return self._kept.read(self._household)

    def begin(self, preset: str) -> None:
        """Begin a preset now; raises RequestRefusedError, RobotUnavailableError."""
        for each in self._household.presets:
            if each.name == preset:
                self._robot.clean(each.order.request())
                return
        names = listed([each.name for each in self._household.presets])
        raise RequestRefusedError(f"expected a preset, one of {names}; got {preset[:80]!r}")

    def _forget_changed(self, before: HouseholdPlans, changed: HouseholdPlans) -> None:
        """Forget what was due by plans that were changed."""
        if before.zone != changed.zone:
            self._memory = self._memory.replanned()
        old = {plan.name: plan for plan in before.plans}
        for plan in changed.plans:
            if plan.name in old and plan != old[plan.name]:
                self._memory = self._memory.forgetting(plan.name)

    def _keep_memory(self, *, is_changed: bool = False) -> None:
        """Write and show the memory if it tells anything new; raises OSError."""
        # The time of the last look is new each second, and is not needed after a restart.
        told = self._memory.model_copy(update={"seen": self._written.seen})
        if told != self._written or is_changed:
            self._show()
            self._kept_memory.write(self._memory)
            self._written = self._memory

    def _show(self) -> None:
        self._version += 1
        memory, household = self._memory, self._household
        following = next_of(memory)
        self._view_of_version = PlansView(
            version=self._version,
            household=household,
            plans=tuple(self._plan_view(plan.name) for plan in household.plans),
            running="" if memory.running is None else memory.running.plan,
            is_held=memory.running is not None and memory.running.held is not None,
            next="" if following is None else following[0],
            next_at=None if following is None else following[1],
            notes=memory.notes,
            needs=self._shown_needs(),
        )

    def _plan_view(self, name: str) -> PlanView:
        waits = self._memory.waiting.get(name)
        return PlanView(
            name,
            self._memory.next_at.get(name),
            None if waits is None else waits.due,
            "" if waits is None else waits.reason,
        )
