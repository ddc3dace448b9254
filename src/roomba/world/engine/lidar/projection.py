"""The compiled lidar: exact ranges to walls, moving things and other robots.

Each edge that faces the robot is put into the depth buffer of :mod:`.span_kernels`: the directions
of its ends give the beams that meet it. Angles of all ends are computed at once, with a polynomial
for the arc tangent, so that the compiler works on eight of them together. In a home of many tiles
only those are looked at into which some beam still shines. Metres from the grid's lower left
corner, float32.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats32
from roomba.compilation import any_order_part
from roomba.world.engine.lidar.bundle_kernels import BEAMS
from roomba.world.engine.lidar.edges import FACINGS, GROUPS
from roomba.world.engine.lidar.span_kernels import (
    COSINE,
    LANES,
    NEAREST,
    SINE,
    raise_span,
    shows_through,
)
from roomba.world.engine.state.arrays import Edges, Row, Rows

FACTOR, X_RIGHT, Y_RIGHT, X_LEFT, Y_LEFT, BEAM_RIGHT, BEAM_LEFT = range(7)
"""Rows of the collected edges: the inverse distance of the line, and for both ends where they are
as seen from the robot, and which beam points there."""

_PI: Final = np.float32(math.pi)
_HALF_PI: Final = np.float32(math.pi / 2.0)
_TWO_PI: Final = np.float32(2.0 * math.pi)
_SLACK: Final = np.float32(1e-4)
"""Beams; ends of edges are widened by this, so that no beam slips between two that meet."""
_TINY: Final = np.float32(1e-12)
_OFF_LINE: Final = 3e-7
"""A scan keeps off lines between cells by this share of its coordinate plus one metre, two steps
of float32: on a line it would see edges edge-on."""

# atan(x) on [0, 1] = x (c0 + c1 x^2 + ...), fitted for the least largest error: 6e-9 rad.
_C0, _C1, _C2, _C3, _C4, _C5, _C6, _C7, _C8 = (
    np.float32(value)
    for value in (
        0.999999886,
        -0.33332597,
        0.199859064,
        -0.141612264,
        0.104989357,
        -0.0723483574,
        0.0397809699,
        -0.014401201,
        0.00245668483,
    )
)


class ScanBuffers(NamedTuple):
    """Where scans are made, for one thread at a time."""

    rays: Floats32
    """[2, beams]: cosine and sine of each beam in the robot's frame."""
    fan: Floats32
    """[3, 1.5 beams and spare ones]: see :mod:`.span_kernels`; in the map frame. The beams of the
    first half come twice, so that no span has to be cut in two."""
    ends: Floats32
    """[7, edges of a tile]: the edges that look at the robot."""
    items: NDArray[np.int64]
    """[edges of a tile]: the numbers of these edges."""
    tiles: NDArray[np.int64]
    """[2, tiles]: the number of the last scan that looked at each, and the tiles in a queue."""
    scans: NDArray[np.int64]
    """[1]: number of scans made so far."""
    bundles: Rows
    """BEAMS [1]: the beams of a sweep that are measured together, see :mod:`.bundle_kernels`."""


def buffers_for(edges: Edges, beams: int) -> ScanBuffers:
    """Return buffers in which every home of ``edges`` can be scanned."""
    size = beams + beams // 2 + 2 * LANES
    most = int((edges.starts[:, -1] - edges.starts[:, 0]).max(initial=0))
    angles = np.arange(beams) * (2.0 * math.pi / beams)
    return ScanBuffers(
        rays=np.stack([np.cos(angles), np.sin(angles)]).astype(np.float32),
        fan=np.zeros((3, size), np.float32),
        # Not zero: unused places at the end of a block are computed too.
        ends=np.ones((7, (most // LANES + 2) * LANES), np.float32),
        items=np.zeros(most + 1, np.int64),
        tiles=np.zeros((2, len(edges.starts)), np.int64),
        scans=np.zeros(1, np.int64),
        bundles=np.zeros(1, BEAMS),
    )


@any_order_part
def begin_scan(rays: Floats32, fan: Floats32, theta: float, max_range: float) -> np.float32:
    """Turn the beams to the heading and empty the depth buffer; return the heading in [-pi, pi]."""
    beams = rays.shape[1]
    cosine = np.float32(math.cos(theta))
    sine = np.float32(math.sin(theta))
    for beam in range(beams):
        along, across = rays[0, beam], rays[1, beam]
        fan[COSINE, beam] = along * cosine - across * sine
        fan[SINE, beam] = across * cosine + along * sine
    for beam in range(beams // 2 + LANES):
        fan[COSINE, beams + beam] = fan[COSINE, beam]
        fan[SINE, beams + beam] = fan[SINE, beam]
    least = np.float32(1.0 / max_range)
    for beam in range(fan.shape[1]):
        fan[NEAREST, beam] = least
    return np.float32(wrapped(theta))


@any_order_part
def point_beams(
    ends: Floats32, x: int, y: int, beam: int, count: int, theta: np.float32, beams: int
) -> None:
    """Set the row ``beam`` of ``ends`` to the beams, [0, beams), that point at rows (x, y)."""
    per_radian = np.float32(beams) / _TWO_PI
    turn = np.float32(beams)
    for index in range(count):
        dx, dy = ends[x, index], ends[y, index]
        ax, ay = abs(dx), abs(dy)
        ratio = min(ax, ay) / max(max(ax, ay), _TINY)
        square = ratio * ratio
        angle = _C8 * square + _C7
        angle = angle * square + _C6
        angle = angle * square + _C5
        angle = angle * square + _C4
        angle = angle * square + _C3
        angle = angle * square + _C2
        angle = angle * square + _C1
        angle = (angle * square + _C0) * ratio
        angle = _HALF_PI - angle if ay > ax else angle
        angle = _PI - angle if dx < np.float32(0.0) else angle
        angle = -angle if dy < np.float32(0.0) else angle
        place = (angle - theta) * per_radian
        place = place + turn if place < np.float32(0.0) else place
        place = place + turn if place < np.float32(0.0) else place
        ends[beam, index] = place


@any_order_part
def gather(
    buffers: ScanBuffers,
    edges: Rows,
    first: int,
    last: int,
    facing: int,
    x: np.float32,
    y: np.float32,
    count: int,
) -> int:
    """Collect the edges of one facing that look at the robot, from number ``count`` on.

    Returns the new count.
    """
    ends = buffers.ends
    faces_up = facing % 2 == 0
    across, along = (y, x) if facing < 2 else (x, y)
    # Sorted by place: those that look at the robot come first, or last.
    step = 1 if faces_up else -1
    index = first if faces_up else last - 1
    while first <= index < last:
        distance = edges[index].line - across
        if (distance >= np.float32(0.0)) if faces_up else (distance <= np.float32(0.0)):
            break
        low, high = edges[index].low - along, edges[index].high - along
        right, left = (low, high) if facing == 0 or facing == 3 else (high, low)
        ends[FACTOR, count] = distance
        if facing < 2:
            ends[X_RIGHT, count], ends[Y_RIGHT, count] = right, distance
            ends[X_LEFT, count], ends[Y_LEFT, count] = left, distance
        else:
            ends[X_RIGHT, count], ends[Y_RIGHT, count] = distance, right
            ends[X_LEFT, count], ends[Y_LEFT, count] = distance, left
        buffers.items[count] = index
        count += 1
        index += step
    return count


@any_order_part
def span_of(ends: Floats32, index: int, beams: np.float32) -> tuple[int, int]:
    """Return the first and last beam that meet a collected edge; no beam if last < first."""
    begin = ends[BEAM_RIGHT, index] - _SLACK
    end = ends[BEAM_LEFT, index] + _SLACK
    end = end + beams if end < begin else end
    return max(0, math.ceil(begin)), math.floor(end)


@any_order_part
def fold(fan: Floats32, beams: int) -> None:
    """Merge the depths of beams that come twice."""
    for beam in range(beams // 2 + LANES):
        both = max(fan[NEAREST, beam], fan[NEAREST, beams + beam])
        fan[NEAREST, beam] = both
        fan[NEAREST, beams + beam] = both


@any_order_part
def scan_tile(
    buffers: ScanBuffers,
    edges: Edges,
    tile: int,
    x: np.float32,
    y: np.float32,
    theta: np.float32,
) -> tuple[int, int, int]:
    """Put a tile's walls into the depth buffer; return where its collected portals begin and end.

    The portals that look at the robot stay collected: those that lie along x, then, from the
    second number on, along y; the third is their end.
    """
    ends, fan, starts = buffers.ends, buffers.fan, edges.starts
    count = along_x = walls = portals = 0
    for group in range(GROUPS):
        first, last = int(starts[tile, group]), int(starts[tile, group + 1])
        if first < last:
            count = gather(buffers, edges.items, first, last, group % FACINGS, x, y, count)
        along_x = count if group == 1 else along_x
        walls = count if group == 3 else walls
        portals = count if group == 5 else portals
    beams = buffers.rays.shape[1]
    padded = (count + LANES - 1) // LANES * LANES
    point_beams(ends, X_RIGHT, Y_RIGHT, BEAM_RIGHT, padded, theta, beams)
    point_beams(ends, X_LEFT, Y_LEFT, BEAM_LEFT, padded, theta, beams)
    for index in range(padded):
        ends[FACTOR, index] = np.float32(1.0) / ends[FACTOR, index]
    for index in range(walls):
        begin, end = span_of(ends, index, np.float32(beams))
        raise_span(fan, SINE if index < along_x else COSINE, begin, end, ends[FACTOR, index])
    return walls, portals, count


@any_order_part
def follow_portals(
    buffers: ScanBuffers,
    edges: Rows,
    collected: tuple[int, int, int],
    base: int,
    queued: int,
) -> int:
    """Queue the tiles behind collected portals through which a beam shines; return their number."""
    beams = buffers.rays.shape[1]
    fold(buffers.fan, beams)
    begin, along_y, end = collected
    for index in range(begin, end):
        tile = int(edges[buffers.items[index]].leads_to)
        if buffers.tiles[0, base + tile] == buffers.scans[0]:
            continue
        first, last = span_of(buffers.ends, index, np.float32(beams))
        table = SINE if index < along_y else COSINE
        # A beam more to either side: better a tile too many than a beam that ends nowhere.
        if shows_through(
            buffers.fan, table, max(0, first - 1), last + 1, buffers.ends[FACTOR, index]
        ):
            buffers.tiles[0, base + tile] = buffers.scans[0]
            buffers.tiles[1, queued] = tile
            queued += 1
    return queued


@any_order_part
def off_lines(place: np.float32, resolution: float, cells: int) -> np.float32:
    """Return a place along an axis of ``cells`` cells, moved off the lines between them."""
    cell = min(max(math.floor(place / resolution), 0), cells - 1)
    off = _OFF_LINE * (1.0 + place)
    return np.float32(min(max(place, cell * resolution + off), (cell + 1) * resolution - off))


@any_order_part
def scan_walls(
    buffers: ScanBuffers, edges: Edges, home: Row, x: np.float32, y: np.float32, theta: np.float32
) -> None:
    """Put all walls that can be seen into the depth buffer."""
    x = off_lines(x, home.resolution, home.columns)
    y = off_lines(y, home.resolution, home.rows)
    base = home.tiles_at
    tiles = buffers.tiles
    buffers.scans[0] += 1
    tile = int(y / home.tile_size) * home.tile_columns + int(x / home.tile_size)
    tiles[0, base + tile] = buffers.scans[0]
    tiles[1, 0] = tile
    done, queued = 0, 1
    while done < queued:
        collected = scan_tile(buffers, edges, base + tiles[1, done], x, y, theta)
        done += 1
        if collected[2] > collected[0]:
            queued = follow_portals(buffers, edges.items, collected, base, queued)


@any_order_part
def span_between(
    beams: int, x0: float, y0: float, x1: float, y1: float, theta: np.float32
) -> tuple[int, int]:
    """Return the first and last beam between two directions, counter-clockwise."""
    per_radian = beams / (2.0 * math.pi)
    begin = (math.atan2(y0, x0) - theta) * per_radian - _SLACK
    end = (math.atan2(y1, x1) - theta) * per_radian + _SLACK
    begin -= beams * math.floor(begin / beams)
    end -= beams * math.floor(end / beams)
    if end < begin:
        end += beams
    return math.ceil(begin), math.floor(end)


@any_order_part
def scan_segment(
    fan: Floats32, beams: int, x0: float, y0: float, x1: float, y1: float, theta: np.float32
) -> None:
    """Put one straight segment, as seen from the robot, into the depth buffer.

    The robot sees the segment only if its first end is on the right.
    """
    turned = x0 * y1 - x1 * y0
    if turned < 1e-9:
        return
    along, across = np.float32((y1 - y0) / turned), np.float32((x0 - x1) / turned)
    first, last = span_between(beams, x0, y0, x1, y1, theta)
    for beam in range(first, last + 1):
        wall = along * fan[COSINE, beam] + across * fan[SINE, beam]
        fan[NEAREST, beam] = max(fan[NEAREST, beam], wall)


@any_order_part
def scan_disc(
    fan: Floats32, beams: int, x: float, y: float, radius: float, theta: np.float32
) -> None:
    """Put a disc, its middle as seen from the robot, into the depth buffer; not from inside it."""
    square = x * x + y * y - radius * radius
    if square <= 0.0:
        return
    # The tangents: the way to the middle, turned to either side.
    cosine, sine = math.sqrt(square), radius
    first, last = span_between(
        beams,
        cosine * x + sine * y,
        cosine * y - sine * x,
        cosine * x - sine * y,
        cosine * y + sine * x,
        theta,
    )
    for beam in range(first, last + 1):
        ahead = x * fan[COSINE, beam] + y * fan[SINE, beam]
        depth = max(0.0, ahead * ahead - square)
        inverse = np.float32(1.0 / (ahead - math.sqrt(depth)))
        fan[NEAREST, beam] = max(fan[NEAREST, beam], inverse)


@any_order_part
def end_scan(fan: Floats32, ranges: Floats32, row: int, min_range: float, max_range: float) -> None:
    """Write the ranges, m: inf if nothing is within reach, -inf nearer than the least (REP 117)."""
    fold(fan, ranges.shape[1])
    least, most = np.float32(1.0 / max_range), np.float32(1.0 / min_range)
    for beam in range(ranges.shape[1]):
        inverse = fan[NEAREST, beam]
        distance = np.float32(1.0) / inverse
        distance = np.float32(math.inf) if inverse <= least else distance
        ranges[row, beam] = np.float32(-math.inf) if inverse > most else distance
