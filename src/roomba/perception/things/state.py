"""The layer of things as kernels know it: its numbers, and its arrays."""

from __future__ import annotations

from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Row: TypeAlias = Any
"""One row of an array of a dtype below, in a kernel."""

LAYER: Final = np.dtype(
    [
        ("map_error", "f8"),  # cells
        ("margin_share", "f8"),  # of the range
        ("sure", "f8"),  # deviations of the noise
        ("farthest", "f8"),  # m
        ("clearly", "f8"),  # m
        ("gain", "i8"),  # evidence
        ("most_gain", "i8"),
        ("behind", "i8"),
        ("loss", "i8"),
        ("most", "i8"),
        ("enough", "i8"),
        ("spot_radius", "f8"),  # m
        ("newest", "f8"),
        ("next_to", "f8"),  # m
        ("count", "i8"),  # cells that are listed
        ("scan", "i8"),  # number of the newest scan, from 1
        ("version", "i8"),  # changes when a thing came or went
    ]
)
"""The numbers of :class:`roomba.perception.things.layer.ThingConfig`, and what changes."""


class Things(NamedTuple):
    """A layer as kernels know it.

    ``layer`` is LAYER [1]. The following arrays have a row for each cell, row by row as the map's:
    ``evidence`` int16 [cells]; ``touched`` int64 [cells], the number of the newest scan with beams
    that ended in the cell or just behind it; ``beams`` int16 [cells, 2], how many beams of that
    scan ended in the cell, and just behind it; ``spots`` float32 [cells, 2], the mean of the beams'
    ends in the cell, m, map frame, in which old beams count less; ``sums`` float32 [cells, 2], the
    offsets of that scan's ends from the spot, added up, along x and y, m. ``listed`` int64 [n] has
    the cells with evidence; ``noise`` is NOISE [n], that of ranges of each half metre.
    """

    layer: NDArray[np.void]
    evidence: NDArray[np.int16]
    touched: NDArray[np.int64]
    beams: NDArray[np.int16]
    listed: NDArray[np.int64]
    spots: NDArray[np.float32]
    sums: NDArray[np.float32]
    noise: NDArray[np.void]
