"""Compiled evidence, cell by cell, of what the lidar sees and the map does not show.

A cell has *evidence*: beams that end in it add to it, beams that pass through it take from it, and
what has enough of it is a *thing*. Cells with any are listed, so that looking at all of them costs
by their number and not by the size of the home.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.field_kernels import OFF_MAP, Field, Place, look

Floats = NDArray[np.float64]
Row: TypeAlias = Any
"""One row of an array of a dtype below, in a kernel."""

LAYER: Final = np.dtype(
    [
        ("margin", "f8"),  # m
        ("margin_share", "f8"),  # of the range
        ("farthest", "f8"),  # m
        ("clearly", "f8"),  # m
        ("gain", "i8"),  # evidence
        ("most_gain", "i8"),
        ("loss", "i8"),
        ("most", "i8"),
        ("enough", "i8"),
        ("spot_radius", "f8"),  # m
        ("newest", "f8"),
        ("next_to", "f8"),  # m
        ("count", "i8"),  # cells that are listed
        ("scan", "i8"),  # number of the newest scan, from 1
        ("version", "i8"),  # another one when a thing came or went
    ]
)
"""The numbers of :class:`roomba.perception.things.layer.ThingConfig`, and what changes."""


class Things(NamedTuple):
    """A layer as kernels know it.

    ``layer`` is LAYER [1]; ``evidence`` int16 and ``touched`` int64, the newest scan that ended in
    a cell, are [cells], row by row as the map's; ``listed`` int64 [n] has the cells with evidence;
    ``spots`` float32 [cells, 2] is where in its cell the beams end, m, map frame: their mean.
    """

    layer: NDArray[np.void]
    evidence: NDArray[np.int16]
    touched: NDArray[np.int64]
    listed: NDArray[np.int64]
    spots: NDArray[np.float32]


@entry
def note(
    things: Things,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: NDArray[np.float32],
    count: int,
    pose: Floats,
    scans: int,
) -> None:
    """Take a scan, float32 [beams], m, that was taken at ``pose`` [3], map, which is known.

    ``lidar.ends`` has its ``count`` ends; it stands for so many ``scans``, its own included.
    """
    layer = things.layer[0]
    layer.scan += 1
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    x = pose[0] + cosine * lidar.mount[0] - sine * lidar.mount[1]
    y = pose[1] + sine * lidar.mount[0] + cosine * lidar.mount[1]
    has_changed = _add_ends(things, layer, field, place, lidar.ends, count, pose, x, y, scans)
    heading = pose[2] + lidar.mount[2] + lidar.first_angle
    if _take_seen_through(things, layer, field, place, ranges, x, y, heading, lidar.step, scans):
        has_changed = True
    if has_changed:
        layer.version += 1


@inner_part
def _add_ends(
    things: Things,
    layer: Row,
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    pose: Floats,
    x: float,
    y: float,
    scans: int,
) -> bool:
    """Add evidence where beams end away from all surfaces; tell whether a thing came."""
    rows, columns = field.shape
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    inverse = 1.0 / place[2]
    # From nowhere in a cell a surface is farther than from its middle by more than half its size.
    near = layer.margin - 0.7072 * place[2]
    gain = min(layer.gain * scans, layer.most_gain)
    has_come = False
    for index in range(count):
        end_x = pose[0] + cosine * ends[index, 0] - sine * ends[index, 1]
        end_y = pose[1] + sine * ends[index, 0] + cosine * ends[index, 1]
        u, v = (end_x - place[0]) * inverse + 0.5, (end_y - place[1]) * inverse + 0.5
        if not (0.0 <= u < columns and 0.0 <= v < rows):
            continue
        column, row = int(u), int(v)
        if field[row, column] <= near:
            continue
        away = math.sqrt((end_x - x) * (end_x - x) + (end_y - y) * (end_y - y))
        off, _, _ = look(field, place, end_x, end_y)
        if off <= layer.margin + layer.margin_share * away or off >= OFF_MAP:
            continue
        cell = row * columns + column
        if away > layer.farthest or things.touched[cell] == layer.scan:
            continue
        things.touched[cell] = layer.scan
        before = things.evidence[cell]
        if before == 0:
            if layer.count == things.listed.size:
                continue
            things.listed[layer.count] = cell
            layer.count += 1
            things.spots[cell, 0], things.spots[cell, 1] = end_x, end_y
        things.spots[cell, 0] += np.float32(layer.newest * (end_x - things.spots[cell, 0]))
        things.spots[cell, 1] += np.float32(layer.newest * (end_y - things.spots[cell, 1]))
        after = min(before + gain, layer.most)
        things.evidence[cell] = after
        has_come = has_come or before < layer.enough <= after
    return has_come


@inner_part
def _take_seen_through(
    things: Things,
    layer: Row,
    field: Field,
    place: Place,
    ranges: NDArray[np.float32],
    x: float,
    y: float,
    heading: float,
    step: float,
    scans: int,
) -> bool:
    """Take evidence from cells that all beams through them passed; tell whether a thing went.

    ``heading`` is that of beam 0, map; ``step`` the angle between beams, rad.
    """
    columns = field.shape[1]
    beams = ranges.size
    around = round(2.0 * math.pi / abs(step))
    half = 0.7072 * place[2]
    has_gone = False
    # From the last one, as the last one takes the place of one that is no longer listed.
    for number in range(layer.count - 1, -1, -1):
        cell = things.listed[number]
        if things.touched[cell] == layer.scan:
            continue
        off_x = place[0] + (cell % columns) * place[2] - x
        off_y = place[1] + (cell // columns) * place[2] - y
        away = math.sqrt(off_x * off_x + off_y * off_y)
        if away > layer.farthest or away < half:
            continue
        middle = round((math.atan2(off_y, off_x) - heading) / step)
        aside = int(half / (away * abs(step))) + 1
        if not _is_passed(ranges, beams, around, middle, aside, away + layer.clearly):
            continue
        before = things.evidence[cell]
        after = max(before - layer.loss * scans, 0)
        things.evidence[cell] = after
        has_gone = has_gone or after < layer.enough <= before
        if after == 0:
            layer.count -= 1
            things.listed[number] = things.listed[layer.count]
    return has_gone


@inner_part
def _is_passed(
    ranges: NDArray[np.float32], beams: int, around: int, middle: int, aside: int, way: float
) -> bool:
    """Whether all beams around one went farther; those that met nothing do not tell."""
    does_tell = False
    for number in range(middle - aside, middle + aside + 1):
        beam = number % around
        if beam >= beams or not math.isfinite(ranges[beam]):
            continue
        if ranges[beam] <= way:
            return False
        does_tell = True
    return does_tell


@entry
def first_blocked(
    things: Things,
    points: Floats,
    stations: Floats,
    first: float,
    last: float,
    radius: float,
) -> float:
    """Return where along a path, [n, 2], a thing is nearer than ``radius``, m; nan: nowhere.

    Between ``first`` and ``last``, m; ``stations`` [n] tells where along the path each point is.
    """
    layer = things.layer[0]
    nearest = math.inf
    reach = radius + layer.spot_radius
    for leg in range(stations.size - 1):
        if stations[leg + 1] < first or stations[leg] > min(last, nearest):
            continue
        length = stations[leg + 1] - stations[leg]
        along_x, along_y = points[leg + 1, 0] - points[leg, 0], points[leg + 1, 1] - points[leg, 1]
        if length > 0.0:
            along_x, along_y = along_x / length, along_y / length
        begin = max(first - stations[leg], 0.0)
        end = min(last - stations[leg], length)
        for number in range(layer.count):
            cell = things.listed[number]
            if things.evidence[cell] < layer.enough:
                continue
            off_x = things.spots[cell, 0] - points[leg, 0]
            off_y = things.spots[cell, 1] - points[leg, 1]
            across = off_x * along_y - off_y * along_x
            if abs(across) >= reach:
                continue
            ahead, half = off_x * along_x + off_y * along_y, math.sqrt(reach**2 - across**2)
            at = max(begin, ahead - half)
            if at < ahead + half and at <= end:
                nearest = min(nearest, stations[leg] + at)
    return nearest if nearest < math.inf else math.nan


@entry
def forget_around(things: Things, place: Place, columns: int, x: float, y: float, r: float) -> None:
    """Forget all cells whose middle is nearer than ``r`` to a point, m."""
    layer = things.layer[0]
    has_gone = False
    for number in range(layer.count - 1, -1, -1):
        cell = things.listed[number]
        off_x = place[0] + (cell % columns) * place[2] - x
        off_y = place[1] + (cell // columns) * place[2] - y
        if off_x * off_x + off_y * off_y >= r * r:
            continue
        has_gone = has_gone or things.evidence[cell] >= layer.enough
        things.evidence[cell] = 0
        layer.count -= 1
        things.listed[number] = things.listed[layer.count]
    if has_gone:
        layer.version += 1
