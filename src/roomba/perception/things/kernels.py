"""Compiled evidence, cell by cell, of what the lidar sees and the map does not show.

A cell has *evidence*. A scan with beams that end in the cell adds evidence; a scan whose beams pass
through the cell, or end just behind it, takes evidence from it. A cell with enough evidence is a
*thing*. Cells with any evidence are listed, so that a walk over all of them costs by their number
and not by the size of the home.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry, inner_part
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.field_kernels import OFF_MAP, Field, Place, look
from roomba.perception.things.range_kernels import is_mixed, measure_noises, noise_at
from roomba.perception.things.state import Row, Things

Ranges = NDArray[np.float32]

IN: Final = 0
BEHIND: Final = 1
"""Columns of ``Things.beams``."""


class LidarPose(NamedTuple):
    """Where the lidar was at a scan, m and rad, map frame."""

    x: float
    y: float
    heading: float


@entry
def note(
    things: Things,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: Ranges,
    measured: Ranges,
    pose: Floats,
    unsure: float,
    scans: int,
) -> None:
    """Update the evidence by a scan, float32 [beams], m, from a known ``pose`` [3], map frame.

    ``unsure`` is the standard deviation of that position, m. ``ranges`` are as if all were measured
    at ``pose``, ``measured`` the original ones. The scan stands for ``scans`` scans, itself
    included. ``lidar.ends`` is a work array here.
    """
    layer = things.layer[0]
    layer.scan += 1
    measure_noises(things.noise, layer.scan, measured, lidar.nearest)
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    at = LidarPose(
        pose[0] + cosine * lidar.mount[0] - sine * lidar.mount[1],
        pose[1] + sine * lidar.mount[0] + cosine * lidar.mount[1],
        pose[2] + lidar.mount[2],
    )
    margin = layer.map_error * place[2] + unsure
    count = _find_ends(things, layer, field, place, lidar, ranges, at, margin)
    _count_in(things, layer, field, place, lidar.ends, count)
    _count_behind(things, layer, field, place, lidar.ends, count)
    if _weigh(things, layer, field, place, lidar, ranges, at, scans):
        layer.version += 1


@inner_part
def _find_ends(
    things: Things,
    layer: Row,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: Ranges,
    at: LidarPose,
    margin: float,
) -> int:
    """Fill ``lidar.ends`` with the ends of beams away from all surfaces; return how many.

    ``margin`` is how far a surface may be off, m. A row is an end's x, y, m, map frame, and how far
    the noise of its range reaches along the beam, as a vector x, y, m.
    """
    rows, columns = field.shape
    cosine, sine = math.cos(at.heading), math.sin(at.heading)
    inverse = 1.0 / place[2]
    around = round(2.0 * math.pi / abs(lidar.step))
    # A quick test: in a cell the distance exceeds that at its middle by half a diagonal at most.
    near = margin - 0.7072 * place[2]
    count = 0
    for beam in range(ranges.size):
        away = ranges[beam]
        if not lidar.nearest <= away < min(lidar.farthest, layer.farthest):
            continue
        along = cosine * lidar.directions[beam, 0] - sine * lidar.directions[beam, 1]
        across = sine * lidar.directions[beam, 0] + cosine * lidar.directions[beam, 1]
        end_x, end_y = at.x + away * along, at.y + away * across
        u, v = (end_x - place[0]) * inverse + 0.5, (end_y - place[1]) * inverse + 0.5
        if not (0.0 <= u < columns and 0.0 <= v < rows) or field[int(v), int(u)] <= near:
            continue
        off, _, _ = look(field, place, end_x, end_y)
        slack = layer.sure * noise_at(things.noise, away)
        if off <= margin + layer.margin_share * away + slack or off >= OFF_MAP:
            continue
        if is_mixed(ranges, beam, lidar.step, around, slack):
            continue
        ends = lidar.ends[count]
        ends[0], ends[1], ends[2], ends[3] = end_x, end_y, slack * along, slack * across
        count += 1
    return count


@inner_part
def _count_in(
    things: Things, layer: Row, field: Field, place: Place, ends: Floats, count: int
) -> None:
    """Count the beams that end in each cell, and list cells that are new."""
    for index in range(count):
        x, y = ends[index, 0], ends[index, 1]
        cell = _cell_of(field, place, x, y)
        if things.touched[cell] != layer.scan:
            if things.evidence[cell] == 0:
                if layer.count == things.listed.size:
                    continue
                things.listed[layer.count] = cell
                layer.count += 1
                things.spots[cell, 0], things.spots[cell, 1] = x, y
            things.touched[cell] = layer.scan
            things.beams[cell, IN], things.beams[cell, BEHIND] = 0, 0
            things.sums[cell, 0], things.sums[cell, 1] = 0.0, 0.0
        things.beams[cell, IN] += 1
        things.sums[cell, 0] += x - things.spots[cell, 0]
        things.sums[cell, 1] += y - things.spots[cell, 1]


@inner_part
def _count_behind(
    things: Things, layer: Row, field: Field, place: Place, ends: Floats, count: int
) -> None:
    """Note the listed cells that beams end closely behind, and count beams that may have met them.

    A beam may have met a cell if it ends no farther behind it than the noise of its range reaches.
    """
    half = 0.5 * place[2]
    for index in range(count):
        x, y, slack_x, slack_y = ends[index, 0], ends[index, 1], ends[index, 2], ends[index, 3]
        slack = math.sqrt(slack_x * slack_x + slack_y * slack_y)
        last = _cell_of(field, place, x, y)
        for step in range(1, math.ceil(max(layer.clearly, slack) / half) + 1):
            way = min(half * step, max(layer.clearly, slack))
            share = way / slack
            cell = _cell_of(field, place, x - share * slack_x, y - share * slack_y)
            if cell == last or cell < 0:
                continue
            last = cell
            if things.touched[cell] != layer.scan:
                if things.evidence[cell] == 0:
                    continue
                things.touched[cell] = layer.scan
                things.beams[cell, IN], things.beams[cell, BEHIND] = 0, 0
            things.beams[cell, BEHIND] += way < slack + half


@inner_part
def _cell_of(field: Field, place: Place, x: float, y: float) -> int:
    """Return the number of the cell at a point, m; -1 off the map."""
    rows, columns = field.shape
    u, v = (x - place[0]) / place[2] + 0.5, (y - place[1]) / place[2] + 0.5
    return int(v) * columns + int(u) if 0.0 <= u < columns and 0.0 <= v < rows else -1


@inner_part
def _weigh(
    things: Things,
    layer: Row,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: Ranges,
    at: LidarPose,
    scans: int,
) -> bool:
    """Add evidence to cells, and take it from them; tell whether a thing came or went."""
    columns = field.shape[1]
    beams = ranges.size
    first, step = at.heading + lidar.first_angle, lidar.step
    around = round(2.0 * math.pi / abs(step))
    half = 0.7072 * place[2]
    gain = min(layer.gain * scans, layer.most_gain)
    is_other = False
    # Backwards, as the last cell takes the place of one that is no longer listed.
    for number in range(layer.count - 1, -1, -1):
        cell = things.listed[number]
        before = things.evidence[cell]
        if things.touched[cell] == layer.scan:
            _move_spot(things, layer, cell)
            is_in = things.beams[cell, IN] >= max(things.beams[cell, BEHIND], 1)
            more = gain if is_in else -layer.behind * scans
        else:
            off_x = place[0] + (cell % columns) * place[2] - at.x
            off_y = place[1] + (cell // columns) * place[2] - at.y
            away = math.sqrt(off_x * off_x + off_y * off_y)
            if away > layer.farthest or away < half:
                continue
            middle = round((math.atan2(off_y, off_x) - first) / step)
            aside = int(half / (away * abs(step))) + 1
            if not _is_passed(ranges, beams, around, middle, aside, away + layer.clearly):
                continue
            more = -layer.loss * scans
        after = min(max(before + more, 0), layer.most)
        things.evidence[cell] = after
        is_other = is_other or (before < layer.enough) != (after < layer.enough)
        if after == 0:
            layer.count -= 1
            things.listed[number] = things.listed[layer.count]
    return is_other


@inner_part
def _move_spot(things: Things, layer: Row, cell: int) -> None:
    """Move a cell's spot towards the mean of this scan's beams, by their share of all that count.

    The beams of a scan are taken together, so that their order does not matter: the first ones of a
    sweep all meet one side of the thing.
    """
    ended = things.beams[cell, IN]
    if ended > 0:
        share = (1.0 - (1.0 - layer.newest) ** ended) / ended
        things.spots[cell, 0] += np.float32(share * things.sums[cell, 0])
        things.spots[cell, 1] += np.float32(share * things.sums[cell, 1])


@inner_part
def _is_passed(
    ranges: Ranges, beams: int, around: int, middle: int, aside: int, way: float
) -> bool:
    """Whether all beams around ``middle`` went farther than ``way``, m; those without echo do not
    count, but some must have one.
    """
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

    Only the part from ``first`` to ``last``, m along the path, is looked at; ``stations`` [n] tells
    where along the path each point is.
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
