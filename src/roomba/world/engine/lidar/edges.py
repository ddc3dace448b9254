"""The walls of a grid as straight edges, sorted for the lidar.

An edge is where solid cells end: it lies along an axis and is seen from its free side only. Homes
with many edges are cut into square tiles; where free floor goes on from one tile to the next is a
portal, which is an edge that one can see through.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.world.engine.state.arrays import EDGE, Rows

ONE_TILE_EDGES: Final = 600
"""A home with no more edges is one tile: looking through portals would take longer."""
TILE: Final = 4.0
"""m; side of a tile of other homes."""

FACINGS: Final = 4
"""North (seen from larger y), south, east (seen from larger x), west: the order in a tile."""
GROUPS: Final = 2 * FACINGS
"""Groups of a tile: the edges by facing, then the portals by facing."""


@dataclass(frozen=True, slots=True, eq=False)
class LidarEdges:
    """The edges of one home, in m from the lower left corner of its grid.

    ``items`` is EDGE [items]: walls and portals. ``starts`` int32 [tiles, GROUPS + 1]: where each
    group of a tile begins; within it edges are sorted by place. ``tile_cells``: cells of a tile's
    side; tiles are counted row by row, ``tile_columns`` in one.
    """

    items: Rows
    starts: NDArray[np.int32]
    tile_cells: int
    tile_columns: int

    @property
    def count(self) -> int:
        """Number of walls' edges."""
        return int(np.count_nonzero(self.items["leads_to"] < 0))


def lidar_edges(
    solid: NDArray[np.bool_], resolution: float, tile: float | None = None
) -> LidarEdges:
    """Return the edges of what is solid, bool [rows, columns]; all outside is solid.

    ``tile``: side of a tile, m; by default as the constants of this module say.
    """
    whole = max(solid.shape)
    if tile is None:
        items = _items(solid, whole)
        if len(items) <= ONE_TILE_EDGES:
            return _sorted(items, solid.shape, whole, resolution)
        tile = TILE
    cells = min(whole, max(1, round(tile / resolution)))
    return _sorted(_items(solid, cells), solid.shape, cells, resolution)


_TILE, _GROUP, _LINE, _LOW, _HIGH, _LEADS_TO = range(6)


def _items(solid: NDArray[np.bool_], tile: int) -> NDArray[np.int64]:
    """Return rows of tile, group, line, low, high (cells) and the tile led to, int64 [items, 6]."""
    columns = -(-solid.shape[1] // tile)
    along_x = _boundaries(solid, tile)
    along_y = _boundaries(solid.T, tile)
    parts = []
    for facing, line, low, high, is_portal in along_x:
        here = (line - (facing == 1)) // tile * columns + low // tile
        there = np.where(is_portal, here + (columns if facing == 1 else -columns), -1)
        parts.append((here, facing + FACINGS * is_portal, line, low, high, there))
    for facing, line, low, high, is_portal in along_y:
        here = low // tile * columns + (line - (facing == 1)) // tile
        there = np.where(is_portal, here + (1 if facing == 1 else -1), -1)
        parts.append((here, 2 + facing + FACINGS * is_portal, line, low, high, there))
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _boundaries(
    solid: NDArray[np.bool_], tile: int
) -> list[tuple[int, NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]]:
    """Return runs of cell boundaries along the rows: facing 0 (free side at larger row) or 1.

    Each run comes with its line, both ends, and whether it is a portal between two tiles; runs end
    at the borders of tiles.
    """
    padded = np.pad(solid, 1, constant_values=True)[:, 1:-1]
    below, above = padded[:-1], padded[1:]
    border = (np.arange(below.shape[0]) % tile == 0)[:, None]
    open_border = border & ~below & ~above
    found = []
    for facing, wall in ((0, below & ~above), (1, ~below & above)):
        for is_portal, mask in ((False, wall), (True, open_border)):
            line, low, high = _runs(mask, tile)
            found.append((facing, line, low, high, np.full(len(line), is_portal)))
    return found


def _runs(
    mask: NDArray[np.bool_], tile: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return row, first column and column after the last of each run of True, cut at tiles."""
    colours = mask * (1 + np.arange(mask.shape[1]) // tile % 2)
    padded = np.pad(colours, ((0, 0), (1, 1)))
    changes = padded[:, 1:] != padded[:, :-1]
    rows, begins = np.nonzero(changes & (padded[:, 1:] > 0))
    _, ends = np.nonzero(changes & (padded[:, :-1] > 0))
    return rows, begins, ends


def _sorted(
    items: NDArray[np.int64], shape: tuple[int, ...], tile: int, resolution: float
) -> LidarEdges:
    rows, columns = (-(-size // tile) for size in shape)
    items = items[np.lexsort((items[:, _LINE], items[:, _GROUP], items[:, _TILE]))]
    group = items[:, _TILE] * GROUPS + items[:, _GROUP]
    bounds = np.searchsorted(group, np.arange(rows * columns * GROUPS + 1))
    firsts = bounds[:-1].reshape(-1, GROUPS)
    edges = np.zeros(len(items), EDGE)
    for name, column in (("line", _LINE), ("low", _LOW), ("high", _HIGH)):
        edges[name] = items[:, column] * resolution
    edges["leads_to"] = items[:, _LEADS_TO]
    return LidarEdges(
        items=edges,
        starts=np.hstack([firsts, bounds[GROUPS::GROUPS, None]]).astype(np.int32),
        tile_cells=tile,
        tile_columns=columns,
    )
