"""The floor that counts: what a lidar sees from the places that the robot can reach."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Mask
from roomba.commands.map.error_kernels import see_around
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.grid import GridFrame
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import numbered_regions

_APART: Final = 0.15
"""m between two places from which the lidar looks around."""
_MOST_PLACES: Final = 20_000
_BEAMS: Final = 720


def seen_floor(
    solid: Mask, frame: GridFrame, station: tuple[float, float], robot: RobotConfig
) -> Mask:
    """Return the free floor that can be seen, bool over ``frame``.

    Closed rooms, the insides of furniture, and what lies beyond the lidar's range are not among it.
    ``station`` is where the docked robot stands, m. Raises RoombaError when it fits nowhere near.
    """
    middles = _reached(solid, frame, station, robot.body.radius)
    most = math.sqrt(np.count_nonzero(middles) / _MOST_PLACES)
    stride = max(1, round(_APART / frame.resolution), math.ceil(most))
    chosen = np.zeros(frame.shape, np.bool_)
    chosen[::stride, ::stride] = middles[::stride, ::stride]
    rows, columns = np.nonzero(chosen if chosen.any() else middles)
    seen = np.zeros(frame.shape, np.bool_)
    see_around(solid, rows, columns, _BEAMS, robot.lidar.max_range / frame.resolution, seen)
    return seen


def _reached(solid: Mask, frame: GridFrame, station: tuple[float, float], radius: float) -> Mask:
    """Return the cells that the robot's middle can get to."""
    padded = np.pad(solid, 1, constant_values=True)
    away = distance_to_nearest(padded)[1:-1, 1:-1] - 0.5
    fits = away * frame.resolution >= radius
    if not fits.any():
        raise RoombaError("expected a floor on which the robot fits, got none; check the map")
    regions = numbered_regions(fits)
    rows, columns = np.nonzero(fits)
    x, y = frame.centres(rows, columns)
    nearest = int(np.argmin(np.hypot(x - station[0], y - station[1])))
    reached: Mask = regions == regions[rows[nearest], columns[nearest]]
    return reached
