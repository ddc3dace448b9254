"""The plane of a mirror: found where one was touched, at any turn of the room, and nowhere else."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.mirror_room import HEIGHT, RADIUS, Kind, MirrorRoom, beams_of, drawn
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.geometry import wrap_angle
from roomba.perception.slam.mirrors.images import MappedFloor, Plane
from roomba.perception.slam.mirrors.search import (
    Touch,
    seen_mirror,
    still_shows_itself,
    touched_mirror,
)

TO_THE_MIRROR = ((0.6, 0.6), (3.4, 0.5), (3.4, 2.0), (1.8, 2.2), (1.8, HEIGHT - RADIUS))
"""About the room, and then straight to the middle of the upper wall."""


def found(room: MirrorRoom, touch: Touch, *way: tuple[float, float]) -> Plane | None:
    frames = room.drive(*(way or TO_THE_MIRROR))
    return touched_mirror(beams_of(frames), MappedFloor.of(drawn(frames)), touch)


@settings(deadline=None, max_examples=6)
@given(st.floats(-math.pi, math.pi))
def test_a_touched_mirror_is_found_however_the_room_lies(turned: float) -> None:
    room = MirrorRoom(turned=turned)
    plane = found(room, room.touch(1.8))
    assert plane is not None
    assert wrap_angle(plane.facing - turned - math.pi / 2.0) == pytest.approx(0.0, abs=0.03)
    true = room.place(1.8, HEIGHT)
    normal = np.array([-math.sin(turned), math.cos(turned)])
    assert float((plane.middle - (true.x, true.y)) @ normal) == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("behind", [1.3, HEIGHT])
def test_glass_before_another_room_is_none_not_even_before_one_alike(behind: float) -> None:
    room = MirrorRoom(kind=Kind.GLASS, behind=behind, has_column=False)
    assert found(room, room.touch(1.8)) is None


def test_what_stands_in_the_middle_of_a_room_is_none_though_both_its_walls_are_alike() -> None:
    room = MirrorRoom(kind=Kind.WALL, has_column=False)
    middle = HEIGHT / 2.0
    touch = room.touch(1.8, middle - RADIUS)
    assert found(room, touch, (0.6, 0.6), (3.4, 0.6), (1.8, 0.6), (1.8, middle - RADIUS)) is None


def test_a_wall_that_the_lidar_sees_is_none() -> None:
    room = MirrorRoom(kind=Kind.WALL)
    assert found(room, room.touch(1.8)) is None


def test_from_one_place_alone_no_mirror_is_known() -> None:
    room = MirrorRoom()
    assert found(room, room.touch(1.8), (1.8, 2.5)) is None


def test_a_touch_of_the_other_half_of_the_bumper_is_of_no_such_plane() -> None:
    room = MirrorRoom()
    here = room.place(1.8, HEIGHT - RADIUS, math.radians(60.0))
    right = Touch(here.x, here.y, RADIUS, here.theta - math.pi / 2.0, here.theta)
    assert found(room, right) is None


def test_a_robot_that_comes_towards_the_glass_makes_it_no_mirror() -> None:
    room = MirrorRoom(kind=Kind.GLASS, behind=1.6)
    pane = Plane(1.8, HEIGHT, math.pi / 2.0)
    met = [room.keyframe(1.8, y, (1.8, 2.0 * HEIGHT - y)) for y in np.arange(1.6, 2.8, 0.12)]
    frames = [*met, *room.drive((0.6, 2.0), (3.4, 2.0))]
    assert still_shows_itself(beams_of(frames), pane, 1.5), "it looks like its own image"
    assert seen_mirror(beams_of(frames), MappedFloor.of(drawn(frames)), pane, 1.5) is None


def test_scans_of_a_robot_that_stands_are_from_one_place() -> None:
    room, wall = MirrorRoom(), Plane(1.8, HEIGHT, math.pi / 2.0)
    standing = beams_of([room.keyframe(1.8 + 0.001 * number, 1.61) for number in range(8)])
    assert not still_shows_itself(standing, wall, 2.0)
    assert still_shows_itself(beams_of(room.drive((1.8, 1.2), (1.8, 2.4))), wall, 2.0)
