"""The geometry of the camera's pictures as tables, and the room to work in that they need."""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import CameraConfig
from roomba.world.camera.kernels.span import SPANS_OF_BOX, SPANS_OF_WALL
from roomba.world.camera.lanes.lanes import LANES
from roomba.world.camera.scene.arrays import Spans, ViewTables, Workspace

Number = TypeVar("Number", np.uint8, np.uint32, np.float32)

KNOT_SPACING = 0.05
"""m; the floor's light and dirt are felt at least so finely near the camera."""
KNOT_ROWS = 16
"""Rows of samples; and not more of them apart than this."""
MOST_TAPS = 5
CACHE_LINE = 64
"""Bytes."""
FINEST_CRUMB = 0.0012
"""m; a sample larger than this begins to miss single crumbs."""


def whole_lanes(count: int) -> int:
    """Return so many rows or columns, or a few more: a whole number of lanes."""
    return -(-count // LANES) * LANES


def aligned(shape: tuple[int, ...], kind: type[Number]) -> NDArray[Number]:
    """Return an array, not filled, whose lanes do not lie astride two of the cache's lines."""
    size = math.prod(shape) * np.dtype(kind).itemsize
    spare = np.empty(size + CACHE_LINE, np.uint8)
    first = -spare.ctypes.data % CACHE_LINE
    return spare[first : first + size].view(kind).reshape(shape)


def view_tables(config: CameraConfig, factor: int) -> ViewTables:
    """Return the geometry of a picture of ``factor`` samples per pixel in each direction."""
    columns, rows = config.width * factor, config.height * factor
    focal = 0.5 * columns / math.tan(math.radians(config.horizontal_field) / 2.0)
    level = np.arange(rows) + 0.5 - 0.5 * rows
    below = np.abs(level)
    # An odd number of rows has one that looks exactly level: it meets no floor.
    reach = focal / np.maximum(below, 1e-3)
    distance = config.mount_height * reach
    across = distance / focal
    along = distance**2 / (config.mount_height * focal)
    taps = np.clip(np.ceil(along / across), 1, MOST_TAPS if factor > 1 else 1)
    footprint = np.maximum(across, np.sqrt(across * along / taps))
    crispness = np.clip(FINEST_CRUMB / footprint * 1.4, 0.0, 1.0)
    crispness[crispness < 0.05] = 0.0
    return ViewTables(
        columns=whole_lanes(columns),
        middle=0.5 * columns,
        rows=rows,
        focal=focal,
        eye=config.mount_height,
        reach=_with_spare(reach),
        spread=(reach**1.5 / focal).astype(np.float32),
        floor_depth=_with_spare(np.where(level > 0.0, distance, np.inf)),
        knots=_knots(distance, rows, factor),
        octave=np.log2(footprint).astype(np.float32),
        taps=taps.astype(np.int32),
        crispness=crispness.astype(np.float32),
    )


def _with_spare(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return a value per row and some more, so that there are lanes from each row on."""
    return np.pad(values.astype(np.float32), (0, LANES), "edge")


def _knots(distance: NDArray[np.float64], rows: int, step: int) -> NDArray[np.int32]:
    """Return rows of the floor, top to bottom, between which light and dirt hardly bend.

    They lie ``step`` rows apart or a multiple of that.
    """
    knots = [(rows + 1) // 2]
    while knots[-1] < rows:
        row = knots[-1]
        until = min(row + step, rows)
        while (
            until < rows
            and until - row < KNOT_ROWS
            and distance[row] - distance[until] < KNOT_SPACING
        ):
            until = min(until + step, rows)
        knots.append(until)
    return np.array(knots, np.int32)


def workspace(view: ViewTables, boxes: int) -> Workspace:
    """Return room for pictures of a scene of so many boxes."""
    height = whole_lanes(view.rows) + LANES
    spans = SPANS_OF_WALL + SPANS_OF_BOX * boxes
    return Workspace(
        hits=np.zeros((view.columns, 3), np.float64),
        seen=np.zeros((boxes, 4), np.float64),
        spans=Spans(np.zeros((spans, 4), np.int64), np.zeros((spans, 7), np.float64)),
        colours=aligned((LANES, height), np.uint32),
        depths=aligned((LANES, height), np.float32),
        tile=aligned((height, LANES), np.uint32),
        knots=np.zeros((2, len(view.knots), 3), np.float32),
    )
