"""Homes as maps of Valetudo: what is written is what its documents say, and comes back."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.valetudo.home import ValetudoError, ValetudoHome
from roomba.files.valetudo.reading import parse
from roomba.files.valetudo.writing import compose
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap


@st.composite
def homes(draw: st.DrawFn) -> ValetudoHome:
    rows, columns = draw(st.integers(2, 12)), draw(st.integers(2, 12))
    cells = draw(
        st.lists(
            st.sampled_from([FREE, OCCUPIED, UNKNOWN]),
            min_size=rows * columns,
            max_size=rows * columns,
        )
    )
    values = np.array(cells, np.int8).reshape(rows, columns)
    values[0, 0] = FREE
    pixel = draw(st.integers(1, 10))
    corner = [draw(st.integers(-2000, 2000)) * 0.01 for _ in range(2)]
    frame = GridFrame(pixel * 0.01, corner[0], corner[1], rows, columns)
    owners = np.array(
        draw(st.lists(st.integers(0, 3), min_size=rows * columns, max_size=rows * columns))
    ).reshape(rows, columns)
    rooms = [(f"room {n}", (owners == n) & (values == FREE)) for n in (1, 2, 3)]

    def point() -> tuple[float, float]:
        x, y = (draw(st.integers(0, 300)) * 0.01 for _ in range(2))
        return frame.origin_x + x, frame.origin_y + y

    degrees = draw(st.none() | st.integers(-179, 180))
    station = None if degrees is None else Pose(*point(), math.radians(degrees))
    return ValetudoHome(
        OccupancyMap(frame, values),
        tuple((name, mask) for name, mask in rooms if mask.any()),
        station,
        tuple(tuple(point() for _ in range(4)) for _ in range(draw(st.integers(0, 2)))),
        tuple(tuple(point() for _ in range(2)) for _ in range(draw(st.integers(0, 2)))),
    )


@given(homes())
def test_what_is_written_comes_back(home: ValetudoHome) -> None:
    again = parse(json.dumps(compose(home)))
    assert (again.occupancy.values == home.occupancy.values).all()
    assert again.occupancy.frame == home.occupancy.frame
    assert [name for name, _ in again.rooms] == [name for name, _ in home.rooms]
    for (_, mask), (_, before) in zip(again.rooms, home.rooms, strict=True):
        assert (mask == before).all()
    assert (again.station is None) == (home.station is None)
    if home.station is not None and again.station is not None:
        moved = home.station.inverse().compose(again.station)
        assert math.hypot(moved.x, moved.y) < 1e-6
        assert abs(math.remainder(moved.theta, 2.0 * math.pi)) < 1e-6
    for shapes, told in ((again.no_go, home.no_go), (again.walls, home.walls)):
        assert np.allclose(np.array(shapes).ravel(), np.array(told).ravel(), atol=1e-6)
    assert compose(again) == compose(home)


@given(homes())
def test_what_is_written_is_a_map_as_documented(home: ValetudoHome) -> None:
    """By the schemas ValetudoMap, MapLayer and MapEntity, and the class MapLayer."""
    told = compose(home)
    assert told["__class"] == "ValetudoMap"
    assert told["metaData"]["version"] == 2
    columns, rows = (told["size"][axis] // told["pixelSize"] for axis in ("x", "y"))
    seen: set[tuple[int, int]] = set()
    for layer in told["layers"]:
        assert layer["__class"] == "MapLayer"
        assert layer["type"] in ("floor", "wall", "segment")
        assert layer["pixels"] == []
        pixels = expanded(layer["compressedPixels"])
        assert pixels == sorted(pixels, key=lambda pixel: (pixel[1], pixel[0]))
        assert all(0 <= x < columns and 0 <= y < rows for x, y in pixels)
        assert not seen & set(pixels)
        seen |= set(pixels)
        assert layer["dimensions"] == dimensions(pixels)
        assert layer["metaData"]["area"] == len(pixels) * told["pixelSize"] ** 2
        assert (layer["type"] == "segment") == ("segmentId" in layer["metaData"])
    for entity in told["entities"]:
        assert entity["__class"] in ("PointMapEntity", "LineMapEntity", "PolygonMapEntity")
        assert len(entity["points"]) >= 2
        assert all(isinstance(value, int) for value in entity["points"])


def expanded(runs: list[int]) -> list[tuple[int, int]]:
    return [
        (x + step, y)
        for x, y, count in zip(runs[::3], runs[1::3], runs[2::3], strict=True)
        for step in range(count)
    ]


def dimensions(pixels: list[tuple[int, int]]) -> dict[str, Any]:
    """As Valetudo's own class counts them; its Math.round rounds halves up."""
    told: dict[str, Any] = {"pixelCount": len(pixels)}
    for axis, name in enumerate("xy"):
        values = [pixel[axis] for pixel in pixels]
        told[name] = {
            "min": min(values),
            "max": max(values),
            "mid": math.floor((min(values) + max(values)) / 2 + 0.5),
            "avg": math.floor(sum(values) / len(values) + 0.5),
        }
    return told


def test_cells_of_parts_of_a_cm_are_refused() -> None:
    frame = GridFrame(0.025, 0.0, 0.0, 1, 1)
    with pytest.raises(ValetudoError, match=r"whole cm, got 0\.025 m"):
        compose(ValetudoHome(OccupancyMap(frame, np.zeros((1, 1), np.int8))))
