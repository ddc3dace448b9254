"""The coverage map: the floor that was really swept, and what was left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.perception.swept.coverage_bits import SWEPT, WANTED
from roomba.perception.swept.coverage_kernels import sweep, swept_from
from roomba.raster.carried import carried
from roomba.raster.regions import numbered_regions

GRANTED: Final = 0.002
"""m; a cell counts as swept if the tool's rim comes as near as this to its middle. So two swaths
that touch along the middles of cells, each a millimetre off, leave no row of cells unswept."""


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """Connected floor: its ``area``, m2, its middle, m, and its cells as a mask."""

    area: float
    x: float
    y: float
    cells: Mask


class CoverageMap:
    """Which of the wanted floor the tool, a disc, passed over; cells are of ``frame``.

    ``cells`` is uint8 [rows, columns], bits of :mod:`.coverage_bits`.
    """

    def __init__(self, frame: GridFrame, wanted: Mask, tool_width: float) -> None:
        """Begin with nothing swept; ``wanted`` is bool over ``frame``."""
        if wanted.shape != frame.shape:
            raise ValueError(f"expected a mask of shape {frame.shape}, got {wanted.shape}")
        self.frame = frame
        self.radius = 0.5 * tool_width + GRANTED
        self.cells: NDArray[np.uint8] = np.where(wanted, np.uint8(WANTED), np.uint8(0))
        self.place = np.array([*frame.centre_of(0, 0), frame.resolution])
        self.wanted_cells = int(np.count_nonzero(wanted))
        self.swept_cells = 0
        self.at: tuple[float, float] | None = None

    def sweep(self, x: float, y: float) -> None:
        """Sweep the straight way of the robot from its last place to (x, y), m."""
        from_x, from_y = swept_from(*(self.at or (x, y)), x, y)
        self.swept_cells += sweep(self.cells, self.place, from_x, from_y, x, y, self.radius)
        self.at = (x, y)

    def resumed(self, swept: int, at: tuple[float, float]) -> None:
        """Go on after kernels swept ``swept`` more cells of the wanted floor, up to ``at``, m."""
        self.swept_cells += swept
        self.at = at

    def take_back(self, points: NDArray[np.float64]) -> None:
        """Mark floor along a way, float64 [n, 2], m, as not swept."""
        self.cells[self.along(points)] &= np.uint8(~SWEPT & 0xFF)
        self.count_again()

    def along(self, points: NDArray[np.float64]) -> Mask:
        """Return what the tool passes over along a way, float64 [n, 2], m: bool over ``frame``."""
        passed = np.zeros_like(self.cells)
        for (x, y), (to_x, to_y) in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
            sweep(passed, self.place, x, y, to_x, to_y, self.radius)
        return passed > 0

    def lift(self) -> None:
        """Interrupt the path: the next pose does not continue the last one."""
        self.at = None

    def carry(self, frame: GridFrame, moved: Pose) -> None:
        """Go on over the grid of another map; ``moved`` is where the old map's frame lies in it."""
        self.cells = carried(self.cells, self.frame, frame, moved)
        self.frame, self.at = frame, None
        self.place = np.array([*frame.centre_of(0, 0), frame.resolution])
        self.count_again()

    def count_again(self) -> None:
        """Count anew what is wanted and swept, after cells were changed."""
        wanted = (self.cells & WANTED) > 0
        self.wanted_cells = int(np.count_nonzero(wanted))
        self.swept_cells = int(np.count_nonzero(wanted & self.swept))

    @property
    def cell_area(self) -> float:
        """m2."""
        return self.frame.resolution**2

    @property
    def wanted_area(self) -> float:
        """m2."""
        return self.wanted_cells * self.cell_area

    @property
    def swept_area(self) -> float:
        """Area of the wanted floor that is swept, m2."""
        return self.swept_cells * self.cell_area

    @property
    def fraction(self) -> float:
        """Share of the wanted floor that is swept, 0..1; 1 if no floor is wanted."""
        return self.swept_cells / self.wanted_cells if self.wanted_cells else 1.0

    @property
    def wanted(self) -> Mask:
        """The cells that shall be cleaned."""
        return (self.cells & WANTED) > 0

    @property
    def swept(self) -> Mask:
        """The cells that the tool passed over, wanted or not."""
        return (self.cells & SWEPT) > 0

    @property
    def missed(self) -> Mask:
        """The cells that are wanted and were not swept."""
        missed: Mask = (self.cells & (WANTED | SWEPT)) == WANTED
        return missed

    def patches(self, least_area: float) -> list[Patch]:
        """Return what was missed, in patches of ``least_area`` m2 or more, the largest first."""
        return patches_of(self.missed, self.frame, least_area)


def patches_of(mask: Mask, frame: GridFrame, least_area: float) -> list[Patch]:
    """Return the regions of a mask of ``least_area`` m2 or more, the largest first."""
    labels = numbered_regions(mask)
    sizes = np.bincount(labels.ravel())
    cell = frame.resolution**2
    found = []
    for label in np.argsort(-sizes[1:], kind="stable") + 1:
        if sizes[label] * cell < least_area:
            break
        cells = labels == label
        rows, columns = np.nonzero(cells)
        # The cell nearest to the mean: the mean itself may lie outside of a bent patch.
        middle = np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2)
        x, y = frame.centre_of(int(rows[middle]), int(columns[middle]))
        found.append(Patch(float(sizes[label] * cell), x, y, cells))
    return found
