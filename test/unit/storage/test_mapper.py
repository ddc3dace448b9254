"""A growing map in a file: it comes back bit for bit, new or as before, or is refused."""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fixtures.homes.kept_map import LIDAR, STATION, kept_map, keyframe
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.perception.slam.mapper_state import MapperState
from roomba.perception.slam.mirrors.mirror import KeptMirror
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind
from roomba.perception.slam.submaps.submap import KeptSubmap, Keyframe
from roomba.storage.mapper import (
    KeptMap,
    MapperFileError,
    load_mapper,
    remove_mapper,
    save_mapper,
)

Arrays = dict[str, NDArray[Any]]

NUMBERS = st.floats(-1e6, 1e6)


def are_same(one: KeptMap, other: KeptMap) -> bool:
    """Whether they are, to the last bit."""
    mine, its = one.state, other.state
    frames, others = ([f for s in each.submaps for f in s.keyframes] for each in (mine, its))
    return (
        (one.run, one.station, one.station_from_start, one.taken_up)
        == (other.run, other.station, other.station_from_start, other.taken_up)
        and (mine.way, mine.phase, mine.lidar, mine.version, mine.is_lost)
        == (its.way, its.phase, its.lidar, its.version, its.is_lost)
        and mine.poses.tobytes() == its.poses.tobytes()
        and [(s.way, len(s.keyframes)) for s in mine.submaps]
        == [(s.way, len(s.keyframes)) for s in its.submaps]
        and list(map(bits, frames)) == list(map(bits, others))
        and [
            (k.parent, k.child, k.kind, k.relative.tobytes(), k.information.tobytes())
            for k in mine.links
        ]
        == [
            (k.parent, k.child, k.kind, k.relative.tobytes(), k.information.tobytes())
            for k in its.links
        ]
        and [(m.submap, m.plane.tobytes(), m.reach.tobytes()) for m in mine.mirrors]
        == [(m.submap, m.plane.tobytes(), m.reach.tobytes()) for m in its.mirrors]
    )


def bits(frame: Keyframe) -> list[tuple[bytes, np.dtype[Any], tuple[int, ...]]]:
    parts = (frame.points, frame.open, frame.pose)
    return [(each.tobytes(), each.dtype, each.shape) for each in parts]


@pytest.mark.parametrize("station", [None, STATION])
def test_it_comes_back_bit_for_bit(tmp_path: Path, station: Pose | None) -> None:
    path = tmp_path / "maps" / ".being_made" / "robot.npz"
    assert load_mapper(path, pytest.fail) is None
    save_mapper(kept_map(station), path)
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert are_same(read, kept_map(station))
    remove_mapper(path)
    remove_mapper(path)
    assert load_mapper(path, pytest.fail) is None


@st.composite
def mirrors(draw: st.DrawFn, submaps: int) -> KeptMirror:
    """Any mirror in one of so many submaps."""
    away = st.floats(0.01, 1e6)
    plane, reach = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)), draw(st.tuples(away, away))
    submap, seen_from = draw(st.integers(0, submaps - 1)), draw(st.floats(0.0, 4.0))
    return KeptMirror(submap, np.array(plane), np.array(reach), seen_from)


@st.composite
def kept_maps(draw: st.DrawFn) -> KeptMap:
    """Any map: submaps of any length, some empty, and any links between them."""
    sizes = draw(st.lists(st.lists(st.integers(0, 6), max_size=4), min_size=1, max_size=5))
    if not any(sizes):
        sizes[0] = [1]
    submaps = tuple(
        KeptSubmap(draw(NUMBERS), tuple(keyframe(count, draw(st.integers(0, 99))) for count in own))
        for own in sizes
    )
    number = st.integers(0, len(sizes) - 1)
    links = tuple(
        Link(parent, child, np.array(relative), np.diag(relative), kind)
        for parent, child, relative, kind in draw(
            st.lists(
                st.tuples(
                    number, number, st.tuples(NUMBERS, NUMBERS, NUMBERS), st.sampled_from(LinkKind)
                ),
                max_size=6,
            )
        )
    )
    poses = np.array([draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)) for _ in sizes])
    state = MapperState(
        submaps,
        poses,
        links,
        draw(NUMBERS),
        draw(st.tuples(NUMBERS, NUMBERS)),
        LIDAR,
        draw(st.integers(0, 2**40)),
        draw(st.booleans()),
        tuple(draw(st.lists(mirrors(len(sizes)), max_size=3))),
    )
    stations = st.none() | st.builds(Pose, NUMBERS, NUMBERS, NUMBERS)
    run = draw(st.text(st.characters(blacklist_characters="\0", blacklist_categories=["Cs"])))
    return KeptMap(state, run, draw(stations), draw(stations), draw(st.integers(0, 9)))


@given(kept_maps())
@settings(max_examples=examples(60), deadline=None)
def test_any_map_comes_back(tmp_path_factory: pytest.TempPathFactory, any_map: KeptMap) -> None:
    path = tmp_path_factory.mktemp("kept") / "robot.npz"
    save_mapper(any_map, path)
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert are_same(read, any_map)


def test_who_is_killed_while_writing_finds_the_one_from_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "robot.npz"
    save_mapper(kept_map(), path)

    def killed(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", killed)
    with pytest.raises(KeyboardInterrupt):
        save_mapper(kept_map(None), path)
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert are_same(read, kept_map())


def written(path: Path) -> bytes:
    save_mapper(kept_map(), path)
    return path.read_bytes()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda whole: b"",
        lambda whole: b"PK",
        lambda whole: b"no zip at all",
        lambda whole: whole[: len(whole) // 2],
        lambda whole: whole[:-130],
        lambda whole: whole[:900] + bytes(40) + whole[940:],
    ],
)
def test_a_broken_file_is_named(tmp_path: Path, spoil: Callable[[bytes], bytes]) -> None:
    path = tmp_path / "robot.npz"
    path.write_bytes(spoil(written(path)))
    with pytest.raises(MapperFileError, match=r"expected a map.*robot\.npz: .*set aside"):
        load_mapper(path, pytest.fail)


def test_a_folder_in_its_place_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapperFileError, match="set aside"):
        load_mapper(tmp_path, pytest.fail)


def rewritten(path: Path, **changes: NDArray[Any] | None) -> None:
    """Write the file again with other arrays, or without some."""
    with np.load(path) as file:
        arrays: Arrays = {name: file[name] for name in file.files}
    arrays |= {name: value for name, value in changes.items() if value is not None}
    packed = io.BytesIO()
    np.savez(
        packed, **{n: a for n, a in arrays.items() if not (n in changes and changes[n] is None)}
    )
    path.write_bytes(packed.getvalue())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": np.array(2)}, "expected one of format 1, got format 2"),
        ({"poses": None}, "poses"),
        ({"poses": np.zeros((2, 3))}, r"poses: expected float64 of shape \(3, 3\)"),
        ({"poses": np.zeros((3, 3), np.float32)}, "poses: expected float64"),
        ({"poses": np.full((3, 3), np.nan)}, "poses: expected finite numbers"),
        ({"points": np.zeros((11, 4), np.float32)}, "points: expected float32"),
        ({"submap_keyframes": np.array([1, 1, 1])}, "expected 3 keyframes, got 4"),
        ({"keyframe_points": np.array([20, -8, 0, 0])}, "expected 0 or more, got -8"),
        ({"open": np.zeros((1, 2), np.float32)}, "open: expected float32"),
        ({"keyframe_open": np.array([1, 1])}, "keyframe_open: expected"),
        ({"link_ends": np.array([[0, 1], [0, 3]])}, "expected links between 3 submaps"),
        ({"link_kinds": np.array([1, 4])}, "expected 4 kinds of links, got number 4"),
        ({"link_kinds": np.array([1])}, "link_kinds: expected"),
        ({"mirror_submaps": np.array([3])}, "expected mirrors in 3 submaps, got one in 3"),
        ({"mirror_reaches": np.zeros((2, 2))}, "mirror_reaches: expected"),
        ({"mirror_reaches": np.array([[0.4, 0.0]])}, "mirrors that reach farther than 0"),
        ({"mirror_seen_from": np.array([-1.0])}, "mirrors seen from 0 m or farther"),
        ({"lidar_beams": np.array(0)}, "expected a lidar with beams"),
        ({"lidar_numbers": np.array([0.0, 0.1, 3.0, 1.0])}, "reaches from near to far"),
        ({"lidar_mount": np.full(3, np.nan)}, "and a mount"),
        ({"station": np.array([1.0, np.nan, 0.0])}, "station: expected finite numbers"),
        ({"run": np.array(7)}, "run: expected words"),
        ({"run": np.array([None])}, "expected an array of numbers, got object"),
        (
            {
                "submap_ways": np.zeros(0),
                "submap_keyframes": np.zeros(0, np.int64),
                "keyframe_points": np.zeros(0, np.int64),
            },
            "one submap with one keyframe",
        ),
    ],
)
def test_what_does_not_fit_together_is_refused(
    tmp_path: Path, changes: dict[str, NDArray[Any] | None], message: str
) -> None:
    path = tmp_path / "robot.npz"
    save_mapper(kept_map(), path)
    rewritten(path)
    assert load_mapper(path, pytest.fail) is not None
    rewritten(path, **changes)
    with pytest.raises(MapperFileError, match=message):
        load_mapper(path, pytest.fail)


def test_links_of_an_older_program_had_two_flags(tmp_path: Path) -> None:
    kept, path = kept_map(), tmp_path / "robot.npz"
    kinds = [LinkKind.DRIVEN, LinkKind.TOLD, LinkKind.GUESSED, LinkKind.MATCHED]
    links = tuple(
        Link(parent, child, np.zeros(3), np.eye(3), kind)
        for (parent, child), kind in zip(((0, 1), (0, 2), (1, 2), (1, 2)), kinds, strict=True)
    )
    save_mapper(replace(kept, state=replace(kept.state, links=links)), path)
    doubts, guesses = (
        np.array([kind is asked for kind in kinds])
        for asked in (LinkKind.MATCHED, LinkKind.GUESSED)
    )
    rewritten(path, link_kinds=None, link_doubts=doubts, link_guesses=guesses)
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert [link.kind for link in read.state.links] == kinds
    rewritten(path, link_guesses=None)  # a program that knew no guesses
    read = load_mapper(path, pytest.fail)
    assert read is not None
    expected = [LinkKind.DRIVEN, LinkKind.TOLD, LinkKind.DRIVEN, LinkKind.MATCHED]
    assert [link.kind for link in read.state.links] == expected


def test_mirrors_of_an_older_program_count_as_touched(tmp_path: Path) -> None:
    path, kept = tmp_path / "robot.npz", kept_map()
    save_mapper(kept, path)
    rewritten(path, mirror_seen_from=None)
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert len(read.state.mirrors) == len(kept.state.mirrors) > 0
    assert [mirror.seen_from for mirror in read.state.mirrors] == [0.0] * len(read.state.mirrors)


def test_a_file_of_an_older_program_has_no_open_ways_and_no_mirrors(tmp_path: Path) -> None:
    path = tmp_path / "robot.npz"
    save_mapper(kept_map(), path)
    mirrors = ("mirror_submaps", "mirror_planes", "mirror_reaches", "mirror_seen_from")
    gone = ("keyframe_open", "open", *mirrors)
    rewritten(path, **dict.fromkeys(gone))
    read = load_mapper(path, pytest.fail)
    assert read is not None
    assert read.state.mirrors == ()
    frames = [frame for submap in read.state.submaps for frame in submap.keyframes]
    assert {frame.open.shape for frame in frames} == {(0, 2)}
    assert sum(len(frame.points) for frame in frames) == 12
