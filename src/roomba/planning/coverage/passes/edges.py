"""Stage edges: ways along walls and furniture, as near to them as the middle may go.

Places in cells of the window: (x, y) is (column, row), whole numbers are the cells' centres.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats, Mask, Polyline
from roomba.compilation import allocating_entry
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.passes.contours import outlines, straightened
from roomba.planning.coverage.passes.solid_cells import SolidCells
from roomba.planning.coverage.passes.stairs import smooth_ways
from roomba.planning.coverage.passes.sweep import (
    Counts,
    left_without,
    room_for_legs,
    set_leg,
    sweep_leg,
)

_SIDEWAYS = 0.75
"""cells; how far an edge may be off the outline that it straightens."""
_ASLANT = 1.25
"""cells; the same if there are oblique walls: fine cells draw them with steps of one cell."""
_NEAR_CUT = 8
"""Points of an edge; within so many of where a piece would end, a roomier end is searched for."""
_STRETCH = 10.0
"""cells; edges are kept or left out by stretches of this length."""


def rings(
    middles: Mask, walls: SolidCells | None = None, *, is_aslant: bool = False
) -> list[Polyline]:
    """Return the outlines of ``middles``, bool [rows, columns], straightened; each is closed.

    With ``walls`` the outlines are smooth along slanted walls. ``is_aslant``: it is known where
    some of these walls are within their cells.
    """
    lines, sideways = [], _ASLANT if is_aslant else _SIDEWAYS
    for chain in outlines(middles):
        ring = np.concatenate((chain, chain[:1])).astype(np.float64)
        parts, at = [], 0
        for way in [] if walls is None else smooth_ways(ring, walls):
            straight = _straight(middles, ring[way.first : way.last + 1], sideways)
            if turning_of(way.points) < turning_of(straight):
                parts += [_straight(middles, ring[at : way.first + 1], sideways), way.points]
                at = way.last
        lines.append(np.concatenate((*parts, _straight(middles, ring[at:], sideways))))
    return lines


def turning_of(line: Polyline) -> float:
    """Return how much a line turns in all, rad."""
    ways = np.diff(line, axis=0)
    return float(np.abs(wrap_angles(np.diff(np.arctan2(ways[:, 1], ways[:, 0])))).sum())


def _straight(middles: Mask, chain: Polyline, sideways: float) -> Polyline:
    kept: Polyline = chain[straightened(middles, chain, sideways)]
    return kept


def edges(
    rings: list[Polyline],
    need: Mask,
    middles: Mask,
    radius: float,
    piece_length: float,
    config: CoverageConfig,
) -> list[Polyline]:
    """Return lines along the rings that together sweep the needed floor there.

    ``need`` and ``middles`` are bool [rows, columns]; ``radius`` is half the tool's width, cells.
    Lines are cut to pieces of about ``piece_length`` cells, so that a path can branch off at their
    ends. So an end has room all around, or is a cell of ``middles``.
    """
    counts = np.zeros(need.shape, np.int16)
    pieces: list[Polyline] = []
    for ring in rings:
        stretches = cut(ring, _STRETCH)
        worth = _claim(need, counts, stretches, radius, config.edge_worth)
        kept = _bridged(worth, config.edge_gap)
        pieces.extend(_joined(stretches, kept, piece_length, middles))
    return pieces


def cut(line: Polyline, spacing: float) -> Polyline:
    """Return the line with points added, so that neighbours are at most ``spacing`` apart."""
    legs = np.hypot(*np.diff(line, axis=0).T)
    parts = np.maximum(np.ceil(legs / spacing - 1e-9).astype(np.int64), 1)
    index = np.repeat(np.arange(len(legs)), parts)
    share = (np.arange(len(index)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[index]
    points = line[index] + share[:, None] * (line[index + 1] - line[index])
    return np.concatenate((points, line[-1:]))


@allocating_entry
def _claim(
    need: Mask, counts: Counts, stretches: Polyline, radius: float, least: float
) -> NDArray[np.bool_]:
    """Return which legs sweep more than ``least`` new cells per cell of way, bool [n - 1].

    The cells that these sweep are added to ``counts``.
    """
    worth = np.zeros(len(stretches) - 1, np.bool_)
    legs = room_for_legs()
    for leg in range(len(worth)):
        x, y = stretches[leg]
        to_x, to_y = stretches[leg + 1]
        set_leg(legs, 0, x, y, to_x, to_y)
        found = -left_without(need, counts, legs, 0, 1, radius, np.inf)
        if found > least * np.hypot(to_x - x, to_y - y):
            worth[leg] = True
            sweep_leg(counts, x, y, to_x, to_y, radius, 1)
    return worth


def _bridged(worth: NDArray[np.bool_], gap: int) -> NDArray[np.bool_]:
    """Return ``worth`` with gaps of up to ``gap`` between true legs closed."""
    bridged = worth.copy()
    true = np.flatnonzero(worth)
    for first, last in pairwise(true):
        if last - first <= gap:
            bridged[first:last] = True
    return bridged


def _joined(
    stretches: Polyline, kept: NDArray[np.bool_], piece_length: float, middles: Mask
) -> list[Polyline]:
    """Return the kept legs joined to pieces of about a length."""
    pieces: list[Polyline] = []
    runs = np.flatnonzero(np.diff(np.concatenate(([False], kept, [False])).astype(np.int8)))
    for first, last in runs.reshape(-1, 2):
        run = stretches[first : last + 1].copy()
        stations = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(run, axis=0).T))))
        count = max(1, round(stations[-1] / piece_length))
        cuts = np.searchsorted(stations, np.linspace(0.0, stations[-1], count + 1))
        cuts[-1] = len(run) - 1
        cuts[1:-1] = [_roomy(run, int(at), middles) for at in cuts[1:-1]]
        for at in cuts:
            run[at] = _seat(run[at], middles)
        pieces.extend(run[begin : end + 1] for begin, end in pairwise(cuts) if end > begin)
    return pieces


def _roomy(run: Polyline, at: int, middles: Mask) -> int:
    """Return the index of the point of a line nearest to ``at`` with room all around."""
    for step in range(_NEAR_CUT):
        for other in (at - step, at + step):
            if 0 < other < len(run) - 1 and _has_room(run[other], middles):
                return other
    return at


def _has_room(place: Floats, middles: Mask) -> bool:
    x, y = place.tolist()
    has_room: bool = way_fits(middles, x, y, x, y)
    return has_room


def _seat(place: Floats, middles: Mask) -> Floats:
    """Return a place if it has room all around, else the nearest cell that fits, float64 [2]."""
    if _has_room(place, middles):
        return place
    cells = np.floor(place) + np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    column, row = cells.astype(np.int64).T
    fitting = cells[middles[row, column]]
    if len(fitting) == 0:
        return place
    nearest = int(np.argmin(np.hypot(*(fitting - place).T)))
    seat: Floats = fitting[nearest]
    return seat
