"""Tiles from the page's server are put together to the server's layer."""

import numpy as np
import pytest

from roomba.client.view import GridLayer
from roomba.ui.top.grids import Grid, take_tiles
from roomba.ui.web.tiles import TiledLayer


def layer(cells: "np.ndarray[tuple[int, int], np.dtype[np.uint8]]", shape: int = 1) -> GridLayer:
    return GridLayer(shape, 0.05, -1.0, 2.0, cells)


def test_changes_are_put_into_what_there_is() -> None:
    generator = np.random.default_rng(1)
    cells = generator.integers(0, 3, (70, 45)).astype(np.uint8)
    tiled, grids, version = TiledLayer("map"), dict[str, Grid](), 0
    for _ in range(5):
        tiled.update(layer(cells.copy()))
        packet = tiled.since(version)
        assert packet is not None
        take_tiles(grids, packet)
        version = tiled.version
        assert np.array_equal(grids["map"].cells, cells)
        cells[generator.integers(70), generator.integers(45)] += 1
    tiled.update(layer(cells[:30], shape=2))
    packet = tiled.since(version)
    assert packet is not None
    take_tiles(grids, packet)
    assert np.array_equal(grids["map"].cells, cells[:30])
    x, y = grids["map"].centres(np.arange(30 * 45).reshape(30, 45) == 46)
    assert (x.tolist(), y.tolist()) == ([pytest.approx(-0.925)], [pytest.approx(2.075)])


@pytest.mark.parametrize(
    "packet", [b"", b"\x05\0\0\0{}", b"\x02\0\0\0{}", b'\x0c\0\0\0{"layer": 1}']
)
def test_what_is_broken_is_refused(packet: bytes) -> None:
    with pytest.raises(ValueError, match=r"expected|Expecting|Extra"):
        take_tiles({}, packet)
