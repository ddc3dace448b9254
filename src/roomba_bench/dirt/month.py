"""A home over many days: dirt falls all day, and once a day the robot cleans what a plan says."""

from __future__ import annotations

import datetime as dt
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.clean_request import CleanRequest
from roomba.commands.trials.homes import rooms_of
from roomba.configuration.household import DueConfig
from roomba.files.shipped import HOMES
from roomba.headless.mission import HeadlessMission
from roomba.perception.rooms.rooms import Rooms
from roomba.plans.due import DirtRecords, learned, needs_of
from roomba.vocabulary import CleanMode, RoomDirt
from roomba.world.home.home import DirtSource
from roomba.world.layers.layer import load_home
from roomba_bench.ours_sim import ROBOT

Plan = Callable[[int, "Household"], tuple[str, ...]]
"""Returns the rooms to clean on a day, counted from 0; all rooms mean all floor."""

_BEGIN: Final = dt.datetime(2026, 1, 1, 9, 0, tzinfo=dt.timezone.utc)
_HOURS: Final = 24.0


@dataclass(frozen=True)
class Day:
    """The result of a day: way, m, time of cleaning, s, and the rooms that were cleaned.

    ``before`` and ``after`` are g/m2 of dirt in each room, before and after the day's clean.
    """

    rooms: tuple[str, ...]
    way: float
    seconds: float
    before: dict[str, float]
    after: dict[str, float]


@dataclass(frozen=True)
class Life:
    """Days of a household whose rooms have these ``areas``, m2."""

    areas: dict[str, float]
    days: tuple[Day, ...]

    @property
    def way(self) -> float:
        """The way of all days, m."""
        return sum(day.way for day in self.days)

    def times_cleaned(self, room: str) -> int:
        """Return on how many days a room was cleaned."""
        return sum(room in day.rooms for day in self.days)

    def dirtiest(self, first: int) -> float:
        """Return the dirt of the dirtiest room before a day's clean, g/m2.

        It is averaged over the days from the ``first`` on.
        """
        counted = self.days[first:]
        return sum(max(day.before.values()) for day in counted) / len(counted)

    def mean_dirt(self, first: int) -> float:
        """Return the mean over all floor and the time from a ``first`` day on, g/m2."""
        whole = sum(self.areas.values())
        nights = list(pairwise(self.days[first:]))
        total = sum(
            0.5 * (day.after[name] + following.before[name]) * area
            for day, following in nights
            for name, area in self.areas.items()
        )
        return total / whole / max(len(nights), 1)


class Household:
    """A robot that lives in a shipped home, simulated day by day."""

    def __init__(self, home: str, seed: int) -> None:
        """Put the robot on its station, and the home's dirt down."""
        self.home = load_home(home, HOMES, ROBOT.body)
        self.rooms: Rooms = rooms_of(self.home)
        self.robot = HeadlessMission(self.home, ROBOT, seed=seed, rooms=self.rooms)
        self._floors = self._floor_of_rooms()
        self.records = DirtRecords()
        self.names = tuple(name for name in self.rooms.names if self._floors[name].any())
        self.areas = {
            name: float(np.count_nonzero(self._floors[name]))
            * self.robot.simulator.dirt.frame.resolution**2
            for name in self.names
        }

    def _floor_of_rooms(self) -> dict[str, Mask]:
        """Return the floor of each room that can be cleaned, over the cells of dirt."""
        context, frame = self.robot.context, self.robot.simulator.dirt.frame
        x, y = frame.centres()
        fine = context.frame
        rows = np.clip(((y - fine.origin_y) / fine.resolution).astype(int), 0, fine.rows - 1)
        columns = np.clip(((x - fine.origin_x) / fine.resolution).astype(int), 0, fine.columns - 1)
        coverable = context.coverable()
        return {
            name: (coverable & context.in_room(name))[np.ix_(rows, columns)]
            for name in self.rooms.names
        }

    def dirt(self) -> dict[str, float]:
        """Return how much dirt lies on the floor of each room, g/m2."""
        density = self.robot.simulator.dirt.density
        return {name: float(density[self._floors[name]].mean()) for name in self.names}

    def pass_day(self, number: int, plan: Plan) -> Day:
        """Simulate a day: clean what the plan says, and then let dirt fall until the next day."""
        before, rooms = self.dirt(), plan(number, self)
        way = seconds = 0.0
        if rooms:
            way, seconds = self._clean(number, rooms)
        after = self.dirt()
        for source in self.home.dirt_sources:
            self._fall(source, _HOURS - seconds / 3600.0)
        return Day(rooms, way, seconds, before, after)

    def _clean(self, number: int, rooms: tuple[str, ...]) -> tuple[float, float]:
        is_all = len(rooms) == len(self.names)
        request = CleanRequest() if is_all else CleanRequest(CleanMode.ROOMS, rooms=rooms)
        robot = self.robot
        robot.simulator.set_charge(1.0)
        robot.simulator.empty_bin()
        robot.look()
        robot.rows.clear()
        record = robot.clean(request)
        at = moment_of(number) + dt.timedelta(seconds=record.result.duration)
        self.learn(record.result.rooms, at)
        return record.distance, record.result.duration

    def learn(self, found: tuple[RoomDirt, ...], at: dt.datetime) -> None:
        """Learn how fast rooms become dirty, as a household does."""
        self.records = learned(self.records, found, at, DueConfig())

    def _fall(self, source: DirtSource, hours: float) -> None:
        self.robot.simulator.spill(source.x, source.y, source.radius, source.rate * hours)


def moment_of(number: int) -> dt.datetime:
    """Return the time of a day's plan."""
    return _BEGIN + dt.timedelta(days=number)


def all_rooms(number: int, household: Household) -> tuple[str, ...]:
    """Clean everything each day."""
    return household.names


def every_other_day(number: int, household: Household) -> tuple[str, ...]:
    """Clean everything every second day."""
    return household.names if number % 2 == 0 else ()


def what_is_due(number: int, household: Household) -> tuple[str, ...]:
    """Clean the rooms that are due by their dirt."""
    needs = needs_of(household.records, household.names, moment_of(number), 1.0, DueConfig())
    return tuple(need.room for need in needs if need.is_due)


PLANS: Final[dict[str, Plan]] = {
    "due": what_is_due,
    "all rooms daily": all_rooms,
    "all rooms every other day": every_other_day,
}


def live(home: str, seed: int, days: int, plan: str) -> Life:
    """Return a life of so many days by a plan of :data:`PLANS`."""
    household = Household(home, seed)
    passed = tuple(household.pass_day(number, PLANS[plan]) for number in range(days))
    return Life(household.areas, passed)
