"""Maps of Valetudo, of other programs too: what is read of them, and what is refused."""

from __future__ import annotations

import contextlib
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.files.valetudo.home import ValetudoError
from roomba.files.valetudo.reading import parse
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED

FOREIGN: dict[str, Any] = {
    "__class": "ValetudoMap",
    "metaData": {"version": 2, "nonce": "x"},
    "size": {"x": 1000, "y": 1000},
    "pixelSize": 5,
    "layers": [
        {"type": "floor", "metaData": {}, "compressedPixels": [100, 50, 20], "pixels": []},
        {
            "type": "segment",
            "metaData": {"segmentId": "17", "active": False},
            "compressedPixels": [100, 51, 10, 100, 52, 10],
        },
        {"type": "segment", "metaData": {"segmentId": 3, "name": "Bad"}, "pixels": [110, 52]},
        {"type": "wall", "metaData": {}, "compressedPixels": [100, 49, 20]},
    ],
    "entities": [
        {"type": "charger_location", "points": [525, 255], "metaData": {"angle": 90}},
        {"type": "no_go_area", "points": [510, 250, 520, 250, 520, 260, 510, 260]},
        {"type": "virtual_wall", "points": [500, 250, 500, 260], "metaData": {}},
        {"type": "path", "points": [1, 2, 3, 4]},
        {"type": "obstacle", "points": [7, 8], "metaData": {"label": "sock"}},
    ],
}


def test_a_map_of_another_program_begins_at_its_station() -> None:
    home = parse(json.dumps(FOREIGN))
    frame, values = home.occupancy.frame, home.occupancy.values
    # 20 x 4 pixels, and two cells around.
    assert (frame.rows, frame.columns) == (8, 24)
    assert not home.has_own_frame
    assert home.station == Pose(0.0, 0.0, 0.0)
    # The wall is above the floor: 6 cm above the charger is the row of y = 49.
    assert values[frame.cell_of(0.0, 0.07)] == OCCUPIED
    assert values[frame.cell_of(0.0, 0.03)] == FREE
    assert np.count_nonzero(values == FREE) == 41
    assert [name for name, _ in home.rooms] == ["Room 17", "Bad"]
    assert [int(np.count_nonzero(mask)) for _, mask in home.rooms] == [20, 1]
    assert np.allclose(home.no_go[0][0], (-0.15, 0.05))
    assert np.allclose(home.walls[0], [(-0.25, 0.05), (-0.25, -0.05)])


def test_layers_of_unknown_kinds_are_left_out_and_null_tells_nothing() -> None:
    layers = [{**layer, "metaData": layer["metaData"] or None} for layer in FOREIGN["layers"]]
    layers.append({"type": "carpet", "metaData": {"name": "Rug"}, "pixels": [999, 0]})
    entities = [{**FOREIGN["entities"][0], "metaData": None}, *FOREIGN["entities"][1:]]
    home = parse(changed(layers=layers, entities=entities))
    whole = parse(json.dumps(FOREIGN))
    assert np.array_equal(home.occupancy.values, whole.occupancy.values)
    assert [name for name, _ in home.rooms] == ["Room 17", "Bad"]


@pytest.mark.parametrize("points", [[1_000_000, 500], [500, -501]])
def test_a_charger_off_the_map_is_none(points: list[int]) -> None:
    far = {"__class": "PointMapEntity", "type": "charger_location", "points": points}
    home = parse(changed(entities=[far]))
    assert home.station is None
    assert home.occupancy.frame.columns == parse(json.dumps(FOREIGN)).occupancy.frame.columns


def test_rooms_of_one_name_are_told_apart() -> None:
    layers = [{**FOREIGN["layers"][1], "metaData": {"name": "Bad"}}, FOREIGN["layers"][2]]
    home = parse(json.dumps({**FOREIGN, "layers": layers}))
    assert [name for name, _ in home.rooms] == ["Bad", "Bad 2"]


def test_names_of_rooms_are_cleaned_and_rooms_stay_apart() -> None:
    told: list[tuple[str | None, str | None]] = [
        ("Kids\u00a0room", None),
        ("Kids\troom", None),
        ("\u200b", "8\n"),
        ("a" * 99, None),
        ("a" * 98, None),
        (None, "\u200b"),
    ]
    layers = [
        {**FOREIGN["layers"][1], "metaData": {"name": name, "segmentId": segment}}
        for name, segment in told
    ]
    names = [name for name, _ in parse(changed(layers=layers)).rooms]
    assert names == ["Kids room", "Kids room 2", "Room 8", "a" * 80, f"{'a' * 78} 2", "Room"]


SEAMS = """
WWWWWWWWWWWWWWWWWWWW
Waaa-bbbb--ccccccccW
Waaa-bbbb--cc-----cW
WaaaWbbbbW.cc-ccc-cW
Waa..-bbb...c-ccc-cW
Wa...bbbb...c-----cW
Wa...bbbb...cccccccW
WWWWWWWWWWWWWWWWWWWW
"""
"""Rooms, and no layer between: seams and a carpet's outline, -, and what is wider or at a wall."""


@pytest.mark.parametrize("turned", [False, True])
def test_seams_between_rooms_are_floor_and_nothing_else_is(turned: bool) -> None:
    drawn = np.array([list(line) for line in SEAMS.split()])
    drawn = drawn.T if turned else drawn
    layers = []
    for mark in "abcW":
        y, x = np.nonzero(drawn == mark)
        kind = {"type": "wall"} if mark == "W" else {"type": "segment", "metaData": {"name": mark}}
        layers.append({**kind, "pixels": np.column_stack((x + 90, y + 90)).ravel().tolist()})
    home = parse(changed(layers=layers, entities=[]))
    inside = slice(2, -2), slice(2, -2)
    values = home.occupancy.values[inside][::-1]
    assert np.array_equal(values == FREE, np.isin(drawn, list("abc-")))
    assert np.array_equal(values == OCCUPIED, drawn == "W")
    masks = {name: mask[inside][::-1] for name, mask in home.rooms}
    for name, mask in masks.items():
        assert set(drawn[mask]) <= {name, "-"}
        assert mask[drawn == name].all()
    assert np.array_equal(sum(mask.astype(int) for mask in masks.values()), values == FREE)


def changed(**changes: Any) -> str:
    return json.dumps({**FOREIGN, **changes})


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "in JSON"),
        ("[1]", "expected a map of Valetudo with size.*got list"),
        ('{"source": "a", "pixel_m": 0.05}', "got source, pixel_m"),
        ("{}", "metaData, got nothing;"),
        (changed(pixelSize=0), "pixelSize: expected greater than 0, got '0'"),
        (changed(pixelSize="5"), "pixelSize: expected a valid integer, got '5'"),
        (changed(layers=[{}]), "layers.0.type: expected a value, got nothing"),
        (changed(metaData={"version": 3}), "version: expected 1 or 2, got 3"),
        (changed(size={"x": 1000000, "y": 1000000}), "size: expected 1 to 20000000"),
        (changed(layers=[]), "expected floor or segments"),
        (changed(layers=[{"type": "attic"}]), "expected floor or segments"),
        (changed(layers=[{"type": "floor", "compressedPixels": [1, 2]}]), "layers.0: .*three"),
        (changed(layers=[{"type": "floor", "compressedPixels": [1, 2, 0]}]), "counts from 1"),
        (changed(layers=[{"type": "floor", "compressedPixels": [190, 2, 11]}]), "200 x 200"),
        (changed(layers=[{"type": "floor", "compressedPixels": [-1, 2, 1]}]), "left of"),
        (changed(layers=[{"type": "floor", "pixels": [1, 2, 3]}]), "two numbers"),
        (changed(entities=[{"type": "charger_location", "points": [1]}]), "two numbers"),
        *(
            (
                changed(
                    entities=[{"type": "charger_location", "points": points}],
                    metaData={"version": 2, "origin": [0.0, 0.0]},
                ),
                "two numbers",
            )
            for points in ([], [1, 2, 3, 4])
        ),
        (changed(entities=[{"type": "virtual_wall", "points": [1, 2, 3]}]), "two numbers"),
        (changed(entities=[{"type": "virtual_wall", "points": [1e308, 1]}]), "entities.0.points.0"),
        (changed(layers=[{"type": "floor", "pixels": [10**30, 1]}]), "layers.0.pixels.0: .*less"),
        (changed(metaData={"version": 2, "origin": [1e308, 0.0]}), "metaData.origin.0: .*less"),
    ],
)
def test_what_is_no_map_is_refused_with_the_reason(text: str, reason: str) -> None:
    with pytest.raises(ValetudoError, match=reason):
        parse(text)


@given(
    st.recursive(
        st.none() | st.integers() | st.text(max_size=5),
        lambda inner: st.lists(inner, max_size=3),
        max_leaves=6,
    ),
    st.sampled_from(["size", "pixelSize", "layers", "entities", "metaData"]),
)
def test_junk_raises_no_other_error_than_that_it_is_refused(junk: object, key: str) -> None:
    with contextlib.suppress(ValetudoError):
        parse(changed(**{key: junk}))
