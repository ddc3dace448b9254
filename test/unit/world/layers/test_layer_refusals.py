"""A broken layer is refused with its line and the reason."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.homes.home_layers import STATION, loaded

from roomba.errors import HomeError

ROOM = "rooms:\n  - name: den\n    outline: "
PIECE = "furniture:\n  - name: a\n    kind: sofa\n    x: 1.0\n    y: 2.0\n"
DIRT = "dirt_sources:\n  - {name: d, x: 1, y: 1, radius: 1}\n  - "


THINGS = (
    "doors: [{name: front, opening: [1, 1, 2, 1.1]}]\n"
    "furniture: [{name: stool, kind: stool, x: 1, y: 1}, "
    "{name: w, kind: window, x: 1, y: 1}]\n"
    "moving:\n  - "
)
TO = "to:\n      - {at: 600, x: 2, y: 2, takes: 3}\n      - "
PATH = "path: [[1, 1], [2, 2]]"


@pytest.mark.parametrize(
    ("entry", "line", "words"),
    [
        (
            "{door: fornt, close: [[1, 2]]}",
            5,
            "name of a door of this file, got 'fornt'; did you mean 'front'?",
        ),
        ("{furniture: stol, " + TO[:2] + ": [{at: 1, x: 1, y: 1, takes: 1}]}", 5, "'stool'"),
        ("{furniture: w, to: [{at: 1, x: 1, y: 1, takes: 1}]}", 5, "'w'"),
        ("{close: [[1, 2]]}", 5, "one of the keys door, furniture, person"),
        ("{door: front, person: Ann, close: [[1, 2]]}", 5, "one of the keys"),
        ("{door: front}", 5, "'close'"),
        ("{door: front, close: []}", 5, "'close'"),
        ("{furniture: stool}", 5, "'to'"),
        ("{person: Ann}", 5, "'path'"),
        ("{door: front, close: [[1, 2]], speed: 1}", 5, "no 'speed' beside 'door'"),
        ("{door: front, clos: [[1, 2]]}", 5, "did you mean 'close'"),
        ("door: front\n    close: [[5, 6]]\n    evry: 1", 7, "did you mean 'every'"),
        ("door: front\n    close: [[5, 6], [5.5, 7]]", 6, "in order"),
        ("door: front\n    close: [[6, 5]]", 6, "the first before the second"),
        ("door: front\n    close: [[5, 6, 7]]", 6, "close"),
        ("door: front\n    close: [[-1, 6]]", 6, "-1"),
        ("door: front\n    close: [[5, 6]]\n    every: 1", 7, "10 s or more"),
        ("door: front\n    close: [[5, 6]]\n    jitter: -1", 7, "jitter"),
        ("{door: front, close: [[5, 60]], every: 50}", 5, "within its period of 50 s"),
        ("furniture: stool\n    " + TO + "{at: 602, x: 2, y: 2, takes: 3}", 6, "in order"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 9, y: 2, takes: 3}", 8, "on the map"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 2, y: 2}", 8, "'takes'"),
        ("furniture: stool\n    " + TO + "{at: 700, x: 2, y: 2, takes: 0}", 8, "takes"),
        (
            "furniture: stool\n    " + TO + "{at: 86399, x: 2, y: 2, takes: 2}",
            5,
            "within the day",
        ),
        ("person: Ann\n    path: [[1, 1]]", 6, "2 points or more"),
        ("person: Ann\n    path: [[1, 1], [1, 1]]", 6, "2 points or more"),
        ("person: Ann\n    path:\n      - [1, 1]\n      - [9, 9]", 8, "on the map"),
        ("{person: Ann, " + PATH + ", speed: 0}", 5, "speed"),
        ("{person: Ann, " + PATH + ", at: 59, every: 60}", 5, "within its period"),
        ("{person: Ann, " + PATH + "}\n  - {person: Ann, " + PATH + "}", 6, "again"),
    ],
)
def test_broken_script_is_refused_with_line_and_reason(
    tmp_path: Path, entry: str, line: int, words: str
) -> None:
    with pytest.raises(HomeError) as refusal:
        loaded(tmp_path, STATION + THINGS + entry + "\n")
    message = str(refusal.value)
    assert message.startswith(f"{tmp_path / 'den' / 'home.yaml'}:{line}: "), message
    assert words in message
    assert "\n" not in message


def test_a_door_where_there_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(HomeError, match="there is none; add one"):
        loaded(tmp_path, STATION + "moving: [{door: d, close: [[1, 2]]}]\n")


@pytest.mark.parametrize(
    ("layer", "line", "words"),
    [
        (STATION + "colour: red\n", 2, "'colour'"),
        (STATION + "furnitur: []\n", 2, "did you mean 'furniture'"),
        (STATION + PIECE + "    colr: x\n", 7, "'colr'"),
        (STATION + PIECE + "    materil: wood\n", 7, "did you mean 'material'"),
        (
            STATION + PIECE.replace("1.0", "left"),
            5,
            "furniture.0.x: expected a valid number; got 'left'",
        ),
        (STATION + PIECE.replace("1.0", "'1.0'"), 5, "'1.0'"),
        (STATION + PIECE.replace("1.0", "true"), 5, "True"),
        (STATION + PIECE.replace("1.0", ".nan"), 5, "nan"),
        (STATION + PIECE.replace("1.0", ".inf"), 5, "inf"),
        (STATION + PIECE.replace("1.0", "99.0"), 3, "on the map"),
        (STATION + PIECE.replace("    x: 1.0\n", ""), 3, "'x'"),
        (STATION + PIECE.replace("sofa", "sofaa"), 4, "did you mean 'sofa'"),
        (STATION + PIECE + "    facing: up\n", 7, "east, north, west, south"),
        (STATION + PIECE + "    material: fabric_grean\n", 7, "did you mean 'fabric_green'"),
        (STATION + PIECE + "    size: {width: 0.1}\n", 7, "usual"),
        (STATION + PIECE + "    size: {width: -1}\n", 7, "or equal to 0.001"),
        (STATION + PIECE + "    size: {width: 21, height: 21}\n", 7, "or equal to 20"),
        (STATION + "wall_height: 21\n", 2, "or equal to 20"),
        (STATION + PIECE + PIECE.replace("furniture:\n", ""), 7, "again"),
        (STATION + ROOM + "[[0, 0], [2, 2], [2, 0], [0, 2]]\n", 4, "crosses itself"),
        (STATION + ROOM + "[[0, 0], [2, 2]]\n", 4, "3"),
        (STATION + ROOM + "[[0, 0], [2, 0, 1], [2, 2]]\n", 4, "outline"),
        (STATION + ROOM + "[[0, 0], [20, 0], [2, 2]]\n", 4, "on the map"),
        (STATION + ROOM + "[[0, 0], [2, 0], [2, 2]]\n    floor: oat\n", 5, "did you mean 'oak'"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 1, amount: -2}\n", 4, "amount"),
        (STATION + DIRT + "{name: e, x: -0.05, y: 1, radius: 1}\n", 4, "free floor"),
        (STATION + DIRT + "{name: d, x: 1, y: 1, radius: 1}\n", 4, "again"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 0}\n", 4, "radius"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 1, amount: 1.0e+12}\n", 4, "amount"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 0.01, amount: 9000}\n", 4, "can hold"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 1.0e+200}\n", 4, "10000"),
        (STATION + DIRT + "{name: e, x: 1, y: 1, radius: 1.0e-200}\n", 4, "0.001"),
        (STATION + PIECE.replace("name: a", r'name: "a\nb"'), 3, "printable"),
        (STATION + PIECE.replace("name: a", r'name: "a\u202eb"'), 3, "printable"),
        (STATION + PIECE.replace("name: a", f"name: {81 * 'a'}"), 3, "80 printable"),
        (STATION + PIECE.replace("name: a", "name: ' '"), 3, "printable"),
        (STATION + PIECE.replace("name: a", "name: ''"), 3, "printable"),
        (STATION + "carpets: [{name: r, area: [2, 1, 1, 2]}]\n", 2, "x_min"),
        (STATION + "stairs: [[1, 1, 2]]\n", 2, "stairs"),
        (
            STATION + "dirt_sources: [{name: e, x: 3, y: 1, radius: 1}]\n"
            "stairs: [[2.5, 0.5, 4, 2]]\n",
            2,
            "which is none",
        ),
        (STATION + "doors: [{name: d, opening: [1, 1, 2, 2], open: maybe}]\n", 2, "maybe"),
        (STATION + "wall_height: 0\n", 2, "wall_height"),
        ("# near the wall\nstation: {x: 2.0, y: 0.1, facing: south}\n", 2, "docked body"),
        ("station: {x: 9.0, y: 0.4, facing: south}\n", 1, "on the map"),
        ("station: {x: 2.0, y: 0.4}\n", 1, "'facing'"),
        ("station: [2.0, 0.4]\n", 1, "station"),
        (STATION + STATION, 2, "again"),
        (STATION + "rooms: {\n", 3, "YAML"),
        (STATION + "rooms: !!python/name:os.system\n", 2, "YAML"),
        ("just words\n", 1, "keys and values"),
    ],
)
def test_broken_layer_is_refused_with_line_and_reason(
    tmp_path: Path, layer: str, line: int, words: str
) -> None:
    with pytest.raises(HomeError) as refusal:
        loaded(tmp_path, layer)
    message = str(refusal.value)
    assert message.startswith(f"{tmp_path / 'den' / 'home.yaml'}:{line}: "), message
    assert words in message


def test_station_in_furniture_is_refused(tmp_path: Path) -> None:
    with pytest.raises(HomeError, match="docked body"):
        loaded(tmp_path, STATION + PIECE.replace("2.0", "0.4").replace("1.0", "1.9"))
