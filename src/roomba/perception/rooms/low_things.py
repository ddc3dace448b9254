"""Low things: what the bumper felt often where neither the map nor the lidar shows anything.

Cables and sills lie below the lidar's beams. They stay in place for more than one clean. So each is
kept with the map, and offered as a no-go zone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import shapely

from roomba.configuration.mission import LowThingsConfig
from roomba.geometry import Pose
from roomba.perception.rooms.zones import Corners, Zones

MOST_LOW_THINGS: Final = 100
"""Low things of one map; of more, those are dropped that are not ignored and were felt least."""


@dataclass(frozen=True, slots=True)
class LowThing:
    """Where something was felt ``times`` times: lowest x and y, highest x and y, m, map frame.

    A thing that ``is_ignored`` is never offered.
    """

    x0: float
    y0: float
    x1: float
    y1: float
    times: int = 1
    is_ignored: bool = False

    def away(self, other: LowThing) -> float:
        """Return the gap to another one, m: along x or y, the larger of both; 0 if they overlap."""
        return max(
            self.x0 - other.x1, other.x0 - self.x1, self.y0 - other.y1, other.y0 - self.y1, 0.0
        )

    def joined(self, other: LowThing) -> LowThing:
        """Return both as one, ignored if one of them is."""
        return LowThing(
            min(self.x0, other.x0),
            min(self.y0, other.y0),
            max(self.x1, other.x1),
            max(self.y1, other.y1),
            self.times + other.times,
            self.is_ignored or other.is_ignored,
        )

    def moved(self, moved: Pose) -> LowThing:
        """Return the thing in another frame, in which this one's frame lies at ``moved``."""
        ends = [moved.compose(Pose(x, y)) for x in (self.x0, self.x1) for y in (self.y0, self.y1)]
        x, y = [end.x for end in ends], [end.y for end in ends]
        return replace(self, x0=min(x), y0=min(y), x1=max(x), y1=max(y))

    @property
    def longest(self) -> float:
        """The longer side of the thing, m."""
        return max(self.x1 - self.x0, self.y1 - self.y0)

    def corners(self, margin: float) -> Corners:
        """Return the corners of a zone that is ``margin`` m larger than the thing on each side."""
        left, right = self.x0 - margin, self.x1 + margin
        low, high = self.y0 - margin, self.y1 + margin
        return ((left, low), (right, low), (right, high), (left, high))


@dataclass(frozen=True, slots=True)
class OfferedZone:
    """A no-go zone around what was felt ``times`` times, by its corners, m, map frame."""

    times: int
    corners: Corners


@dataclass(frozen=True, slots=True)
class LowThings:
    """All low things of a map; each change returns a new object."""

    all: tuple[LowThing, ...] = ()

    def felt_at(self, x: float, y: float, config: LowThingsConfig) -> LowThings:
        """Return these after something was felt at a point, m.

        The point is a new thing, or it is joined with the things near by, unless that makes them
        too long, or would join an ignored thing with one that is not.
        """
        thing, others = LowThing(x, y, x, y), list[LowThing]()
        for each in sorted(self.all, key=thing.away):
            both = thing.joined(each)
            is_near = thing.away(each) <= config.same and both.longest <= config.longest
            if is_near and (thing.times == 1 or thing.is_ignored == each.is_ignored):
                thing = both
            else:
                others.append(each)
        others.sort(key=lambda each: (each.is_ignored, each.times), reverse=True)
        return LowThings((*others[: MOST_LOW_THINGS - 1], thing))

    def moved(self, moved: Pose) -> LowThings:
        """Return the same in another frame, in which this one lies at ``moved``."""
        return LowThings(tuple(thing.moved(moved) for thing in self.all))

    def ignoring(self, x: float, y: float) -> LowThings:
        """Return these with the thing at a point, m, ignored; raises ValueError without one."""
        here = LowThing(x, y, x, y)
        nearest = min(self.all, key=here.away, default=None)
        if nearest is None or nearest.away(here) > 0.0:
            raise ValueError(
                f"expected a place within something that was felt, got ({x:.2f}, {y:.2f}); "
                "it may be in a zone by now"
            )
        ignored = replace(nearest, is_ignored=True)
        return LowThings(tuple(ignored if each is nearest else each for each in self.all))

    def offers(self, zones: Zones, config: LowThingsConfig) -> tuple[OfferedZone, ...]:
        """Return the zones to offer.

        They are around things that were felt often, are not ignored, and are not yet in a zone that
        the robot must not enter.
        """
        return tuple(
            OfferedZone(thing.times, thing.corners(config.margin))
            for thing in self.all
            if thing.times >= config.offered and not thing.is_ignored and not _is_in(thing, zones)
        )


def _is_in(thing: LowThing, zones: Zones) -> bool:
    x, y = 0.5 * (thing.x0 + thing.x1), 0.5 * (thing.y0 + thing.y1)
    return any(zone.shape.covers(shapely.Point(x, y)) for zone in zones.barred)
