"""Makes pieces of furniture: kind, place and sizes in; boxes in the map frame out."""

from __future__ import annotations

import math

from roomba.geometry import Pose, wrap_angle
from roomba.world.catalogue import FIXTURES, KINDS, LOW_KINDS, FurnitureKind, Size
from roomba.world.home.home import Box, Furniture
from roomba.world.home.materials import MATERIALS, Material

__all__ = [
    "FIXTURES",
    "KINDS",
    "LOW_KINDS",
    "MATERIALS",
    "STATION_KIND",
    "FurnitureKind",
    "Material",
    "Size",
    "furniture_at",
    "station_at",
]

STATION_KIND = "station"
STATION_WIDTH = 0.26
"""m; across the back plate that the docked robot looks at."""
STATION_HEIGHT = 0.10
"""m; a little more than the body, so that its bumper and lidar meet it."""
STATION_GAP = 0.03
"""m; between the front of the docked disc and the back plate."""


def furniture_at(
    name: str,
    kind: str,
    pose: Pose,
    *,
    size: Size | None = None,
    material: str | None = None,
    on_map: bool = True,
) -> Furniture:
    """Return a piece of the catalogue at ``pose`` in the map frame, its front looking along theta.

    ``size`` and ``material`` replace the kind's defaults. Raises KeyError for an unknown kind.
    """
    entry = KINDS[kind]
    boxes = entry.build(size or entry.size, material or entry.material)
    return Furniture(name, kind, pose, tuple(box.placed_at(pose) for box in boxes), on_map)


def station_at(docked: Pose, body_radius: float, depth: float) -> Furniture:
    """Return the charging station before a docked robot's nose, ``depth`` m deep.

    ``docked`` is the robot's pose in the map frame; the station's pose is its middle, looking back
    at the robot. Lengths in m.
    """
    front = body_radius + STATION_GAP
    middle = docked.compose(Pose(front + depth / 2.0, 0.0, 0.0))
    pose = Pose(middle.x, middle.y, wrap_angle(docked.theta + math.pi))
    plate = Box(0.0, 0.0, 0.0, depth, STATION_WIDTH, 0.0, STATION_HEIGHT, "station")
    light = Box(depth / 2.0, 0.0, 0.0, 0.004, 0.06, 0.075, 0.085, "station_light")
    boxes = (plate.placed_at(pose), light.placed_at(pose))
    return Furniture("station", STATION_KIND, pose, boxes, on_map=True)
