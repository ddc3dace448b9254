"""Finding the way around a thing on a path: where to leave the path, and where to rejoin it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.mission import DrivingConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Point, RoundObstacle
from roomba.mission.driving.nudge import nudged
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.planning.path.planner import NoPathError, NoPathReason

Bools = NDArray[np.bool_]

_STEP: Final = 0.05
"""m; the rest of a path is looked at in such steps."""
_STRETCH: Final = 12
"""Steps ahead in which something stands that makes it leave the path."""
_FREE_RUN: Final = 3
"""Steps that must be free one after the other to join there."""
_MOST_TRIES: Final = 8
"""The most places to join that are tried."""


class Rejoin:
    """Plans from where the robot is to what is left of a path; ``trouble`` says why it cannot."""

    def __init__(self, context: PlanningContext, body_radius: float, config: DrivingConfig) -> None:
        """Take the context's planners, which must allow what paths keep from walls."""
        self._context, self._planner = context, context.paths
        self._body_radius, self._away = body_radius, config.thing_clearance
        self._out, self._most_nudge = config.out_of_pocket, config.most_nudge
        self.trouble = ""

    def way(
        self, senses: Senses, tracker: PathTracker, obstacles: Obstacles, trail: Trail
    ) -> tuple[Floats | None, float]:
        """Return the points, float64 [n, 2], m, from here on, or None if nothing can be reached.

        Also return for how many m they lead back. The robot may have come in by a gap that looks
        too narrow now: then it squeezes through, or drives back as it came.
        """
        here = (senses.pose.x, senses.pose.y)
        standing, at_least = obstacles.standing(senses.now), obstacles.at_least(senses.now)
        for things in (standing, at_least):
            points = self._around(here, tracker, things)
            if points is not None:
                return points, 0.0
        points = self._squeezed(senses, tracker, at_least)
        if points is not None:
            return points, 0.0
        return trail.back_and_on(lambda place: self._around(place, tracker, at_least))

    def way_home(self, senses: Senses, obstacles: Obstacles, trail: Trail) -> Floats:
        """Return the way to the place before the station, if need be close to what stands there.

        Raises NoPathError when there is none.
        """
        here = (senses.pose.x, senses.pose.y)
        staging = (self._context.staging.x, self._context.staging.y)
        try:
            return self._planner.plan(here, staging, obstacles.standing(senses.now)).points
        except NoPathError as error:
            at_least = obstacles.at_least(senses.now)
            with contextlib.suppress(NoPathError):
                return self._context.squeeze(here, staging, at_least)
            points, _ = trail.back_and_on(lambda place: self._way_to(place, staging, at_least))
            if points is None:
                raise error
            return points

    def way_out(self, senses: Senses, obstacles: Obstacles, trail: Trail) -> Floats | None:
        """Return the beginning of the way home, for a place that no path leads out of, or None."""
        try:
            points = self.way_home(senses, obstacles, trail)
        except NoPathError:
            return None
        stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
        end = [np.interp(self._out, stations, points[:, axis]) for axis in (0, 1)]
        first: Floats = np.concatenate((points[stations < self._out], [end]))
        return first

    def _way_to(self, here: Point, there: Point, things: Sequence[RoundObstacle]) -> Floats | None:
        try:
            return self._planner.plan(here, there, things).points
        except NoPathError:
            return None

    def nudged(self, senses: Senses, tracker: PathTracker, obstacles: Obstacles) -> Floats | None:
        """Return the rest of a path moved aside a little, or None if that does not help."""
        standing = obstacles.standing(senses.now)
        keep = self._body_radius + self._away
        return nudged(tracker, self._context.floor, standing, keep, self._most_nudge)

    def _around(
        self, here: Point, tracker: PathTracker, obstacles: Sequence[RoundObstacle]
    ) -> Floats | None:
        """Plan around round things, a little away from them."""
        samples, stations = _samples(tracker)
        kept_away = [(x, y, radius + self._away) for x, y, radius in obstacles]
        try:
            reachable = self._planner.reachable(here, kept_away)
        except NoPathError as error:
            self.trouble = error.reason.value
            return None
        free = self._free(samples, kept_away) & self._near_reachable(samples, reachable)
        runs = _runs(free, _FREE_RUN)
        self.trouble = NoPathReason.GOAL_UNREACHABLE.value
        tried, index = 0, _first(runs, _behind(free))
        while index is not None and tried < _MOST_TRIES:
            target = (float(samples[index, 0]), float(samples[index, 1]))
            try:
                path = self._planner.plan(here, target, kept_away)
            except NoPathError as error:
                self.trouble = error.reason.value
                tried += 1
                # Farther away each time, so that a place among many is found.
                index = _first(runs, index + 4 * tried)
                continue
            return np.concatenate((path.points, _rest(tracker, float(stations[index]))))
        return None

    def _squeezed(
        self, senses: Senses, tracker: PathTracker, obstacles: Sequence[RoundObstacle]
    ) -> Floats | None:
        """Plan on the fine grid to the next free place behind the thing, or to the path's end."""
        samples, stations = _samples(tracker)
        free = self._free(samples, obstacles)
        index = _first(_runs(free, _FREE_RUN), _behind(free))
        last = len(samples) - 1
        for number in {last if index is None else index: 0, last: 0}:
            target = (float(samples[number, 0]), float(samples[number, 1]))
            try:
                points = self._context.squeeze((senses.pose.x, senses.pose.y), target, obstacles)
            except NoPathError as error:
                self.trouble = error.reason.value
                continue
            return np.concatenate((points, _rest(tracker, float(stations[number]))))
        return None

    def _free(self, samples: Floats, obstacles: Sequence[RoundObstacle]) -> Bools:
        """Return which points keep away from what the map does not show."""
        free = np.ones(len(samples), np.bool_)
        for x, y, radius in obstacles:
            free &= np.hypot(samples[:, 0] - x, samples[:, 1] - y) >= radius + self._body_radius
        return free

    def _near_reachable(self, samples: Floats, reachable: Bools) -> Bools:
        """Return which points have a cell next to them that can be reached."""
        frame = self._planner.frame
        rows, columns = frame.cells_of(samples[:, 0], samples[:, 1])
        near = np.zeros(len(samples), np.bool_)
        for down in (-1, 0, 1):
            for right in (-1, 0, 1):
                row = np.clip(rows + down, 0, frame.rows - 1)
                column = np.clip(columns + right, 0, frame.columns - 1)
                near |= reachable[row, column]
        return near


def _samples(tracker: PathTracker) -> tuple[Floats, Floats]:
    """Return points along what is left of a path, and how far along it they are, m."""
    along, length = tracker.along, tracker.length
    count = max(1, math.ceil((length - along) / _STEP))
    stations = np.append(along + _STEP * np.arange(count), length)
    stations = np.minimum(stations, length)
    x = np.interp(stations, tracker.course.stations, tracker.course.points[:, 0])
    y = np.interp(stations, tracker.course.stations, tracker.course.points[:, 1])
    return np.column_stack((x, y)), stations


def _behind(free: Bools) -> int:
    """Return the first sample to join at: behind what blocks the path's first stretch, else 0."""
    blocked = np.flatnonzero(~free[:_STRETCH])
    return int(blocked[0]) if len(blocked) else 0


def _runs(free: Bools, run: int) -> Bools:
    """Return where ``run`` free ones follow each other, or all that are left to the end."""
    padded = np.concatenate((free, np.ones(run - 1, np.bool_)))
    together = padded[: len(free)].copy()
    for offset in range(1, run):
        together &= padded[offset : offset + len(free)]
    return together


def _first(mask: Bools, start: int) -> int | None:
    found = np.flatnonzero(mask[start:])
    return int(found[0]) + start if len(found) else None


def _rest(tracker: PathTracker, station: float) -> Floats:
    """Return the corners of a path beyond a station, and its end."""
    return tracker.course.points[tracker.course.stations > station]
