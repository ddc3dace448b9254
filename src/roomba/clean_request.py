"""One request to clean: from pages, programs and plans to the mission, and into its checkpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from roomba.errors import RequestRefusedError
from roomba.geometry import Pose
from roomba.vocabulary import (
    MOST_PASSES,
    MOST_ZONES,
    CarpetWay,
    CleanMode,
    EdgeOrder,
    FanLevel,
    RoomWay,
    fault_of_name,
)


class CleanRefusedError(RequestRefusedError):
    """A request that cannot be fulfilled; the message says what was expected and what came."""


Rectangle = tuple[float, float, float, float]
"""Lowest x, lowest y, highest x, highest y, m."""


@dataclass(frozen=True, slots=True)
class CleanRequest:
    """``rooms`` for ROOMS, in order if ``in_order``; ``zones`` for ZONES; ``spot`` for SPOT.

    ``each`` says how to clean each room, in the order of ``rooms``; it is empty if ``passes`` and
    ``fan`` hold for all.
    """

    mode: CleanMode = CleanMode.WHOLE
    rooms: tuple[str, ...] = ()
    zones: tuple[Rectangle, ...] = ()
    spot: tuple[float, float] | None = None
    passes: int = 1
    fan: FanLevel = FanLevel.STANDARD
    in_order: bool = False
    each: tuple[RoomWay, ...] = ()
    carpets: CarpetWay = CarpetWay.BOOST
    edges: EdgeOrder = EdgeOrder.ANY

    def __post_init__(self) -> None:
        """Check what can be checked without a map. Raises CleanRefusedError."""
        for passes in (self.passes, *(way.passes for way in self.each)):
            require_passes(passes)
        if self.each and (self.mode is not CleanMode.ROOMS or len(self.each) != len(self.rooms)):
            raise CleanRefusedError(
                f"expected a way to clean for each of the {len(self.rooms)} rooms, or none; "
                f"got {len(self.each)} for mode {self.mode.value}"
            )
        if self.mode is CleanMode.ROOMS and not self.rooms:
            raise CleanRefusedError("expected the names of rooms to clean, got none")
        if self.mode is CleanMode.ZONES and not self.zones:
            raise CleanRefusedError("expected zones to clean, got none")
        for what, asked in (("rooms", self.rooms), ("zones", self.zones)):
            if len(asked) > MOST_ZONES:
                raise CleanRefusedError(f"expected at most {MOST_ZONES} {what}, got {len(asked)}")
        for name in self.rooms:
            if fault := fault_of_name(name):
                raise CleanRefusedError(f"a room to clean: {fault}")
        if self.spot is not None and not all(map(math.isfinite, self.spot)):
            raise CleanRefusedError(f"expected a spot of finite numbers, m, got {self.spot}")
        for zone in self.zones:
            # A checkpoint cannot keep numbers that are not finite.
            is_finite = all(map(math.isfinite, zone))
            if not (is_finite and zone[0] < zone[2] and zone[1] < zone[3]):
                raise CleanRefusedError(
                    "expected zones as lowest x, lowest y, highest x, highest y, m, "
                    f"got {', '.join(f'{value:g}' for value in zone)}"
                )

    @property
    def most_passes(self) -> int:
        """The greatest number of passes that any part of the floor gets."""
        return max((way.passes for way in self.each), default=self.passes)

    def moved(self, old_in_new: Pose) -> CleanRequest:
        """Return the same request in another frame, in which this one lies at ``old_in_new``.

        The middle of a zone stays at its place; its sides are along the axes of the new frame.
        """
        spot = None if self.spot is None else old_in_new.place_of(*self.spot)
        zones = tuple(_moved_zone(old_in_new, zone) for zone in self.zones)
        return replace(self, zones=zones, spot=spot)

    def way_of(self, room: str) -> RoomWay:
        """Return how a room is cleaned: by its part of ``each``, else by ``passes`` and ``fan``."""
        if self.each and room in self.rooms:
            return self.each[self.rooms.index(room)]
        return RoomWay(self.passes, self.fan)


def _moved_zone(old_in_new: Pose, zone: Rectangle) -> Rectangle:
    left, bottom, right, top = zone
    middle = 0.5 * (left + right), 0.5 * (bottom + top)
    x, y = old_in_new.place_of(*middle)
    off_x, off_y = x - middle[0], y - middle[1]
    return left + off_x, bottom + off_y, right + off_x, top + off_y


def require_passes(passes: int) -> None:
    """Raise CleanRefusedError for passes over the same floor that cannot be asked for."""
    if not 1 <= passes <= MOST_PASSES:
        raise CleanRefusedError(f"expected 1 to {MOST_PASSES} passes, got {passes}")
