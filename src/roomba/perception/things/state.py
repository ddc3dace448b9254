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
        ("version", "i8"),  # another one when a thing came or went
    ]
)
"""The numbers of :class:`roomba.perception.things.layer.ThingConfig`, and what changes."""


class Things(NamedTuple):
    """A layer as kernels know it.

    ``layer`` is LAYER [1]; ``evidence`` int16 and ``touched`` int64, the newest scan that ended in
    a cell, are [cells], row by row as the map's; ``beams`` int16 [cells, 2] counts those of that
    scan which ended in it, and just behind it; ``listed`` int64 [n] has the cells with evidence;
    ``spots`` float32 [cells, 2] is where in its cell the beams end, m, map frame: their mean, in
    which those of long ago count less; ``sums`` float32 [cells, 2] adds up how far those of that
    scan are from it along x and y, m; ``noise`` is NOISE [n], that of ranges of each half metre.
    """

    layer: NDArray[np.void]
    evidence: NDArray[np.int16]
    touched: NDArray[np.int64]
    beams: NDArray[np.int16]
    listed: NDArray[np.int64]
    spots: NDArray[np.float32]
    sums: NDArray[np.float32]
    noise: NDArray[np.void]
