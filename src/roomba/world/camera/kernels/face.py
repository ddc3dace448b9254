"""Compiled upright faces in a picture column: which rows show one; see the kernels of spans."""

from __future__ import annotations

import math

from roomba.compilation import compiled
from roomba.world.camera.kernels.compilation import INLINE
from roomba.world.camera.scene.arrays import Spans, ViewTables

CONTACT_HEIGHT = 0.22
"""m; below this, faces that stand on the floor grow darker towards it."""
CONTACT_SHADE = 0.70
"""How bright such a face is at the floor, against its upper part."""


@compiled(**INLINE)
def row_of(slope: float, half: float, focal: float, rows: int) -> int:
    """Return the first row that looks at or below a slope, 0..rows."""
    row = math.ceil(half - 0.5 - focal * slope)
    return int(min(max(row, 0.0), float(rows)))


@compiled(**INLINE)
def add_span(
    spans: Spans,
    count: int,
    first: int,
    last: int,
    surface: int,
    kind: int,
    values: tuple[float, float, float, float, float, float, float],
) -> int:
    """Add a span unless it is empty; returns how many there are."""
    if first >= last:
        return count
    place = spans.places[count]
    place[0], place[1], place[2], place[3] = first, last, surface, kind
    value = spans.values[count]
    for index in range(7):
        value[index] = values[index]
    return count + 1


@compiled(**INLINE)
def add_face(
    spans: Spans,
    count: int,
    view: ViewTables,
    t: float,
    bottom: float,
    top: float,
    surface: int,
    glows: bool,
    slant: float,
    u: float,
    kind: int,
    shade: float,
) -> int:
    """Add an upright face of depth ``t`` between two heights above the floor, m.

    ``slant`` is how much wider than high a sample is on the face, ``u`` the place along the face,
    m. The face darkens towards the floor.
    """
    half = 0.5 * view.rows
    step = -t / view.focal
    per_depth = 1.0 / t
    footprint = -step * min(math.sqrt(slant), 4.0)
    first = row_of((top - view.eye) * per_depth, half, view.focal, view.rows)
    last = row_of((bottom - view.eye) * per_depth, half, view.focal, view.rows)
    middle = last
    if bottom < CONTACT_HEIGHT and not glows:
        middle = row_of((CONTACT_HEIGHT - view.eye) * per_depth, half, view.focal, view.rows)
        middle = min(max(middle, first), last)
    height = view.eye - (half - first - 0.5) * step
    count = add_span(
        spans, count, first, middle, surface, kind, (t, u, height, step, footprint, shade, 0.0)
    )
    height = view.eye - (half - middle - 0.5) * step
    gain = shade * (1.0 - CONTACT_SHADE) / CONTACT_HEIGHT
    low = shade * CONTACT_SHADE + gain * max(min(height, CONTACT_HEIGHT), 0.0)
    values = (t, u, height, step, footprint, low, gain * step)
    return int(add_span(spans, count, middle, last, surface, kind, values))
