"""The mirrors of a map: found by a touch, wider with what is seen, gone when it drives through."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.mirror_room import HEIGHT, RADIUS, Kind, MirrorRoom, drawn
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.grid import OccupancyMap
from roomba.perception.slam.mirrors.mirrors import Mirrors, PlacedPoints
from roomba.perception.slam.submaps.parts import Carried
from roomba.perception.slam.submaps.submap import Keyframe
from roomba.perception.slam.submaps.submap_graph import SubmapGraph

MOUNT = np.zeros(3)
Seen = list[tuple[Keyframe, NDArray[np.float64]]]
TO_THE_MIRROR = ((0.6, 0.6), (3.4, 0.5), (3.4, 2.0), (1.8, 2.2), (1.8, HEIGHT - RADIUS))


def graph_of(frames: Seen) -> SubmapGraph:
    """A graph of one submap, at (0, 0), with these keyframes."""
    graph = SubmapGraph(MappingConfig(), LocalizationConfig(), np.zeros(3))
    add(graph, frames)
    return graph


def add(graph: SubmapGraph, frames: Seen) -> None:
    """Add keyframes to the newest submap, which lies at (0, 0)."""
    for frame, pose in frames:
        graph.newest.keyframes.append(Keyframe(frame.points, pose))


def newest(frames: Seen) -> PlacedPoints:
    """The last of them, as the scan before a touch."""
    frame, pose = frames[-1]
    return PlacedPoints(frame.points, pose)


def touched(room: MirrorRoom) -> tuple[Mirrors, Seen]:
    frames, mount = room.drive(*TO_THE_MIRROR), np.array([*room.lidar, 0.0])
    mirrors = Mirrors(graph_of(frames))
    mirrors.feel(room.touch(1.8), newest(frames), mount, drawn(frames, mount[:2]))
    return mirrors, frames


@pytest.mark.parametrize("lidar", [(0.0, 0.0), (0.1, -0.06)])
def test_a_mirror_that_was_touched_is_known_with_what_was_seen_of_it(
    lidar: tuple[float, float],
) -> None:
    mirrors, _ = touched(MirrorRoom(lidar=lidar))
    assert len(mirrors) == 1
    (right, left), *_ = mirrors.ends
    assert right[1] == pytest.approx(HEIGHT, abs=0.04)
    assert left[1] == pytest.approx(HEIGHT, abs=0.04)
    assert left[0] == pytest.approx(1.0, abs=0.15)
    assert right[0] == pytest.approx(2.5, abs=0.15)


def test_glass_is_none() -> None:
    mirrors, _ = touched(MirrorRoom(kind=Kind.GLASS))
    assert len(mirrors) == 0
    assert mirrors.ends.shape == (0, 2, 2)


def test_touched_again_it_is_the_same_one() -> None:
    room = MirrorRoom()
    mirrors, frames = touched(room)
    before = mirrors.ends
    assert not mirrors.feel(room.touch(1.7), newest(frames), MOUNT, drawn(frames))
    assert len(mirrors) == 1
    assert (mirrors.ends == before).all(), "the same scans tell no more"


@pytest.mark.parametrize("again", ["feel", "see"])
def test_the_same_scans_again_make_it_no_wider(again: str) -> None:
    """Of a few beams each counts, and twice as many would be enough for more of it."""
    room = MirrorRoom()
    frames = [
        (Keyframe(frame.points[::5], frame.pose), pose)
        for frame, pose in room.drive(*TO_THE_MIRROR)
    ]
    mirrors = Mirrors(graph_of(frames))
    whole, touch = drawn(room.drive(*TO_THE_MIRROR)), room.touch(1.8)
    assert mirrors.feel(touch, newest(frames), MOUNT, whole)
    before = mirrors.ends
    for _ in range(4):
        if again == "feel":
            mirrors.feel(touch, newest(frames), MOUNT, whole)
        else:
            mirrors.see(0, MOUNT, lambda: whole)
    assert (mirrors.ends == before).all()


def test_two_mirrors_beside_each_other_are_two() -> None:
    room = MirrorRoom(1.0, 1.7, other=(2.0, 2.7))
    around = room.drive((0.6, 0.6), (3.4, 0.5), (3.4, 2.3), (1.35, 2.3), (1.35, HEIGHT - RADIUS))
    frames = around + room.drive((1.35, 2.4), (2.2, 2.3), (2.2, HEIGHT - RADIUS))
    mirrors = Mirrors(graph_of(frames))
    assert mirrors.feel(room.touch(1.35), newest(around), MOUNT, drawn(frames))
    assert mirrors.feel(room.touch(2.2), newest(frames), MOUNT, drawn(frames))
    covered = [sorted(mirror[:, 0]) for mirror in mirrors.ends]
    assert any(low < 1.35 < high for low, high in covered)
    assert any(low < 2.2 < high for low, high in covered)


def test_it_moves_with_its_submap() -> None:
    mirrors, frames = touched(MirrorRoom())
    before = mirrors.ends
    graph = graph_of(frames)
    moved = Mirrors(graph)
    moved.take_over(mirrors.kept)
    assert moved.ends == pytest.approx(before)
    graph.poses[0] = (0.5, -0.2, math.pi / 2.0)
    assert moved.ends[..., 0] == pytest.approx(0.5 - before[..., 1])
    assert moved.ends[..., 1] == pytest.approx(-0.2 + before[..., 0])


def test_a_submap_that_shows_more_of_it_makes_it_wider() -> None:
    room = MirrorRoom()
    # From here little of it is seen.
    frames = room.drive((1.8, 2.2), (1.8, HEIGHT - RADIUS))
    around = room.drive((0.6, 0.6), (3.4, 0.5), (3.4, 2.3), (0.6, 2.3))
    occupancy = drawn(frames + around)
    graph = graph_of(frames)
    mirrors = Mirrors(graph)
    assert mirrors.feel(room.touch(1.8), newest(frames), MOUNT, occupancy)
    narrow = np.ptp(mirrors.ends[0, :, 0])
    graph.begin(np.zeros(3), 1.0)
    add(graph, around)
    mirrors.see(1, MOUNT, lambda: occupancy)
    assert np.ptp(mirrors.ends[0, :, 0]) >= narrow
    assert np.ptp(mirrors.ends[0, :, 0]) > 1.4
    assert not mirrors.see(1, MOUNT, lambda: occupancy), "there is no more of it"


def test_what_the_robot_drives_through_is_none() -> None:
    mirrors, _ = touched(MirrorRoom())
    before, behind = np.array([1.8, HEIGHT - 0.3]), np.array([1.8, HEIGHT + 0.3])
    beside = np.array([3.8, HEIGHT + 0.3])
    assert not mirrors.pass_through(before, np.array([1.0, HEIGHT - 0.3]))
    assert not mirrors.pass_through(np.array([3.8, HEIGHT - 0.3]), beside)
    assert len(mirrors) == 1
    assert mirrors.pass_through(before, behind)
    assert len(mirrors) == 0


@pytest.mark.parametrize("when", ["a submap ends", "the drive is over"])
def test_a_mirror_in_which_the_robot_saw_itself_is_known_untouched(when: str) -> None:
    frames = MirrorRoom().drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.4), (1.8, 2.4))
    mirrors, occupancy = Mirrors(graph_of(frames)), drawn(frames)
    if when == "a submap ends":
        assert mirrors.see(0, MOUNT, lambda: occupancy)
    else:
        assert mirrors.see_all(MOUNT, lambda: occupancy)
    ((right, left),) = mirrors.ends
    assert right == pytest.approx((2.5, HEIGHT), abs=0.15)
    assert left == pytest.approx((1.0, HEIGHT), abs=0.15)
    assert not mirrors.see_all(MOUNT, lambda: occupancy), "it is known already"


def test_in_a_room_without_one_it_needs_no_map_to_know_that() -> None:
    frames = MirrorRoom(kind=Kind.GLASS).drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.4), (1.8, 2.4))
    mirrors = Mirrors(graph_of(frames))

    def drawn_in_vain() -> OccupancyMap:
        raise AssertionError("it is drawn for nothing")

    assert not mirrors.see(0, MOUNT, drawn_in_vain)
    assert not mirrors.see_all(MOUNT, drawn_in_vain)


def test_where_the_robot_drove_through_no_mirror_begins() -> None:
    room = MirrorRoom()
    frames = room.drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.4), (1.8, 2.4))
    # Behind it by what it knew then: it drove on through what is no mirror.
    through = [(frames[-1][0], np.array([1.8, HEIGHT + 0.3, 0.0]))]
    mirrors = Mirrors(graph_of(frames + through))
    assert not mirrors.see(0, MOUNT, lambda: drawn(frames))
    assert len(mirrors) == 0


def test_a_robot_that_comes_towards_it_is_a_mirror_until_the_next_look() -> None:
    room = MirrorRoom(kind=Kind.WALL, has_column=False)
    met, alone = room.oncoming(), room.drive((1.6, HEIGHT / 2.0), (0.3, HEIGHT / 2.0))
    graph = graph_of(met)
    mirrors = Mirrors(graph)
    assert mirrors.see(0, MOUNT, lambda: drawn(met)), "both halves of the room are alike"
    graph.begin(np.zeros(3), 1.0)
    add(graph, alone)
    assert mirrors.see(1, MOUNT, lambda: drawn(met + alone))
    assert len(mirrors) == 0
    assert not mirrors.see_all(MOUNT, lambda: drawn(met + alone)), "and it is not found again"


def test_a_mirror_that_it_saw_itself_in_from_afar_alone_is_known() -> None:
    frames = MirrorRoom().drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.3), (1.8, 1.6))
    mirrors = Mirrors(graph_of(frames))
    assert mirrors.see(0, MOUNT, lambda: drawn(frames))
    assert len(mirrors) == 1


@pytest.mark.parametrize("is_told", [False, True])
def test_a_robot_that_was_carried_over_its_line_has_not_driven_through(is_told: bool) -> None:
    frames = MirrorRoom().drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.4), (1.8, 2.4))
    graph = graph_of(frames)
    if is_told:
        graph.begin_at(np.zeros(3), 10.0)
    else:
        graph.begin_piece(np.zeros(3), 10.0, 0.1, 0.1, carried=Carried.TOLD)
    graph.poses[-1] = 0.0
    add(graph, [(frames[-1][0], np.array([1.8, HEIGHT + 0.3, 0.0]))])
    mirrors = Mirrors(graph)
    assert mirrors.see_all(MOUNT, lambda: drawn(frames))
    assert len(mirrors) == 1


def test_it_lies_in_the_submap_that_saw_it_and_not_in_the_newest() -> None:
    frames = MirrorRoom().drive((0.6, 0.6), (3.4, 0.5), (1.8, 0.4), (1.8, 2.4))
    later = MirrorRoom().drive((3.4, 0.5), (3.4, 1.0))
    graph = graph_of(frames)
    graph.begin(np.zeros(3), 1.0)
    graph.poses[1] = 0.0
    add(graph, later)
    mirrors = Mirrors(graph)
    assert mirrors.see(1, MOUNT, lambda: drawn(frames + later))
    before = mirrors.ends
    graph.poses[1] = (0.0, -0.15, 0.0)
    assert (mirrors.ends == before).all()
    graph.poses[0] = (0.0, -0.15, 0.0)
    assert mirrors.ends[..., 1] == pytest.approx(before[..., 1] - 0.15)


def test_one_that_was_kept_is_counted_anew_and_may_be_narrower() -> None:
    mirrors, _ = touched(MirrorRoom())
    frames = MirrorRoom(left=1.5, right=2.1).drive(*TO_THE_MIRROR)
    taken_over = Mirrors(graph_of(frames))
    taken_over.take_over(mirrors.kept)
    assert np.ptp(taken_over.ends[0, :, 0]) > 1.2, "as it was"
    taken_over.see(0, MOUNT, lambda: drawn(frames))
    assert np.ptp(taken_over.ends[0, :, 0]) < 0.9
