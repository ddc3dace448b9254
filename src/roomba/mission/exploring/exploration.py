"""One exploration: which frontier to go to next, and when there is none left.

No clock and no I/O. The map grows while the robot drives. Each time that it did, the frontier that
the robot is on its way to is checked again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mission import ExploringConfig
from roomba.geometry import Point, Pose, RoundObstacle
from roomba.grid import FREE, OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.exploring.open_edges import GivenUp, open_edges
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.planning.frontiers.frontiers import Frontier, FrontierChoice, frontiers, is_frontier
from roomba.planning.path.planner import NoPathError
from roomba.vocabulary import OpenEdge

_MOST_TRIES: Final = 12
"""Frontiers to which a way is planned before the next tick has its turn."""


@dataclass(frozen=True, slots=True)
class ExploreResult:
    """How an exploration ended: the floor that is ``known``, m2, ``distance`` m, ``duration`` s.

    ``unseen`` are frontiers that were given up: no place from which they are seen can be reached.
    ``open_edges`` are the longer ones that the map still has, the longest first.
    """

    outcome: CleanOutcome
    message: str
    known: float
    distance: float
    duration: float
    unseen: tuple[Point, ...] = ()
    open_edges: tuple[OpenEdge, ...] = ()

    @property
    def is_completed(self) -> bool:
        """Whether the robot saw all that it could get to see, and docked: the map is whole."""
        return self.outcome is CleanOutcome.COMPLETED


class Exploration:
    """Chooses where to go; ``given_up`` are the frontiers that it gave up, by their places."""

    def __init__(self, config: ExploringConfig) -> None:
        """Begin with nothing given up."""
        self._config = config
        self._choice = FrontierChoice(
            least_unknown=config.least_unknown,
            away=config.same_frontier,
            look_from=config.look_from,
            nearer_worth=config.nearer_worth,
            small=config.small_frontier,
            small_cost=config.small_cost,
            least_cells=config.least_cells,
            stride=config.frontier_stride,
            tight_cost=config.tight_cost,
        )
        self.goal: Frontier | None = None
        self.given_up: dict[Point, GivenUp] = {}
        self.times_given_up = 0
        """Counts a frontier again that is given up anew, after it was looked at from nearer."""
        self._vanished: list[Point] = []
        self._sought: Point | None = None
        self._sought_for = 0.0
        self._looked_on: float | None = None
        self.is_as_near_as_it_gets = False
        """Whether the robot touched something by the viewpoint that it is on its way to."""
        self.times_stuck = 0
        self.times_shut_in = 0
        self.looked_again = False
        """Whether what stands in the way was looked for anew before the end."""

    def values(self) -> list[list[float]]:
        """Return what must be remembered to go on, as plain values."""
        return [
            [*each.place, each.seen_from, float(each.was_looked_at)]
            for each in self.given_up.values()
        ]

    @staticmethod
    def of(values: list[list[float]], config: ExploringConfig) -> Exploration:
        """Return an exploration that goes on; raises ValueError or TypeError for other values.

        Values of older programs do not tell whether, or from how far, a frontier was looked at.
        """
        exploration = Exploration(config)
        for x, y, *told in values:
            seen_from, was_looked_at = (*told, *(0.0, 0.0)[len(told) :])
            place = float(x), float(y)
            exploration.given_up[place] = GivenUp(place, float(seen_from), bool(was_looked_at))
        return exploration

    def move(self, moved: Pose) -> None:
        """Go on in another frame, in which this one lies at ``moved``."""
        given_up = (each.moved(moved) for each in self.given_up.values())
        self.given_up = {each.place: each for each in given_up}
        self._vanished = [moved.place_of(*point) for point in self._vanished]
        self.goal = self.goal and self.goal.moved(moved)

    def give_up(self, middle: Point, seen_from: float = 0.0) -> None:
        """Give up a frontier until it can be seen from nearer than ``seen_from`` m; 0: for good."""
        self.times_given_up += 1
        known = self.given_up.get(middle, GivenUp(middle, math.inf, was_looked_at=False))
        self.given_up[middle] = GivenUp(
            middle, min(seen_from, known.seen_from), known.was_looked_at or seen_from > 0.0
        )

    def give_up_all(self, here: Pose, context: PlanningContext) -> None:
        """Give up all frontiers of the known floor, also those that the robot cannot get to."""
        floor = context.known.values == FREE
        at = (here.x, here.y)
        left = frontiers(context.known, floor, floor, at, self.unseen, self._choice)
        for frontier in left:
            self.give_up(frontier.middle)

    @property
    def unseen(self) -> list[Point]:
        """The frontiers that it gave up, m, map frame."""
        return list(self.given_up)

    def next_path(
        self,
        here: Pose,
        context: PlanningContext,
        obstacles: list[RoundObstacle],
        farthest: float = math.inf,
    ) -> NDArray[np.float64] | None:
        """Return the way to the next viewpoint, float64 [n, 2], m; None if there is none.

        Viewpoints that are ``farthest`` m of way off and more are left out. A frontier to which no
        way leads is given up. When no viewpoint is left and ``farthest`` is infinite, the robot
        looks through gaps that only a clean passes, and then from nearer at longer frontiers that
        it looked at from afar.
        """
        self._leave_behind(here, context)
        at = (here.x, here.y)
        try:
            fits = context.paths.reachable(at, obstacles)
        except NoPathError:
            return None
        roomy = context.paths.roomy(obstacles)

        def plan(there: Point) -> NDArray[np.float64]:
            return context.paths.plan(at, there, obstacles).points

        found = frontiers(context.known, fits, roomy, at, self.unseen, self._choice)
        points = self._way_to_one_of(found, farthest, plan)
        if points is not None or not math.isinf(farthest):
            return points
        narrow = context.narrow_floor(at, obstacles)
        if (narrow.places & ~fits).any():
            found = frontiers(context.known, narrow.places, roomy, at, self.unseen, self._choice)
            points = self._way_to_one_of(
                found,
                farthest,
                lambda there: context.squeeze(at, narrow.place_near(there), obstacles),
            )
        if points is None:
            found = self._seen_from_nearer(context, fits, roomy, at)
            points = self._way_to_one_of(found, farthest, plan)
        return points

    def _seen_from_nearer(
        self, context: PlanningContext, fits: NDArray[np.bool_], roomy: NDArray[np.bool_], at: Point
    ) -> list[Frontier]:
        """Return long frontiers that were given up, but can be looked at from nearer by now.

        The map has grown there meanwhile, or shows now that the robot fits. A surface that is
        black, or met at a flat angle, is seen from near only.
        """
        nearest = self._config.look_nearer
        left_out = [each.place for each in self.given_up.values() if each.seen_from <= nearest]
        for _ in range(_MOST_TRIES):
            found = frontiers(context.known, fits, roomy, at, left_out, self._choice)
            large = [each for each in found if each.length >= self._config.small_frontier]
            nearer = [each for each in large if self._is_nearer(each)]
            if nearer or not large:
                return nearer
            left_out += [each.middle for each in large]
        return []

    def _is_nearer(self, frontier: Frontier) -> bool:
        """Whether the viewpoint is clearly nearer than those that this place was seen from."""
        distance = math.dist(frontier.viewpoint, frontier.middle) + self._config.look_nearer
        return all(
            distance < each.seen_from
            for each in self.given_up.values()
            if math.dist(each.place, frontier.middle) <= self._config.same_frontier
        )

    def _way_to_one_of(
        self,
        found: list[Frontier],
        farthest: float,
        plan: Callable[[Point], NDArray[np.float64]],
    ) -> NDArray[np.float64] | None:
        """Return the way to the viewpoint of the first frontier to which one leads, or None."""
        for frontier in [each for each in found if each.way < farthest][:_MOST_TRIES]:
            try:
                points = plan(frontier.viewpoint)
            except NoPathError:
                self.give_up(frontier.middle)
                continue
            self.goal = frontier
            return points
        return None

    def still_unseen(self, occupancy: OccupancyMap) -> tuple[Point, ...]:
        """Return the given-up frontiers that still are frontiers on ``occupancy``, a newer map."""
        return tuple(point for point in self.unseen if self._is_left(occupancy, point))

    def open_edges(self, occupancy: OccupancyMap) -> tuple[OpenEdge, ...]:
        """Return where this newer map still ends, the longest edge first."""
        return open_edges(occupancy, self.given_up.values(), self._config)

    def wants_another(self, occupancy: OccupancyMap) -> bool:
        """Whether nothing is left of the frontier that it is on its way to, as the map is now."""
        return self.goal is not None and not self._is_left(occupancy, self.goal.middle)

    @property
    def is_under_way(self) -> bool:
        """Whether the robot was last sent to a frontier."""
        return self.goal is not None

    def is_too_long(self, now: float) -> bool:
        """Whether it has been on its way to this frontier for much longer than the way takes.

        Ways that glass and mirrors show open and close, and lead nowhere. ``now`` is in s; ask at
        each tick of the way. Time between two ways, in which it may charge, does not count.
        """
        if self.goal is None:
            return False
        place = self.goal.middle
        if self._sought is None or math.dist(self._sought, place) > self._config.same_frontier:
            self._sought, self._sought_for = place, 0.0
        if self._looked_on is not None:
            self._sought_for += max(now - self._looked_on, 0.0)
        self._looked_on = now
        allowed = self._config.patience + 2.0 * self.goal.way / self._config.speed
        return self._sought_for > allowed

    def note_touch(self, here: Pose) -> None:
        """Note that the robot touched something; at its viewpoint it then comes no nearer.

        A cell at the rim of the map is free though a wall is in its last centimetres.
        """
        self.is_as_near_as_it_gets = self.is_as_near_as_it_gets or self._is_at_viewpoint(here)

    def _is_at_viewpoint(self, here: Pose) -> bool:
        if self.goal is None:
            return False
        off = math.dist(self.goal.viewpoint, (here.x, here.y))
        return off <= self._config.viewpoint_tolerance

    def cut_off(self, *, is_stuck: bool = False) -> None:
        """Give up the frontier that the robot was on its way to: no way leads there."""
        self.times_stuck += is_stuck
        if self.goal is not None:
            self.give_up(self.goal.middle)
        self.goal, self.is_as_near_as_it_gets = None, False

    def _leave_behind(self, here: Pose, context: PlanningContext) -> None:
        """Give the last frontier up if it was looked at from its viewpoint, and is still one.

        It is also given up if frontiers at the same place vanished often before: what is seen
        through glass and in mirrors comes and goes without end.
        """
        is_there = self._is_at_viewpoint(here)
        goal, self.goal, self._looked_on = self.goal, None, None
        self.is_as_near_as_it_gets = False
        if goal is None:
            return
        if not self._is_left(context.known, goal.middle):
            self._vanished.append(goal.middle)
            near = [
                p for p in self._vanished if math.dist(p, goal.middle) <= self._config.same_frontier
            ]
            if len(near) > self._config.most_returns:
                self.give_up(goal.middle)
            return
        if is_there:
            self.give_up(goal.middle, math.dist(goal.viewpoint, goal.middle))

    def _is_left(self, occupancy: OccupancyMap, middle: Point) -> bool:
        """Whether something of a frontier is left on a map."""
        return is_frontier(
            occupancy, middle, self._config.frontier_radius, self._config.least_cells
        )
