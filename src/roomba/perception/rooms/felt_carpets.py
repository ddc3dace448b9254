"""Carpets that the robot felt by its brush, place by place, over many cleans.

At each tick of a clean the cells below the tool get a vote for or against carpet. A carpet that was
taken away is voted down again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.compilation import entry
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.rooms.outlines import cells_inside, outline_of
from roomba.perception.rooms.zones import Corners
from roomba.raster.carried import carried

MOST_CARPETS: Final = 100
"""Carpets of one map; if there are more, the largest are kept."""
MOST_CORNERS: Final = 200
"""Corners of a carpet, as of a zone; one with more is replaced by the rectangle around it."""
CELL: Final = 0.10
"""m; side of a cell: half of the tool's width, and about the way that it takes to feel a floor."""
_BESIDE: Final = 0.05
"""m; along x and y, from the tool's middle to the places whose cells get its vote."""
_FELT: Final = 4
"""Votes for carpet, less those against, from which on a cell is carpet: half a pass at 0.3 m/s."""
_MOST: Final = 30
"""Limit of a cell's votes to either side: some passes, so that two or three cleans turn them."""
_LEAST_AREA: Final = 0.10
"""m2; a smaller area is a sill, or an error of the pose."""
_STAIR: Final = 0.06
"""m; tolerance of outlines, which drops the stairs that cells make of an edge."""


@dataclass(frozen=True, slots=True)
class FeltCarpets:
    """Outlines of carpets, the largest first, m, map frame."""

    all: tuple[Corners, ...] = ()


class CarpetVotes:
    """What the brush felt on the cells of a map."""

    def __init__(self, occupancy: OccupancyMap) -> None:
        """Begin with nothing felt."""
        self.frame = occupancy.frame.with_cells(CELL)
        self.votes: NDArray[np.int16] = np.zeros(self.frame.shape, np.int16)
        self._was_on = False
        self._is_told = True
        self._felt = FeltCarpets()

    def note(self, places: NDArray[np.float64], *, is_on: bool) -> None:
        """Vote at places of the tool, float64 [n, 2], m, which are all on carpet or all off it."""
        frame = self.frame
        _vote(self.votes, frame.origin_x, frame.origin_y, places, 1 if is_on else -1)
        if self._was_on and not is_on:
            # The tool left a carpet: what was felt of it is complete, and outlines are due.
            self._is_told = False
        self._was_on = is_on

    def recall(self, felt: FeltCarpets) -> None:
        """Restore the carpets that were felt before the program was started anew."""
        for corners in felt.all:
            self.votes[cells_inside(shapely.Polygon(corners), self.frame)] = _MOST
        self._felt, self._is_told = felt, True

    def carried_to(self, occupancy: OccupancyMap, moved: Pose) -> CarpetVotes:
        """Return the same votes over another map, in which this one's frame lies at ``moved``."""
        over = CarpetVotes(occupancy)
        over.votes = carried(self.votes, self.frame, over.frame, moved)
        over._is_told = False
        return over

    @property
    def felt(self) -> FeltCarpets:
        """The carpets that are known now; the same object as long as they do not change."""
        if not self._is_told:
            self._is_told = True
            felt = FeltCarpets(self._outlines())
            if felt != self._felt:
                self._felt = felt
        return self._felt

    def _outlines(self) -> tuple[Corners, ...]:
        mask = self.votes >= _FELT
        if not mask.any():
            return ()
        outline = outline_of(mask, self.frame)
        parts = outline.geoms if isinstance(outline, shapely.MultiPolygon) else (outline,)
        whole = [shapely.Polygon(part.exterior).simplify(_STAIR) for part in parts]
        large = [part for part in whole if part.area >= _LEAST_AREA]
        large.sort(key=lambda part: part.area, reverse=True)
        return tuple(_corners(part) for part in large[:MOST_CARPETS])


@entry
def _vote(
    votes: NDArray[np.int16],
    origin_x: float,
    origin_y: float,
    places: NDArray[np.float64],
    vote: int,
) -> None:
    """Add a vote to the cells below the tool at each place, up to :data:`_MOST` of either kind."""
    for number in range(len(places)):
        for dx in (-_BESIDE, _BESIDE):
            column = math.floor((places[number, 0] + dx - origin_x) / CELL)
            for dy in (-_BESIDE, _BESIDE):
                row = math.floor((places[number, 1] + dy - origin_y) / CELL)
                if 0 <= row < votes.shape[0] and 0 <= column < votes.shape[1]:
                    votes[row, column] = min(max(votes[row, column] + vote, -_MOST), _MOST)


def _corners(part: shapely.Polygon) -> Corners:
    """Return the corners of a carpet, to the mm."""
    corners = part.exterior.coords[:-1]
    if len(corners) > MOST_CORNERS:
        corners = part.envelope.exterior.coords[:-1]
    return tuple((round(float(x), 3), round(float(y), 3)) for x, y in corners)
