"""Layers of the floor, put together from the tiles that a page's server sends."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

_LENGTH: Final = struct.Struct("<I")
_MOST_CELLS: Final = 20_000_000
"""No map of the robot has more."""


@dataclass(slots=True, eq=False)
class Grid:
    """Cells of a layer, uint8 [rows, columns], row 0 at the lowest y; m, map frame."""

    resolution: float
    origin_x: float
    origin_y: float
    cells: NDArray[np.uint8]

    def centres(self, chosen: NDArray[np.bool_]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return x and y of the chosen cells' middles, m; ``chosen`` has the shape of the cells."""
        rows, columns = np.nonzero(chosen)
        x = self.origin_x + (columns + 0.5) * self.resolution
        return x, self.origin_y + (rows + 0.5) * self.resolution


def take_tiles(grids: dict[str, Grid], packet: bytes) -> None:
    """Put the tiles of a packet into the layer that it names; raises ValueError for a broken one.

    The form is that of :meth:`roomba.ui.web.tiles.TiledLayer.since`.
    """
    try:
        (length,) = _LENGTH.unpack_from(packet)
        header = json.loads(packet[_LENGTH.size : _LENGTH.size + length])
        name, shape = str(header["layer"]), (int(header["rows"]), int(header["columns"]))
        if min(shape) < 1 or shape[0] * shape[1] > _MOST_CELLS:
            raise ValueError(f"a layer of {shape} cells")
        origin_x, origin_y = map(float, header["origin"])
        if header["whole"] or name not in grids:
            cells = np.zeros(shape, np.uint8)
            grids[name] = Grid(float(header["resolution"]), origin_x, origin_y, cells)
        cells, begin = grids[name].cells, _LENGTH.size + length
        for row, column, height, width in header["tiles"]:
            part = np.frombuffer(packet, np.uint8, height * width, begin)
            cells[row : row + height, column : column + width] = part.reshape(height, width)
            begin += height * width
    except (KeyError, TypeError, struct.error) as error:
        raise ValueError(f"expected tiles of a layer, got {error}") from error
