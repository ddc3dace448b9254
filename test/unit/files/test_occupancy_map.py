"""Maps in map_server's format: what each field means, what is refused, and the round trip."""

from __future__ import annotations

import math
import os
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
import PIL.Image
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from roomba.errors import HomeError
from roomba.files.occupancy_map import load_map, save_map
from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap

HEADER = "image: map.pgm\nresolution: 0.05\norigin: [-1.0, 2.0, 0.0]\n"
USUAL = HEADER + "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def written(folder: Path, text: str, image: bytes = b"P5\n3 1\n255\n\x00\xcd\xfe") -> Path:
    """Write a map of three pixels (occupied, unknown, free as map_saver writes them)."""
    (folder / "map.pgm").write_bytes(image)
    (folder / "map.yaml").write_text(text, encoding="utf-8")
    return folder / "map.yaml"


def png(folder: Path, pixels: NDArray[np.uint8]) -> None:
    cv2.imwrite(str(folder / "map.png"), pixels)


def test_usual_map_is_read(tmp_path: Path) -> None:
    occupancy = load_map(written(tmp_path, USUAL))
    assert occupancy.values.tolist() == [[100, -1, 0]]
    assert occupancy.values.dtype == np.int8
    assert occupancy.frame == GridFrame(0.05, -1.0, 2.0, 1, 3)


def test_first_row_is_lowest_y(tmp_path: Path) -> None:
    occupancy = load_map(written(tmp_path, USUAL, b"P5\n1 3\n255\n\x00\xfe\xcd"))
    assert occupancy.values[:, 0].tolist() == [-1, 0, 100]


def test_thresholds_have_defaults(tmp_path: Path) -> None:
    assert load_map(written(tmp_path, HEADER)).values.tolist() == [[100, -1, 0]]


def test_keys_of_other_programs_are_ignored(tmp_path: Path) -> None:
    assert load_map(written(tmp_path, USUAL + "slam: {name: x}\n")).values[0, 2] == 0


@pytest.mark.parametrize(
    ("mode", "grey", "expected"),
    [
        ("trinary", (0, 128, 255), (100, -1, 0)),
        ("scale", (0, 100, 255), (100, 1 + int(98 * (155 / 255 - 0.196) / (0.65 - 0.196)), 0)),
        ("raw", (0, 42, 100), (0, 42, 100)),
        ("raw", (101, 200, 255), (-1, -1, -1)),
    ],
)
def test_modes(tmp_path: Path, mode: str, grey: tuple[int, ...], expected: tuple[int, ...]) -> None:
    path = written(tmp_path, USUAL + f"mode: {mode}\n", b"P5\n3 1\n255\n" + bytes(grey))
    assert tuple(load_map(path).values[0].tolist()) == expected


def test_unknown_of_map_saver_is_unknown_also_by_thresholds_of_nav2(tmp_path: Path) -> None:
    nav2 = USUAL.replace("free_thresh: 0.196", "free_thresh: 0.25")
    assert load_map(written(tmp_path, nav2)).values.tolist() == [[100, -1, 0]]
    # A person edited one pixel of many.
    pixels = b"\x00\xcd\xfe" * 66 + b"\xcd\x80"
    edited = load_map(written(tmp_path, nav2, b"P5\n200 1\n255\n" + pixels))
    assert edited.values[0, -2:].tolist() == [-1, -1]
    # A program for pictures made white of free.
    white = pixels.replace(b"\xfe", b"\xff")
    edited = load_map(written(tmp_path, nav2, b"P5\n200 1\n255\n" + white))
    assert edited.values[0, :3].tolist() == [100, -1, 0]
    # Greys of another program mean what the thresholds say.
    drawn = load_map(written(tmp_path, nav2, b"P5\n3 1\n255\n\x0a\xcd\xff"))
    assert drawn.values.tolist() == [[100, 0, 0]]


def test_a_yaw_that_is_rounding_is_none(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL.replace("0.0]", "-1.0e-9]"))
    assert load_map(path).values.tolist() == load_map(written(tmp_path, USUAL)).values.tolist()


@pytest.mark.parametrize(
    "yaw",
    [
        "1.5707963",
        "1.57",
        "3.14159",
        "3.14",
        "-3.14159",
        "-1.5708",
        "4.712389",
        "4.71",
        "-4.71",
        "6.28",
    ],
)
def test_quarter_turns_are_turned_about_the_lower_left_corner(tmp_path: Path, yaw: str) -> None:
    image = b"P5\n3 2\n255\n\x00\xcd\xfe\xfe\xfe\x00"
    straight = load_map(written(tmp_path, USUAL, image))
    turned = load_map(written(tmp_path, USUAL.replace("0.0]", f"{yaw}]"), image))
    assert turned.values.size == straight.values.size
    corner = Pose(-1.0, 2.0, round(float(yaw) / (math.pi / 2.0)) * math.pi / 2.0)
    for row, column in np.ndindex(straight.frame.shape):
        place = corner.compose(Pose((column + 0.5) * 0.05, (row + 0.5) * 0.05, 0.0))
        assert turned.frame.contains(place.x, place.y)
        there = turned.frame.cell_of(place.x, place.y)
        assert turned.values[there] == straight.values[row, column]


def test_a_mode_in_capitals_is_read(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL + "mode: Trinary\n")
    assert load_map(path).values.tolist() == [[100, -1, 0]]


def test_negate_turns_black_into_free(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL.replace("negate: 0", "negate: 1"))
    assert load_map(path).values.tolist() == [[0, 100, 100]]


@pytest.mark.parametrize(
    "image",
    [
        b"P2\n# made by hand\n3 1\n255\n0 205 # unknown\n254\n",
        b"P5 3 1 255 \x00\xcd\xfe",
        b"P5\n3 1\n65535\n\x00\x00\xcd\xcd\xfe\xfe",
        b"P2 3 1 1000 0 800 996",
        b"P5\n# a program's\n3 1\n254\n\x00\xcd\xfe",
        b"P2\n3 1\n# white\n254\n0 205 254\n",
        b"P5\n3 1\n210\n\x00\xa9\xd2",
        b"P6\n3 1\n254\n\x00\x00\x00\xcd\xcd\xcd\xfe\xfe\xfe",
        b"P3\n3 1\n254\n0 0 0 205 205 205 254 254 254\n",
    ],
)
def test_kinds_of_pgm(tmp_path: Path, image: bytes) -> None:
    assert load_map(written(tmp_path, USUAL, image)).values.tolist() == [[100, -1, 0]]


def test_png_colours_are_averaged_and_clear_is_unknown(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL.replace("map.pgm", "map.png"))
    png(tmp_path, np.array([[[255, 255, 0], [0, 0, 255], [250, 254, 255]]], np.uint8))
    assert load_map(path).values.tolist() == [[-1, 100, 0]]
    png(tmp_path, np.array([[[255, 255, 255, 0], [0, 0, 0, 0], [255, 255, 255, 255]]], np.uint8))
    assert load_map(path).values.tolist() == [[-1, -1, 0]]
    png(tmp_path, np.array([[0, 205, 254]], np.uint8))
    assert load_map(path).values.tolist() == [[100, -1, 0]]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (HEADER.replace("0.0]", "0.5]"), 3, "yaw"),
        (HEADER.replace("0.05", "-0.05"), 2, "resolution"),
        (HEADER.replace("0.05", ".nan"), 2, "finite"),
        (HEADER.replace("0.05", "1e6"), 2, "1e6"),
        (HEADER.replace("0.05", "1.0e-9"), 2, "1e-09"),
        (HEADER.replace("0.05", "1.0e+300"), 2, "1e+300"),
        (HEADER.replace("2.0", "1.0e+300"), 3, "origin"),
        (HEADER.replace("0.05", "small"), 2, "small"),
        (HEADER.replace("0.0]", "1.5]"), 3, "yaw"),
        (HEADER.replace("0.0]", "0.001]"), 3, "yaw"),
        (HEADER.replace("[-1.0, 2.0, 0.0]", "[-1.0, 2.0]"), 3, "expected three numbers"),
        (HEADER.replace("[-1.0, 2.0, 0.0]", "[]"), 3, "expected three numbers"),
        (HEADER.replace("[-1.0, 2.0, 0.0]", "7"), 3, "origin"),
        (HEADER + "mode: 3\n", 4, "mode"),
        (HEADER.replace("image: map.pgm\n", ""), 1, "image"),
        (HEADER.replace("map.pgm", "none.pgm"), 1, "none.pgm"),
        (HEADER + "mode: trinry\n", 4, "trinry"),
        (HEADER + "negate: 7\n", 4, "negate"),
        (HEADER + "free_thresh: 0.7\n", 4, "no more than occupied_thresh"),
        (HEADER + "resolution: 0.1\n", 4, "again"),
        (HEADER + "negate: [\n", 5, "YAML"),
        ("- a\n- b\n", 1, "keys and values"),
        ("", 1, "keys and values"),
    ],
)
def test_broken_yaml_is_refused_with_its_line(
    tmp_path: Path, text: str, line: int, words: str
) -> None:
    path = written(tmp_path, text)
    with pytest.raises(HomeError) as refusal:
        load_map(path)
    message = str(refusal.value)
    assert message.startswith(f"{path}:{line}: ")
    assert words in message


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (b"P5\n3 1\n255\n\x00\xcd", "cut short"),
        (b"P5\n3\n", "cut short"),
        (b"P5\n0 1\n255\n", "PGM or PNG"),
        (b"P5\n" + 5000 * b"9" + b" 1\n255\n", "PGM or PNG.*long"),
        (b"P5\n999999999 999999999\n255\n", "at most 20000000 pixels"),
        (b"P5\n8000 8000\n255\n" + bytes(64_000_000), "8000 x 8000 = 64000000"),
        (b"P2\n3 1\n255\n0 a 3", "PGM or PNG.*b'a'"),
        (b"P2\n3 1\n255\n0 1 300", "PGM or PNG.*300"),
        (b"", "empty"),
        (b"what is this?", "PGM or PNG"),
        (b"\x89PNG\r\n\x1a\n\x00\x00", "cut short"),
    ],
)
def test_broken_picture_is_refused(tmp_path: Path, image: bytes, words: str) -> None:
    path = written(tmp_path, USUAL, image)
    with pytest.raises(HomeError, match=words) as refusal:
        load_map(path)
    assert str(refusal.value).startswith(f"{path}:1: ")


def test_yaml_runs_no_code(tmp_path: Path) -> None:
    path = written(tmp_path, HEADER + "negate: !!python/object/apply:os.getcwd []\n")
    with pytest.raises(HomeError, match=r":4: "):
        load_map(path)


@pytest.mark.parametrize(
    "image",
    [b"P5\n3 1\n255\n\x00\xcd\xfe", b"P2\n3 1\n255\n0 205 254\n", b"P5\n99999 99999\n255\n\x00"],
)
def test_a_picture_in_place_of_a_map_is_told_as_one(tmp_path: Path, image: bytes) -> None:
    beside = written(tmp_path, USUAL, image)
    with pytest.raises(HomeError, match=r"got a picture; name .*map\.yaml"):
        load_map(tmp_path / "map.pgm")
    beside.unlink()
    with pytest.raises(HomeError, match="got a picture; write one beside it with image, resol"):
        load_map(tmp_path / "map.pgm")


def test_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(HomeError, match=r"nowhere\.yaml"):
        load_map(tmp_path / "nowhere.yaml")


NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)
SHAPES = hnp.array_shapes(min_dims=2, max_dims=2, max_side=12)


@given(
    st.one_of(
        hnp.arrays(np.int8, SHAPES, elements=st.integers(-1, 100)),
        hnp.arrays(np.int8, SHAPES, elements=st.sampled_from([-1, 0, 100])),
    ),
    st.floats(1e-3, 1.0),
    NUMBERS,
    NUMBERS,
)
def test_what_is_saved_is_read_back(
    values: NDArray[np.int8], resolution: float, x: float, y: float
) -> None:
    occupancy = OccupancyMap(GridFrame(resolution, x, y, *values.shape), values)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "saved.yaml"
        save_map(occupancy, path)
        loaded = load_map(path)
    assert loaded.frame == occupancy.frame
    assert np.array_equal(loaded.values, values)


@pytest.mark.parametrize("name", ["1e3", "null", "Anna's: flat #2", "Küche", "- a " + 40 * "b c"])
def test_a_map_of_any_name_is_read_back(tmp_path: Path, name: str) -> None:
    occupancy = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 1, 2), np.array([[0, 100]], np.int8))
    save_map(occupancy, tmp_path / f"{name}.yaml")
    assert np.array_equal(load_map(tmp_path / f"{name}.yaml").values, occupancy.values)


def test_values_that_are_no_map_are_not_saved(tmp_path: Path) -> None:
    values = np.full((1, 1), 101, np.int8)
    with pytest.raises(ValueError, match="101"):
        save_map(OccupancyMap(GridFrame(1.0, 0.0, 0.0, 1, 1), values), tmp_path / "m.yaml")


@pytest.mark.parametrize("name", ["map.yaml", "map.pgm"])
def test_a_pipe_or_a_device_in_place_of_a_file_is_refused_at_once(
    tmp_path: Path, name: str
) -> None:
    path = written(tmp_path, USUAL)
    (tmp_path / name).unlink()
    os.mkfifo(tmp_path / name)
    with pytest.raises(HomeError, match="expected a regular file, got a pipe"):
        load_map(path)
    (tmp_path / name).unlink()
    (tmp_path / name).symlink_to("/dev/zero")
    with pytest.raises(HomeError, match="expected a regular file, got a device"):
        load_map(path)


def test_a_png_that_unpacks_to_more_than_a_map_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL.replace("map.pgm", "map.png"))
    PIL.Image.new("1", (8000, 8000)).save(tmp_path / "map.png")
    with pytest.raises(HomeError, match="8000 x 8000"):
        load_map(path)


def test_a_picture_that_is_a_program_is_not_run(tmp_path: Path) -> None:
    path = written(tmp_path, USUAL, b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\nshowpage\n")
    with pytest.raises(HomeError, match="PGM or PNG"):
        load_map(path)
