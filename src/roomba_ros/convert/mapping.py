"""A map's progress, its offered changes, and its clean and dirty floor, as messages."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from geometry_msgs.msg import Point
from nav_msgs.msg import OccupancyGrid
from numpy.typing import NDArray
from roomba_robot.msg import MapChange, Mapping, MapUpdate

from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.floors.map_changes import Change, ChangeKind
from roomba.perception.swept.coverage_bits import SWEPT, WANTED
from roomba_ros.convert.common import header, map_message
from roomba_ros.convert.errors import require_finite


def is_growing_of(message: Mapping) -> bool:
    """Return whether the map is being made; raises MessageError for an area that is not finite."""
    require_finite("an area", message.known)
    return bool(message.is_growing)


def update_message(now: float, changes: Iterable[Change], frame_id: str) -> MapUpdate:
    """Return the changes of a map that are offered, as a message."""
    return MapUpdate(
        header(now, frame_id),
        [
            MapChange(
                change.kind is ChangeKind.APPEARED,
                Point(change.x, change.y, 0.0),
                change.width,
                change.height,
                change.area,
            )
            for change in changes
        ],
    )


def coverage_message(
    now: float, cells: NDArray[np.uint8], frame: GridFrame, rows: int, frame_id: str
) -> OccupancyGrid:
    """Return how much is cleaned: 0 to 100 of what is wanted in a cell, -1 where nothing is.

    ``cells`` are bits over the fine ``frame``; the message has ``rows`` rows, a whole part of it.
    """
    factor = frame.rows // rows
    coarse = GridFrame(
        frame.resolution * factor, frame.origin_x, frame.origin_y, rows, frame.columns // factor
    )
    wanted = _count(cells & WANTED == WANTED, factor)
    swept = _count(cells & (WANTED | SWEPT) == (WANTED | SWEPT), factor)
    share = np.round(100.0 * swept / np.maximum(wanted, 1))
    values = np.where(wanted > 0, share, -1).astype(np.int8)
    return map_message(now, OccupancyMap(coarse, values), frame_id)


def dirt_message(
    now: float, density: NDArray[np.float32], frame: GridFrame, dirty: float, frame_id: str
) -> OccupancyGrid:
    """Return where it is dirty, by grains/m2, NaN where that is not known: -1 there.

    100 stands for ``dirty`` and more, from which on floor is cleaned once more.
    """
    share = np.clip(100.0 * np.nan_to_num(density) / dirty, 0.0, 100.0)
    values = np.where(np.isnan(density), -1, np.round(share)).astype(np.int8)
    return map_message(now, OccupancyMap(frame, values), frame_id)


def _count(mask: NDArray[np.bool_], factor: int) -> NDArray[np.int64]:
    """Return how many are true in each block of ``factor`` by ``factor`` cells."""
    rows, columns = mask.shape[0] // factor, mask.shape[1] // factor
    blocks = mask.reshape(rows, factor, columns, factor)
    counted: NDArray[np.int64] = blocks.sum(axis=(1, 3))
    return counted
