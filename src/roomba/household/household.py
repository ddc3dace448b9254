"""A robot in its household: it is looked at once a second, by a thread of its own."""

from __future__ import annotations

import contextlib
import datetime as dt
import math
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from roomba.client.household import PlansView, TotalsView, UpkeepView
from roomba.client.observed import ObservedRobot
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.client.view import RobotView
from roomba.configuration.household import HouseholdConfig
from roomba.errors import RoombaError
from roomba.household.dirt_keeper import DirtKeeper
from roomba.household.emptying import is_to_be_emptied
from roomba.household.folder import KeptValues, Tell
from roomba.household.in_use import InUse
from roomba.household.local_zone import local_zone
from roomba.household.plan_changes import Change, added, removed, replaced
from roomba.household.plan_keeper import PlanKeeper
from roomba.household.room_names import require_rooms
from roomba.household.steps import NotDoneError, Steps
from roomba.household.upkeep_keeper import UpkeepKeeper
from roomba.plans.moment import is_set
from roomba.plans.plan import Emptying, Plan, PlannedOrder, Preset, QuietHours
from roomba.upkeep.parts import Part

_PERIOD: Final = 1.0
"""s of wall time between two looks."""
_END: Final = 10.0
"""s of wall time that the end waits for a look under way."""


class ClockNotSetError(NotDoneError):
    """The clock of this computer is not set: it tells a time before this program existed."""


class LiveHousehold:
    """The household of one robot; its methods may be called from any thread.

    What goes wrong in a look, with the disk or by a fault of the program, is told once for each
    reason. It holds up neither the other steps of that look nor the looks after it.
    """

    def __init__(
        self,
        robot: ObservedRobot,
        folder: Path,
        config: HouseholdConfig,
        bin_capacity: float,
        tell: Tell,
        totals: Callable[[], TotalsView] = TotalsView,
        *,
        now: Callable[[], dt.datetime] = lambda: dt.datetime.now(dt.timezone.utc),
        period: float = _PERIOD,
    ) -> None:
        """Read what was kept in ``folder``; the bin takes ``bin_capacity`` g.

        ``now`` is the wall clock, aware of its zone; ``period`` is s of wall time between looks.
        """
        self.robot, self._totals = robot, totals
        self._now, self._period = now, period
        self._steps = Steps(tell)
        self._is_full_told = False
        self._capacity, self._emptying, self._bag = bin_capacity, config.emptying, math.nan
        self._summed = TotalsView()
        self._view: RobotView | None = None
        kept = KeptValues(folder / "upkeep.json", tell)
        self._upkeep = UpkeepKeeper(robot, kept, config.upkeep, bin_capacity)
        zone = local_zone()
        self._plans = PlanKeeper(
            robot,
            plans=KeptValues(folder / "plans.json", tell),
            memory=KeptValues(folder / "agenda.json", tell),
            config=config.plans,
            now=now,
            zone=zone.name,
            dirt=DirtKeeper(KeptValues(folder / "dirt.json", tell), config.due),
            rooms=KeptValues(folder / "rooms.json", tell),
        )
        if zone.doubt and self.plans().household.zone == zone.name:
            tell(f"{zone.doubt}: plans go by the hours of {zone.name}; set the zone on the page")
        self._in_use = InUse(folder, tell)
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._live, name="household", daemon=True)

    def start(self) -> None:
        """Look from now on; if another program keeps this household already, that is told."""
        self._in_use.begin()
        self._thread.start()

    def stop(self) -> None:
        """Look no more, and write what is not written yet."""
        self._ends.set()
        if self._thread.is_alive():
            self._thread.join(_END)
        # A look that hangs holds the lock of the plans: to follow rooms would wait for it.
        rooms = () if self._thread.is_alive() else (self._plans.follow_rooms,)
        self._steps.take(*rooms, self._upkeep.end)
        self._in_use.end()

    def look(self) -> None:
        """Look at the robot once."""
        self._steps.take(
            self._in_use.look,
            self._sum_up,
            self._see,
            self._count_work,
            self._tell_full_bin,
            self._empty_at_station,
            self._require_clock,
            lambda: self._plans.look(self._view),
        )

    def upkeep(self) -> UpkeepView:
        """Return how the parts are, and the totals of the last look, at once."""
        nearly = self._bag >= self._emptying.nearly_full
        return UpkeepView(self._upkeep.states(), self._summed, self._bag, is_bag_due=nearly)

    def reset_part(self, part: Part) -> None:
        """Let a part count as new, clean or empty."""
        _kept(lambda: self._upkeep.reset(part))

    def plans(self) -> PlansView:
        """Return the plans, and what comes of them."""
        return self._plans.view()

    def put_plan(self, plan: Plan, *, is_new: bool = False) -> None:
        """Add a plan, or replace the one of the same name, unless it ``is_new``.

        A plan that is off may name any rooms, and its last day may be over.
        """
        if plan.is_on:
            self._require_rooms(plan.order)
            self._plans.require_day_to_come(plan)
        self._put("plans", plan, is_new=is_new)

    def remove_plan(self, name: str) -> None:
        """Remove a plan."""
        self._change(lambda plans: removed(plans, "plans", name))

    def put_preset(self, preset: Preset, *, is_new: bool = False) -> None:
        """Add a preset, or replace the one of the same name, unless it ``is_new``."""
        self._require_rooms(preset.order)
        self._put("presets", preset, is_new=is_new)

    def remove_preset(self, name: str) -> None:
        """Remove a preset."""
        self._change(lambda plans: removed(plans, "presets", name))

    def begin_preset(self, name: str) -> None:
        """Begin the clean of a preset now."""
        self._plans.begin(name)

    def set_quiet(self, quiet: Sequence[QuietHours]) -> None:
        """Replace all quiet hours."""
        self._change(lambda plans: plans.model_copy(update={"quiet": tuple(quiet)}))

    def set_emptying(self, when: Emptying) -> None:
        """Set when a station that can empties the bin."""
        self._change(lambda plans: plans.model_copy(update={"emptying": when}))

    def set_zone(self, zone: str) -> None:
        """Set the time zone."""
        self._change(lambda plans: plans.model_copy(update={"zone": zone}))

    def set_waits_for_empty_home(self, *, is_wanted: bool) -> None:
        """Set whether plans wait while a person is at home."""
        self._change(lambda plans: plans.model_copy(update={"waits_for_empty_home": is_wanted}))

    def set_person_home(self, *, is_home: bool) -> None:
        """Tell whether a person is at home; what is so already is not written again."""
        if self.plans().household.is_person_home == is_home:
            return
        self._change(lambda plans: plans.model_copy(update={"is_person_home": is_home}))

    def _live(self) -> None:
        while not self._ends.wait(self._period):
            self.look()

    def _sum_up(self) -> None:
        # The keeper of the history tells what is wrong with it.
        with contextlib.suppress(RoombaError):
            self._summed = self._totals()

    def _see(self) -> None:
        """Look at the robot; the view is None while it does not answer."""
        self._view = None
        with contextlib.suppress(RoombaError):
            self._view = self.robot.robot()

    def _count_work(self) -> None:
        if self._view is not None:
            self._upkeep.look(self._view)

    def _tell_full_bin(self) -> None:
        """Let the robot sound once when its bin is due; in quiet hours, only after them."""
        if self._view is None:
            return
        is_due = any(state.is_due for state in self._upkeep.states() if state.part is Part.BIN)
        if is_due and not self._is_full_told and not self._plans.is_quiet():
            with contextlib.suppress(RequestRefusedError, RobotUnavailableError):
                self.robot.locate()
            self._is_full_told = True
        self._is_full_told = self._is_full_told and is_due

    def _empty_at_station(self) -> None:
        """Let the station empty the bin, if it is time for that."""
        view = self._view
        if view is None:
            return
        self._bag = view.bag
        wanted = self.plans().household.emptying
        if is_to_be_emptied(
            view, wanted, self._capacity, self._emptying, is_quiet=self._plans.is_quiet()
        ):
            with contextlib.suppress(RequestRefusedError, RobotUnavailableError):
                self.robot.empty_at_station()

    def _require_clock(self) -> None:
        """Raise ClockNotSetError if the clock is not set, as then no plan can begin."""
        now = self._now()
        if not is_set(now):
            raise ClockNotSetError(
                f"expected a clock of this computer that is set, got {now:%Y-%m-%d}: plans wait "
                "until it is, by the network or by hand"
            )

    def _require_rooms(self, order: PlannedOrder) -> None:
        """Raise RequestRefusedError for rooms that the map does not have.

        Before that, plans follow the edits of rooms: two names may have changed places.
        """
        _kept(self._plans.follow_rooms)
        # While the robot does not answer, its rooms are not known.
        with contextlib.suppress(RobotUnavailableError):
            require_rooms(order, self.robot.home().rooms)

    def _put(self, kind: str, value: Plan | Preset, *, is_new: bool) -> None:
        if is_new:
            self._change(lambda plans: added(plans, kind, value))
        else:
            self._change(lambda plans: replaced(plans, kind, value.name, value))

    def _change(self, change: Change) -> None:
        _kept(lambda: self._plans.change(change))


def _kept(change: Callable[[], None]) -> None:
    """Make a change; raises RequestRefusedError when the disk refuses it."""
    try:
        change()
    except OSError as error:
        raise RequestRefusedError(f"it was not kept: {error}") from error
