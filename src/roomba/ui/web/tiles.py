"""Sends layers as differences: a viewer gets the tiles that changed since its version.

Each tile remembers the version of its layer at which it last changed. So one layer serves any
number of viewers, each at a version of its own, and a slow viewer skips outdated states.
"""

from __future__ import annotations

import json
import struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.view import GridLayer

TILE: Final = 32
"""Cells; side of a tile."""


class TiledLayer:
    """One layer; ``version`` grows by one with each change. All calls are of one thread."""

    def __init__(self, name: str) -> None:
        """Begin empty."""
        self.name, self.version = name, 0
        self._layer: GridLayer | None = None
        self._changed: NDArray[np.int64] = np.zeros((0, 0), np.int64)
        self._began = 0
        self._packed: dict[int, bytes] = {}

    def update(self, layer: GridLayer) -> None:
        """Take the layer as it is now."""
        before = self._layer
        if layer is before:
            return
        if before is None or before.shape != layer.shape or before.cells.shape != layer.cells.shape:
            rows, columns = (-(-side // TILE) for side in layer.cells.shape)
            self.version += 1
            self._began = self.version
            self._changed = np.full((rows, columns), self.version)
        else:
            changed = _changed_tiles(before.cells, layer.cells)
            if not changed.any():
                return
            self.version += 1
            self._changed[changed] = self.version
        self._layer = layer
        self._packed.clear()

    def since(self, version: int) -> bytes | None:
        """Return the tiles that changed after a version, 0 for all; None if none did.

        A header's length (uint32, little endian), the header (JSON: ``layer``, ``version``,
        ``whole``, ``resolution``, ``origin``, ``rows``, ``columns``, ``tiles`` as row, column,
        height and width in cells), and the tiles' cells, a byte each, row by row.
        """
        layer = self._layer
        if layer is None or version >= self.version:
            return None
        if version not in self._packed:
            self._packed[version] = self._pack(layer, version)
        return self._packed[version]

    def _pack(self, layer: GridLayer, version: int) -> bytes:
        is_whole = version < self._began
        chosen = np.argwhere(self._changed > (0 if is_whole else version))
        tiles, parts = [], []
        for row, column in chosen.tolist():
            cells = layer.cells[row * TILE : (row + 1) * TILE, column * TILE : (column + 1) * TILE]
            tiles.append([row * TILE, column * TILE, *cells.shape])
            parts.append(cells.tobytes())
        rows, columns = layer.cells.shape
        header = {
            "layer": self.name,
            "version": self.version,
            "whole": is_whole,
            "resolution": layer.resolution,
            "origin": [layer.origin_x, layer.origin_y],
            "rows": rows,
            "columns": columns,
            "tiles": tiles,
        }
        text = json.dumps(header, separators=(",", ":")).encode()
        return b"".join((struct.pack("<I", len(text)), text, *parts))


def _changed_tiles(before: NDArray[np.uint8], now: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return which tiles differ, bool [rows of tiles, columns of tiles]."""
    rows, columns = now.shape
    different = before != now
    by_row = np.logical_or.reduceat(different, np.arange(0, rows, TILE), axis=0)
    changed: NDArray[np.bool_] = np.logical_or.reduceat(by_row, np.arange(0, columns, TILE), axis=1)
    return changed
