"""Carrying names of rooms and zones over to a new map of the same floor."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.errors import RoomsError
from roomba.geometry import Pose
from roomba.perception.rooms.rooms import SMALLEST_PIECE, Rooms
from roomba.perception.rooms.zones import Zones
from roomba.raster.carried import carried

Overlaps = NDArray[np.float64]
"""[new rooms, old rooms]: how much of the floor they share, m2; 0 where too little."""


@dataclass(frozen=True, slots=True, eq=False)
class CarriedOver:
    """What a new map takes over from the old one; ``lost`` are names of rooms that are gone."""

    rooms: Rooms
    zones: Zones
    lost: tuple[str, ...]


_SAME: Final = Pose()
"""Where the old map lies on the new one when both have one frame."""


def carry_over(
    new: Rooms, old: Rooms | None, zones: Zones, least: float, old_in_new: Pose = _SAME
) -> CarriedOver:
    """Return ``new`` rooms with the names of the ``old`` ones that they overlap most, and zones.

    Two rooms are the same if they share at least ``least`` of the smaller one's floor.
    ``old_in_new`` is where the old map's frame lies in the new one; the result is in the new frame.
    Each old name goes to one new room, so that rooms share as much floor with their namesakes as
    can be. A room without an old name keeps "Room n", or gets one that is not taken. Zones stay at
    their places.
    """
    there = moved(zones, old_in_new)
    if old is None:
        return CarriedOver(new, there, ())
    partners = _best_partners(_overlaps(new, old, least, old_in_new))
    names = tuple(_names(new.names, old.names, partners))
    lost = tuple(name for label, name in enumerate(old.names) if label not in partners)
    return CarriedOver(replace(new, names=names), there, lost)


def divided_as(old: Rooms, new: Rooms) -> Rooms | None:
    """Return the floor of ``new`` rooms divided as the ``old`` ones divided it, if that still fits.

    It does not fit, and None is returned, on another grid, if a room is gone or in pieces now, or
    if :data:`SMALLEST_PIECE` or more of the floor was in no room.
    """
    if old.frame != new.frame:
        return None
    outlines = [(name, old.outline(label)) for label, name in enumerate(old.names, 1)]
    try:
        rooms = Rooms.from_outlines(new.frame, new.labels > 0, outlines)
    except RoomsError:
        return None
    left = np.count_nonzero((new.labels > 0) & (rooms.labels == 0)) * new.frame.resolution**2
    labels = range(1, len(rooms.names) + 1)
    is_whole = all(isinstance(rooms.outline(label), shapely.Polygon) for label in labels)
    return rooms if is_whole and left < SMALLEST_PIECE else None


def moved(zones: Zones, old_in_new: Pose) -> Zones:
    """Return zones of the old map in the frame of the new one."""
    if old_in_new == _SAME:
        return zones
    return Zones(
        tuple(
            replace(
                zone,
                points=tuple(
                    (corner.x, corner.y)
                    for corner in (old_in_new.compose(Pose(x, y)) for x, y in zone.points)
                ),
            )
            for zone in zones.all
        )
    )


def _overlaps(new: Rooms, old: Rooms, least: float, old_in_new: Pose) -> Overlaps:
    """Return how much floor each two rooms share; 0 where too little to be the same room."""
    there = carried(old.labels, old.frame, new.frame, old_in_new)
    shape = len(new.names) + 1, len(old.names) + 1
    pairs = new.labels.astype(np.int64) * shape[1] + there
    counts = np.bincount(pairs.ravel(), minlength=shape[0] * shape[1]).reshape(shape)
    shared = counts[1:, 1:] * new.frame.resolution**2
    of_new = np.bincount(new.labels.ravel(), minlength=shape[0])[1:] * new.frame.resolution**2
    of_old = np.bincount(old.labels.ravel(), minlength=shape[1])[1:] * old.frame.resolution**2
    enough = least * np.minimum(of_new[:, None], of_old[None, :])
    return np.where(shared >= enough, shared, 0.0)


def _best_partners(shared: Overlaps) -> list[int | None]:
    """Return for each new room its old one: the pairing, one to one, that shares most floor.

    The pairing grows by one pair at a time, by the chain of changes that gains most, until no chain
    gains (successive augmenting paths: Ahuja, Magnanti and Orlin, "Network Flows", 12.4).
    """
    partners: list[int | None] = [None] * shared.shape[0]
    while True:
        way = _best_way(shared, partners)
        if way is None:
            return partners
        for new, old in way:
            partners[new] = old


def _best_way(shared: Overlaps, partners: list[int | None]) -> list[tuple[int, int]] | None:
    """Return the chain of pairs to make that gains most floor, from its end; None if none gains."""
    count_new, count_old = shared.shape
    owner = {old: new for new, old in enumerate(partners) if old is not None}
    # The most that is gained if a new room gives up its partner, and the pair that takes it over.
    gain = [0.0 if partner is None else -np.inf for partner in partners]
    before: list[tuple[int, int] | None] = [None] * count_new
    for _ in range(count_new):
        for new, old in itertools.product(range(count_new), range(count_old)):
            if shared[new, old] <= 0.0 or old not in owner or owner[old] == new:
                continue
            freed = owner[old]
            through = gain[new] + shared[new, old] - shared[freed, old]
            if through > gain[freed] + 1e-12:
                gain[freed], before[freed] = through, (new, old)
    best, end = 1e-12, None
    for new, old in itertools.product(range(count_new), range(count_old)):
        if shared[new, old] > 0.0 and old not in owner and gain[new] + shared[new, old] > best:
            best, end = gain[new] + shared[new, old], (new, old)
    if end is None:
        return None
    way = [end]
    while (previous := before[way[-1][0]]) is not None:
        way.append(previous)
    return way


def _names(new: tuple[str, ...], old: tuple[str, ...], partners: list[int | None]) -> Iterator[str]:
    """Yield a name for each new room: its partner's, else its own, else a number that is free."""
    taken = {old[partner] for partner in partners if partner is not None}
    kept = {
        name
        for name, partner in zip(new, partners, strict=True)
        if partner is None and name not in taken
    }
    taken |= kept
    for name, partner in zip(new, partners, strict=True):
        if partner is not None:
            yield old[partner]
        elif name in kept:
            yield name
        else:
            tries = (f"Room {number}" for number in itertools.count(1))
            free = next(each for each in tries if each not in taken)
            taken.add(free)
            yield free
