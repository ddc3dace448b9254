"""A viewer that applies differences has the layer, also when it missed some."""

from __future__ import annotations

import json
import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.client.view import GridLayer
from roomba.ui.web.tiles import TiledLayer

Cells = NDArray[np.uint8]


class Viewer:
    """Applies messages as the page does."""

    def __init__(self) -> None:
        self.version = 0
        self.cells: Cells = np.zeros((0, 0), np.uint8)
        self.taken = 0

    def take(self, message: bytes | None) -> None:
        if message is None:
            return
        (length,) = struct.unpack_from("<I", message)
        header = json.loads(message[4 : 4 + length])
        if header["whole"]:
            self.cells = np.zeros((header["rows"], header["columns"]), np.uint8)
        at = 4 + length
        for row, column, height, width in header["tiles"]:
            tile = np.frombuffer(message, np.uint8, height * width, at).reshape(height, width)
            self.cells[row : row + height, column : column + width] = tile
            at += height * width
        assert at == len(message)
        self.version = header["version"]
        self.taken += 1


def layer(cells: Cells, shape: int = 1) -> GridLayer:
    return GridLayer(shape, 0.05, -1.0, 2.0, cells.copy())


@given(
    sides=st.tuples(st.integers(1, 80), st.integers(1, 80)),
    changes=st.lists(
        st.tuples(st.integers(0, 79), st.integers(0, 79), st.integers(0, 255), st.booleans()),
        max_size=12,
    ),
)
def test_each_viewer_has_the_layer(
    sides: tuple[int, int], changes: list[tuple[int, int, int, bool]]
) -> None:
    cells = np.zeros(sides, np.uint8)
    tiled, always, seldom = TiledLayer("map"), Viewer(), Viewer()
    tiled.update(layer(cells))
    for row, column, value, looks in changes:
        cells[row % sides[0], column % sides[1]] = value
        tiled.update(layer(cells))
        always.take(tiled.since(always.version))
        if looks:
            seldom.take(tiled.since(seldom.version))
    for viewer in (always, seldom):
        viewer.take(tiled.since(viewer.version))
        assert np.array_equal(viewer.cells, cells)
        assert tiled.since(viewer.version) is None


def test_only_tiles_that_changed_are_sent() -> None:
    cells = np.zeros((320, 320), np.uint8)
    tiled = TiledLayer("coverage")
    tiled.update(layer(cells))
    cells[40, 40] = 1
    tiled.update(layer(cells))
    message = tiled.since(1)
    assert message is not None
    assert len(message) < 32 * 32 + 300


def test_nothing_is_sent_for_a_layer_that_stays() -> None:
    tiled = TiledLayer("map")
    assert tiled.since(0) is None
    tiled.update(layer(np.ones((5, 7), np.uint8)))
    viewer = Viewer()
    viewer.take(tiled.since(0))
    tiled.update(layer(np.ones((5, 7), np.uint8)))
    assert tiled.since(viewer.version) is None


def test_a_grid_that_lies_elsewhere_is_sent_whole() -> None:
    tiled, viewer = TiledLayer("map"), Viewer()
    tiled.update(layer(np.ones((40, 40), np.uint8)))
    viewer.take(tiled.since(0))
    tiled.update(layer(np.zeros((40, 40), np.uint8), shape=2))
    viewer.take(tiled.since(viewer.version))
    assert not viewer.cells.any()
    assert viewer.taken == 2
