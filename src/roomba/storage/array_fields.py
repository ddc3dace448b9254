"""The arrays of a file, each checked for what it should be before it is used."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose

Arrays = Mapping[str, NDArray[Any]]


class ArrayFields:
    """The arrays of a file, each checked for its kind, its shape, and that all numbers are finite.

    All methods raise ValueError, or KeyError for an array that is not there.
    """

    def __init__(self, arrays: Arrays) -> None:
        self._arrays = arrays

    def floats(self, name: str, *shape: int, kind: type = np.float64) -> NDArray[Any]:
        """Return numbers of a shape, in which -1 is any length."""
        found = self._of(name, np.dtype(kind), shape)
        if not np.isfinite(found).all():
            raise ValueError(f"{name}: expected finite numbers, got others")
        return found

    def pose(self, name: str) -> Pose | None:
        """Return a pose; None for three NaN."""
        found = self._of(name, np.dtype(np.float64), (3,))
        if np.isnan(found).all():
            return None
        return Pose(*self.floats(name, 3).tolist())

    def counts(self, name: str, *shape: int) -> NDArray[np.int64]:
        """Return whole numbers of 0 or more."""
        found = self._of(name, np.dtype(np.int64), shape)
        if found.size and found.min() < 0:
            raise ValueError(f"{name}: expected 0 or more, got {found.min()}")
        return found

    def flags(self, name: str, *shape: int) -> NDArray[np.bool_]:
        """Return yes or no."""
        return self._of(name, np.dtype(np.bool_), shape)

    def has(self, name: str) -> bool:
        """Whether there is such an array: files of older programs lack some."""
        return name in self._arrays

    def text(self, name: str) -> str:
        """Return words."""
        found = self._arrays[name]
        if found.dtype.kind != "U" or found.shape:
            raise ValueError(f"{name}: expected words, got {found.dtype} {found.shape}")
        return str(found)

    def _of(self, name: str, kind: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any]:
        found = self._arrays[name]
        fits = len(found.shape) == len(shape) and all(
            wanted in (-1, length) for wanted, length in zip(shape, found.shape, strict=True)
        )
        if found.dtype != kind or not fits:
            raise ValueError(
                f"{name}: expected {kind} of shape {shape}, got {found.dtype} of {found.shape}"
            )
        return found
