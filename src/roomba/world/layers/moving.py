"""Turns the ``moving`` entries of a layer file into things with scripts, and checks them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, TypeVar

from roomba.files.home_layer import DAY, Layer, MovingEntry
from roomba.files.strict_yaml import Location, suggestion
from roomba.geometry import Pose, wrap_angle
from roomba.world.catalogue import FIXTURES
from roomba.world.catalogue.parts import block
from roomba.world.home.doors import leaf_of
from roomba.world.home.home import (
    Door,
    Furniture,
    Move,
    MovingKind,
    MovingThing,
    Script,
)
from roomba.world.layers.check import Checker

_Part = TypeVar("_Part")

TURNING_SPEED: Final = 2.0
"""rad/s; of a person who turns on the spot at a corner of the path."""
SHOE_TOP, LEG_TOP, SHOULDER, CROWN = 0.10, 0.85, 1.45, 1.72
"""m above the floor."""

PERSON: Final = (
    *(
        box
        for side in (-0.10, 0.10)
        for box in (
            block((-0.10, 0.16), (side - 0.05, side + 0.05), (0.0, SHOE_TOP), "black"),
            block((-0.10, 0.08), (side - 0.06, side + 0.06), (SHOE_TOP, LEG_TOP), "fabric_blue"),
        )
    ),
    block((-0.13, 0.11), (-0.22, 0.22), (LEG_TOP, SHOULDER), "fabric_mustard"),
    block((-0.11, 0.09), (-0.08, 0.08), (SHOULDER, CROWN), "cream"),
)
"""Boxes of a person who looks along x: shoes and trousers, a pullover, a head."""


def moving_things(
    layer: Layer, doors: Sequence[Door], pieces: Sequence[Furniture], check: Checker
) -> tuple[MovingThing, ...]:
    """Return what moves; raises HomeError with the line of what cannot be."""
    things: list[MovingThing] = []
    for index, entry in enumerate(layer.moving):
        location: Location = ("moving", index)
        if entry.door is not None:
            thing = _leaf(location, entry.door, entry, doors, layer.wall_height, check)
        elif entry.furniture is not None:
            thing = _moved_piece(location, entry.furniture, entry, pieces, check)
        else:
            thing = _person(location, str(entry.person), entry, check)
        key = (*location, thing.kind.value)
        if any((thing.kind, thing.name) == (other.kind, other.name) for other in things):
            raise check.file.error(
                key,
                f"moving: expected every {thing.kind.value} once, got {thing.name!r} again; "
                "put all that it does into one entry",
            )
        _check_times(location, thing.script, check)
        things.append(thing)
    return tuple(things)


def _leaf(
    location: Location,
    name: str,
    entry: MovingEntry,
    doors: Sequence[Door],
    wall_height: float,
    check: Checker,
) -> MovingThing:
    door = _known(location, MovingKind.DOOR, name, {door.name: door for door in doors}, check)
    leaf = leaf_of(door, wall_height)
    moves = [
        Move(time, 0.0, leaf.pose, is_shut)
        for interval in entry.close
        for time, is_shut in zip(interval, (True, False), strict=True)
    ]
    return replace(leaf, script=Script(tuple(moves), entry.every, entry.jitter))


def _moved_piece(
    location: Location,
    name: str,
    entry: MovingEntry,
    pieces: Sequence[Furniture],
    check: Checker,
) -> MovingThing:
    standing = {piece.name: piece for piece in pieces if piece.kind not in FIXTURES}
    piece = _known(location, MovingKind.FURNITURE, name, standing, check)
    moves: list[Move] = []
    pose = piece.pose
    for number, place in enumerate(entry.to):
        check.point((*location, "to", number), place.x, place.y)
        theta = pose.theta if place.facing is None else place.facing
        pose = Pose(place.x, place.y, theta)
        moves.append(Move(place.at, place.takes, pose))
    return MovingThing(
        name,
        MovingKind.FURNITURE,
        tuple(box.placed_at(piece.pose.inverse()) for box in piece.boxes),
        piece.pose,
        True,
        Script(tuple(moves), entry.every, entry.jitter),
    )


def _person(location: Location, name: str, entry: MovingEntry, check: Checker) -> MovingThing:
    for number, (x, y) in enumerate(entry.path):
        check.point((*location, "path", number), x, y)
    moves = _walk([(x, y) for x, y in entry.path], entry.at, entry.speed)
    return MovingThing(
        name,
        MovingKind.PERSON,
        PERSON,
        moves[0].pose,
        False,
        Script(tuple(moves), entry.every, entry.jitter),
    )


def _walk(path: Sequence[tuple[float, float]], start: float, speed: float) -> list[Move]:
    """Return how a person appears, walks from point to point, turns at each, and leaves."""
    (x, y), (next_x, next_y) = path[:2]
    pose = Pose(x, y, math.atan2(next_y - y, next_x - x))
    moves = [Move(start, 0.0, pose)]
    for next_x, next_y in path[1:]:
        heading = math.atan2(next_y - pose.y, next_x - pose.x)
        turn = abs(wrap_angle(heading - pose.theta))
        if turn > 0.0:
            pose = Pose(pose.x, pose.y, heading)
            moves.append(Move(moves[-1].ends, turn / TURNING_SPEED, pose))
        length = pose.distance_to(next_x, next_y)
        pose = Pose(next_x, next_y, heading)
        moves.append(Move(moves[-1].ends, length / speed, pose))
    return [*moves, Move(moves[-1].ends, 0.0, pose, is_present=False)]


def _known(
    location: Location, kind: MovingKind, name: str, found: Mapping[str, _Part], check: Checker
) -> _Part:
    """Return the door or piece that is meant; there must be one of that name."""
    if name not in found:
        hint = suggestion(name, found) if found else "there is none; add one"
        what = "door" if kind is MovingKind.DOOR else "piece of furniture"
        raise check.file.error(
            (*location, kind.value),
            f"moving: expected the name of a {what} of this file, got {name!r}; {hint}",
        )
    return found[name]


def _check_times(location: Location, script: Script, check: Checker) -> None:
    whole = script.period or DAY
    end = script.moves[-1].ends
    if end > whole:
        words = "its period" if script.period else "the day"
        raise check.file.error(
            location,
            f"moving: expected all to happen within {words} of {whole:g} s, got an end after "
            f"{end:g} s; let it begin earlier or last shorter",
        )
