"""Obstacles that the map does not show: felt by bumper and cliff sensors, or seen by the lidar.

They do not change the map: they are remembered for a while.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import WalkConfig
from roomba.configuration.mission import DrivingConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.driving.unknown_things import UnknownThings
from roomba.mission.inputs.senses import Senses
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.rooms.low_things import LowThings, OfferedZone
from roomba.perception.rooms.zones import Zones
from roomba.perception.things.layer import ThingLayer

_FOREVER: Final = math.inf
_TOUCHES: Final = 20
"""The newest touches, with whose places a new one is compared."""
_SPARED: Final = 0.010
"""m by which the robot may come nearer to a thing than planned, of the 0.02 m by which a thing is
thought thicker than it was seen: else each new look at it would break a path along it."""
_MOST_BESIDE: Final = 2
"""Touches from one place that a wall beside the robot explains; after them something else must."""
_LEAST: Final = 0.01
"""m; the thinnest thing that stands."""


class Way(Protocol):
    """A path: ``points``, float64 [n, 2], m, and the way along it to each, ``stations`` [n], m."""

    @property
    def points(self) -> NDArray[np.float64]:
        """The corners and both ends."""

    @property
    def stations(self) -> NDArray[np.float64]:
        """From 0 to the length."""


class Obstacles:
    """Round things in the way; ``version`` changes whenever a thing comes or goes.

    Cleans and walks share this one memory. What was felt is forgotten after ``felt_memory`` s. What
    was felt again at the same place, or where nothing is seen, is forgotten after
    ``lasting_memory`` s. What was seen is forgotten when the lidar sees through it. An edge of the
    floor is remembered through the errand in which it was felt; felt in two errands, for good.
    """

    def __init__(
        self, seen: ThingLayer, walk: WalkConfig, body: BodyConfig, config: DrivingConfig
    ) -> None:
        """Begin with what ``seen`` holds, and nothing felt."""
        self.seen = seen
        """What the lidar sees, of the present map."""
        self._felt = UnknownThings(walk, body, config.felt_memory)
        # What is felt at a place again and again is no wall that it met being late.
        self._lasting = UnknownThings(walk, body, config.lasting_memory)
        self._touched: deque[tuple[float, float]] = deque(maxlen=_TOUCHES)
        # People and chairs, which go away, are seen; glass, mirrors, cables and sills are not.
        self._unseen = UnknownThings(walk, body, config.lasting_memory)
        # A wall that is met aside stands, but where the robot is may be off for a while.
        self._beside = UnknownThings(walk, body, config.felt_memory)
        self._things = self._felt, self._lasting, self._unseen, self._beside
        # Stairs do not go away. What a speck of dirt on a sensor showed once is not felt again.
        self._edges = UnknownThings(walk, body, _FOREVER)
        self._stairs = UnknownThings(walk, body, _FOREVER)
        # Edges of errands before: they block nothing, and become stairs if they are felt again.
        self._edges_before = UnknownThings(walk, body, _FOREVER)
        self._all_edges = self._edges, self._stairs, self._edges_before
        self._same_place, self._tipping = config.lasting_radius, walk.tipping
        self.felt_version = 0
        """A number that changes when something that is felt comes or goes."""
        self.keep = body.radius - _SPARED
        """m; so near to a path something that is seen is in the way."""
        self._low_config = config.low_things
        self.low = LowThings()
        """What was felt, over all runs, where neither map nor lidar shows anything."""

    @property
    def version(self) -> int:
        """A number that changes when something comes or goes."""
        return self.seen.version + self.felt_version

    def use(self, seen: ThingLayer, moved: Pose) -> None:
        """Go on with ``seen``, the things beside another map; what was felt stays where it was.

        The frame of the map before lies at ``moved`` in that of this one.
        """
        self.felt_version += self.seen.version + 1
        self.seen = seen
        for felt in (*self._things, *self._all_edges):
            felt.move(moved)
        there = [moved.compose(Pose(x, y)) for x, y in self._touched]
        self._touched = deque(((place.x, place.y) for place in there), maxlen=_TOUCHES)
        self.low = self.low.moved(moved)

    def feel(self, senses: Senses) -> None:
        """Remember what bumper or cliff sensors found where the robot stands."""
        here = senses.pose
        before = sum(here.distance_to(x, y) < self._same_place for x, y in self._touched)
        self._touched.append((here.x, here.y))
        places = self._felt.places(here, *senses.touches)
        is_unseen = senses.knowledge is Knowledge.KNOWN and not self._is_any_seen(places)
        self.felt_version += 1
        if senses.cliff:
            edges = self._stairs if self._ended_before(places) else self._edges
            edges.felt(senses.now, here, *senses.touches)
        elif is_unseen and before < _MOST_BESIDE and (walls := self._bearings_of_walls(senses)):
            # The robot met a wall aside, in a narrow gap: nothing stands before it.
            self._beside.felt_at(senses.now, here, walls)
        elif is_unseen:
            self._unseen.felt(senses.now, here, *senses.touches)
            # The touch was somewhere along that half of the front.
            x, y = np.mean(places, axis=0).tolist()
            self.low = self.low.felt_at(x, y, self._low_config)
        else:
            where = self._lasting if before else self._felt
            where.felt(senses.now, here, *senses.touches)
            # A wall that it drove against, being late, is on the map.
            self._felt.drop(self.seen.is_mapped)

    def begin_errand(self) -> None:
        """Forget where the floor ended in the errand before, but for what was felt in two.

        Sensors and speed loop stop the robot there anew, if the floor does end.
        """
        self._edges_before.take(self._edges)
        self.felt_version += 1

    def forget_edges_felt_now(self, now: float) -> None:
        """Forget where the floor ended a moment ago: the robot was being picked up."""
        for edges in (self._edges, self._stairs):
            edges.forget_since(now - self._tipping)
        self.felt_version += 1

    def forget_felt_at(self, senses: Senses) -> None:
        """Forget what was felt where the robot itself stands: it cannot be there."""
        for felt in self._things:
            felt.forget_around(senses.pose.x, senses.pose.y)
        self.felt_version += 1

    def forget(self) -> None:
        """Forget all obstacles but edges, so that they are found anew."""
        self._unseen.forget()
        self.forget_what_goes()

    def forget_what_goes(self) -> None:
        """Forget all obstacles but edges and what was felt where nothing is seen, as glass is."""
        self._felt.forget()
        self._lasting.forget()
        self._beside.forget()
        self._touched.clear()
        self.seen.forget()
        self.felt_version += 1

    def standing(self, now: float) -> list[RoundObstacle]:
        """Return all that is in the way now, m, map frame."""
        return self.felt(now) + self.seen.obstacles()

    def edges(self) -> list[RoundObstacle]:
        """Return where the floor ends, which is remembered through the errand, m, map frame."""
        return self._edges.at(0.0) + self._stairs.at(0.0)

    def at_least(self, now: float) -> list[RoundObstacle]:
        """Return what is :meth:`standing`, as small as it may be: where the bumper felt is a guess.

        What was felt again, or was felt where nothing is seen, begins where the body touched it:
        else the way would lead there anew.
        """
        felt = [(x, y, _LEAST) for x, y, _ in self._felt.at(now)]
        for touched in (self._lasting, self._unseen, self._beside):
            felt += touched.at(now, _LEAST)
        return self.edges() + felt + [(x, y, _LEAST) for x, y, _ in self.seen.obstacles()]

    def felt(self, now: float) -> list[RoundObstacle]:
        """Return what bumper and cliff sensors found, m, map frame."""
        return self.edges() + self._all_felt(now)

    def first_in_way(self, way: Way, first: float, last: float) -> float | None:
        """Return where on a path, m, something seen first comes too near, or None.

        It is looked at from station ``first`` to ``last``, m.
        """
        return self.seen.first_blocked(way.points, way.stations, first, last, self.keep)

    def offered_zones(self, zones: Zones) -> tuple[OfferedZone, ...]:
        """Return the no-go zones that are offered in addition to ``zones``."""
        return self.low.offers(zones, self._low_config)

    def _is_any_seen(self, places: list[tuple[float, float]]) -> bool:
        """Whether the map or the lidar shows something at any of some places, m."""
        near = self._low_config.seen_near
        return any(self.seen.is_mapped(x, y) for x, y in places) or any(
            math.dist(place, (x, y)) < radius + near
            for x, y, radius in self.seen.obstacles()
            for place in places
        )

    def _ended_before(self, places: list[tuple[float, float]]) -> bool:
        """Whether the floor ended at any of some places, m, in an errand before."""
        return any(
            math.dist(place, (x, y)) < 2.0 * radius
            for x, y, radius in self._edges_before.at(0.0)
            for place in places
        )

    def _bearings_of_walls(self, senses: Senses) -> list[float]:
        """Return where on the pressed part of the rim the map shows a surface, rad from ahead."""
        rim = self._felt.rim(senses.pose, *senses.touches)
        return [angle for angle, x, y in rim if self.seen.is_mapped(x, y)]

    def _all_felt(self, now: float) -> list[RoundObstacle]:
        return [thing for felt in self._things for thing in felt.at(now)]
