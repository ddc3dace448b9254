"""The geometry of the camera's pictures as tables, and the room to work in that they need."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import CameraConfig
from roomba.world.camera.kernels.span import SPANS_OF_BOX, SPANS_OF_WALL
from roomba.world.camera.scene.arrays import STRIP, TILE, Spans, StripRow, ViewTables, Workspace

KNOT_SPACING = 0.05
"""m; the floor's light and dirt are sampled at least so finely near the camera."""
KNOT_ROWS = 16
"""Rows of samples; the knots lie no more rows apart than this."""
MOST_TAPS = 5
FINEST_CRUMB = 0.0012
"""m; a sample larger than this begins to miss single crumbs."""


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
        columns=-(-columns // STRIP) * STRIP,
        middle=0.5 * columns,
        rows=rows,
        focal=focal,
        eye=config.mount_height,
        reach=reach.astype(np.float32),
        spread=(reach**1.5 / focal).astype(np.float32),
        floor_depth=np.where(level > 0.0, distance, np.inf).astype(np.float32),
        knots=_knots(distance, rows, factor),
        octave=np.log2(footprint).astype(np.float32),
        taps=taps.astype(np.int32),
        crispness=crispness.astype(np.float32),
    )


def _knots(distance: NDArray[np.float64], rows: int, step: int) -> NDArray[np.int32]:
    """Return rows of the floor, top to bottom, between which light and dirt change evenly.

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
    spans = SPANS_OF_WALL + SPANS_OF_BOX * boxes
    return Workspace(
        hits=np.zeros((view.columns, 3), np.float64),
        seen=np.zeros((boxes, 4), np.float64),
        spans=Spans(np.zeros((spans, 4), np.int64), np.zeros((spans, 7), np.float64)),
        colours=np.zeros((STRIP, view.rows), np.uint32),
        depths=np.zeros((STRIP, view.rows), np.float32),
        tile=np.zeros((view.rows, STRIP), np.uint32),
        knots=np.zeros((view.columns // TILE + 1, len(view.knots), 3), np.float32),
        surfaces=np.zeros(STRIP // TILE, np.int64),
        row=_strip_row(),
    )


def _strip_row() -> StripRow:
    def real() -> NDArray[np.float32]:
        return np.zeros(STRIP, np.float32)

    def whole() -> NDArray[np.int32]:
        return np.zeros(STRIP, np.int32)

    def packed() -> NDArray[np.uint32]:
        return np.zeros(STRIP, np.uint32)

    return StripRow(
        way_x=real(), way_y=real(), scale=real(), start=whole(), width=whole(), base=whole(),
        shade=whole(), level=whole(), dust=whole(), veil=packed(), place=whole(), block=whole(),
        colour=packed(),
    )  # fmt: skip
