"""The paper around a drawn floor plan: a map shows it as floor, but it is no part of the home."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.geometry import Pose
from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.raster.regions import dilated, numbered_regions
from roomba.world.home.raster import largest_component, where_body_fits
from roomba.world.layers.definite_map import FENCE

LEAST_HOME: Final = 3.0
"""m² where the middle of a body fits; floor of this size that is not paper is the home."""
LEAST_SHARE: Final = 0.2
"""0..1; in a plan of little floor, this share of the largest floor is enough for the home."""
_MOST: Final = 0.5
"""0..1; if more than this of a picture's end is floor, it is paper: a map that was cut off within a
home has walls and unknown cells at its end as well."""

_ALONG: Final = 0.5
"""A floor is paper if it meets the end along this times the side of a square of its area: paper
around a home has four times that side and more, a gap in a home's wall a tenth."""


def paper_end(drawn: OccupancyMap, frame: GridFrame) -> Mask:
    """Return the end of the paper on which a map was ``drawn``, over the cells of ``frame``.

    That is in the same cells, and as wide as FENCE. Nothing where the map does not end in floor
    for the most part.
    """
    # A thin line may frame the paper.
    wide = math.ceil(FENCE / drawn.frame.resolution - 1e-9)
    end = np.ones(drawn.frame.shape, np.bool_)
    end[wide:-wide, wide:-wide] = False
    is_floor = drawn.values == FREE
    found = np.zeros(frame.shape, np.bool_)
    if is_floor[end].mean() <= _MOST:
        return found
    rows, columns = np.nonzero(end & is_floor)
    rows += round((drawn.frame.origin_y - frame.origin_y) / frame.resolution)
    columns += round((drawn.frame.origin_x - frame.origin_x) / frame.resolution)
    inside = (rows >= 0) & (rows < frame.rows) & (columns >= 0) & (columns < frame.columns)
    found[rows[inside], columns[inside]] = True
    return found


def off_paper(floor: Mask, end: Mask, reach: float, resolution: float) -> Mask:
    """Return the largest part of a floor that is no paper: see :func:`is_on_paper`.

    Where no such part is large enough for a home, the largest part of all is returned.
    """
    largest = largest_component(floor)
    if not end.any():
        return largest
    away = largest_component(floor & ~_papers(floor, end, reach, resolution))
    cells = np.count_nonzero(largest)
    least = min(LEAST_HOME / resolution**2, LEAST_SHARE * cells)
    return away if np.count_nonzero(away) >= max(least, 1.0) else largest


def paper_around(map: OccupancyMap, solid: Mask, radius: float, pose: Pose, end: Mask) -> Mask:
    """Return the floor that is paper around the home in which a docked robot is.

    Bool over the map's grid; see :func:`is_on_paper`. It is nothing of the floor that hangs
    together with the robot's, and nothing at all if that is on paper itself. What is ``solid`` lets
    no body through.
    """
    here = map.frame.cell_of(pose.x, pose.y)
    paper = np.zeros_like(end)
    if end.any():
        paper = _paper_where_body_fits(map.frame, solid, radius, end)
    if paper[here] or not paper.any():
        return np.zeros_like(end)
    floors = numbered_regions(map.values == FREE)
    is_paper = np.zeros(int(floors.max()) + 1, np.bool_)
    is_paper[floors[paper]] = True
    is_paper[[0, floors[here]]] = False
    return np.asarray(is_paper[floors])


def is_on_paper(frame: GridFrame, solid: Mask, radius: float, pose: Pose, end: Mask) -> bool:
    """Whether a body of ``radius``, m, stands on floor that reaches much of the paper's ``end``.

    A home that has a gap at the end, such as a corridor that is drawn open, is no paper.
    """
    if not end.any():
        return False
    row, column = frame.cell_of(pose.x, pose.y)
    return bool(_paper_where_body_fits(frame, solid, radius, end)[row, column])


def _paper_where_body_fits(frame: GridFrame, solid: Mask, radius: float, end: Mask) -> Mask:
    """Return where the middle of a body of ``radius``, m, may be on paper."""
    floor = where_body_fits(frame, solid, radius)
    return _papers(floor, end, radius + 2.0 * frame.resolution, frame.resolution)


def _papers(floor: Mask, end: Mask, reach: float, resolution: float) -> Mask:
    """Return the parts of a floor that come within ``reach``, m, of much of the ``end``."""
    parts = numbered_regions(floor)
    sizes = np.bincount(parts.ravel())
    by_end = np.where(_near(end, reach, resolution), parts, 0)
    wide = math.ceil(FENCE / resolution - 1e-9)
    around = math.ceil(reach / resolution)
    papers = []
    for number, window in _windows_of(by_end, around):
        met = _near(by_end[window] == number, reach, resolution) & end[window]
        if np.count_nonzero(met) / wide >= _ALONG * math.sqrt(sizes[number]):
            papers.append(number)
    return np.isin(parts, papers)


def _windows_of(numbers: NDArray[np.int32], around: int) -> list[tuple[int, tuple[slice, slice]]]:
    """Return each number but 0, with its rows and columns and so many cells ``around`` them."""
    cells = np.argwhere(numbers)
    cells = cells[np.argsort(numbers[tuple(cells.T)], kind="stable")]
    found, firsts = np.unique(numbers[tuple(cells.T)], return_index=True)
    windows = []
    for number, own in zip(found.tolist(), np.split(cells, firsts[1:]), strict=False):
        first, last = np.maximum(own.min(axis=0) - around, 0), own.max(axis=0) + around + 1
        windows.append((number, (slice(first[0], last[0]), slice(first[1], last[1]))))
    return windows


def _near(cells: Mask, reach: float, resolution: float) -> Mask:
    """Return what lies within ``reach``, m, of some cells."""
    most = math.ceil(reach / resolution)
    away = np.arange(-most, most + 1) * resolution
    return dilated(cells, np.hypot(away[:, None], away[None, :]) <= reach)
