"""Dirt on the floor, counted in whole micrograms so that nothing is ever lost to rounding.

Floor plus bin equals what was brought in, to the last microgram.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba.world.home.home import Home

MICROGRAMS_PER_GRAM: Final = 1_000_000
FINEST_NEEDED: Final = 0.05
"""m; the dirt's cells are not coarser than twice this, however coarse the home's map."""
FULL_CELL: Final = 2_000_000_000
_SPREAD: Final = 3.0
"""Dirt falls within so many standard deviations of its source."""


class DirtField:
    """Dirt by cells of the floor: ``micrograms`` is int32 [rows, columns] over ``frame``."""

    def __init__(
        self,
        frame: GridFrame,
        solid: NDArray[np.bool_],
        micrograms: NDArray[np.int32] | None = None,
    ) -> None:
        """Lay a field over a home's grid; ``solid`` cells hold no dirt.

        ``micrograms``, if given, is the memory of all its cells, in any shape; else it is clean.
        """
        fineness = max(1, math.floor(frame.resolution / FINEST_NEEDED / 2.0 + 1e-9))
        self.frame = GridFrame(
            frame.resolution / fineness,
            frame.origin_x,
            frame.origin_y,
            frame.rows * fineness,
            frame.columns * fineness,
        )
        self.floor = np.repeat(np.repeat(~solid, fineness, axis=0), fineness, axis=1)
        if micrograms is None:
            micrograms = np.zeros(self.frame.shape, np.int32)
        self.micrograms: NDArray[np.int32] = micrograms.reshape(self.frame.shape)
        self.place = np.array(
            [self.frame.resolution, self.frame.origin_x, self.frame.origin_y], np.float64
        )

    @classmethod
    def of(cls, home: Home, micrograms: NDArray[np.int32] | None = None) -> DirtField:
        """Lay a field over the floor of a home.

        On its stairs, and on cells that a wall free of the grid touches, lies nothing.
        """
        return cls(home.frame, home.blocked, micrograms)

    @property
    def total(self) -> int:
        """Micrograms on the whole floor."""
        return int(self.micrograms.sum(dtype=np.int64))

    @property
    def density(self) -> NDArray[np.float32]:
        """The field in g/m2, float32 [rows, columns]."""
        per_cell = MICROGRAMS_PER_GRAM * self.frame.resolution**2
        return (self.micrograms / per_cell).astype(np.float32)

    def spread(self, x: float, y: float, radius: float, grams: float) -> int:
        """Let ``grams`` fall around a point as a Gaussian of standard deviation ``radius``, m.

        It lies on free floor only. Returns the micrograms brought in.
        Raises ValueError for numbers that make no sense, for a place without floor and for more
        than a cell can hold.
        """
        if not all(math.isfinite(value) for value in (x, y, radius, grams)):
            raise ValueError(
                f"expected finite numbers, got x={x} y={y} radius={radius} grams={grams}"
            )
        if radius <= 0.0 or grams < 0.0:
            raise ValueError(
                f"expected a radius above 0 m and an amount of 0 g or more, got {radius}, {grams}"
            )
        window = self._window(x, y, max(_SPREAD * radius, self.frame.resolution))
        weights = self._weights(window, x, y, radius)
        total = round(grams * MICROGRAMS_PER_GRAM)
        if total > FULL_CELL * weights.size:
            raise ValueError(f"{grams} g are more than the floor within {_SPREAD * radius} m holds")
        shares = _in_whole_parts(weights, total)
        patch = self.micrograms[window]
        if shares.max(initial=0) + int(patch.max(initial=0)) > FULL_CELL:
            raise ValueError(
                f"{grams} g within {radius} m are more than the floor holds; spread it wider"
            )
        patch += shares.astype(np.int32)
        return total

    def _window(self, x: float, y: float, reach: float) -> tuple[slice, slice]:
        low_row, low_column = self.frame.cell_of(x - reach, y - reach)
        high_row, high_column = self.frame.cell_of(x + reach, y + reach)
        return (
            slice(max(0, low_row), max(0, high_row + 1)),
            slice(max(0, low_column), max(0, high_column + 1)),
        )

    def _weights(
        self, window: tuple[slice, slice], x: float, y: float, radius: float
    ) -> NDArray[np.float64]:
        floor = self.floor[window]
        rows = np.arange(window[0].start, window[0].start + floor.shape[0])
        columns = np.arange(window[1].start, window[1].start + floor.shape[1])
        centres_x, centres_y = self.frame.centres(rows, columns)
        squared = (centres_y[:, None] - y) ** 2 + (centres_x[None, :] - x) ** 2
        weights: NDArray[np.float64] = np.exp(-0.5 * squared / radius**2) * floor
        if weights.sum() <= 0.0:
            raise ValueError(
                f"no floor within {_SPREAD * radius:.2f} m of ({x:.2f}, {y:.2f}); "
                "choose a point on the floor of the home"
            )
        return weights


def _in_whole_parts(weights: NDArray[np.float64], total: int) -> NDArray[np.int64]:
    """Share ``total`` by weight in whole numbers whose sum is exactly ``total``."""
    bounds = np.floor(np.cumsum(weights.ravel()) / weights.sum() * total)
    last = int(np.flatnonzero(weights.ravel())[-1])
    bounds[last:] = total
    return np.diff(bounds, prepend=0.0).astype(np.int64).reshape(weights.shape)
