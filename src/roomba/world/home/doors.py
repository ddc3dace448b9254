"""The leaves of doors: boxes that stand in their openings, or are out of the way."""

from __future__ import annotations

from dataclasses import replace

from roomba.geometry import Pose
from roomba.world.home.home import (
    LEAF_HEIGHT,
    Box,
    Door,
    Home,
    MovingKind,
    MovingThing,
    Script,
)


def leaf_of(door: Door, wall_height: float) -> MovingThing:
    """Return the leaf of a door as a thing that could move, and has no script yet."""
    area = door.opening
    size_x, size_y = area.x_max - area.x_min, area.y_max - area.y_min
    pose = Pose((area.x_min + area.x_max) / 2.0, (area.y_min + area.y_max) / 2.0, 0.0)
    height = min(LEAF_HEIGHT, wall_height)
    return MovingThing(
        door.name,
        MovingKind.DOOR,
        (Box(0.0, 0.0, 0.0, size_x, size_y, 0.0, height, "door"),),
        pose,
        not door.is_open,
        Script(()),
    )


def with_leaves(home: Home) -> Home:
    """Return the home with a leaf in each open door that has none yet, so that it can be shut.

    A door that is shut without a moving leaf stays as solid as it is; so does a home that was
    turned, whose doors lie aslant.
    """
    if home.turned is not None:
        return home
    moving = {thing.name for thing in home.moving if thing.kind is MovingKind.DOOR}
    leaves = tuple(
        leaf_of(door, home.wall_height)
        for door in home.doors
        if door.is_open and door.name not in moving
    )
    return replace(home, moving=(*home.moving, *leaves))
