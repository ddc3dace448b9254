"""Planes in which a robot saw itself: of a mirror that it drives to, not of things that stand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.mirror_room import HEIGHT, Kind, MirrorRoom, beams_of
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.geometry import wrap_angle
from roomba.perception.slam.mirrors.images import Beams
from roomba.perception.slam.mirrors.own_image import own_image_planes

TO_IT = ((1.8, 0.4), (1.8, 2.5))
ALONG_IT = ((0.6, 2.0), (3.4, 2.0))
UP = math.pi / 2.0


@settings(deadline=None, max_examples=5)
@given(st.floats(-math.pi, math.pi))
def test_half_of_the_way_to_its_image_ends_on_the_mirror(turned: float) -> None:
    room = MirrorRoom(turned=turned)
    facing = wrap_angle(UP + turned)
    (found,) = own_image_planes(beams_of(room.drive(*TO_IT)), facing)
    true = room.place(1.8, HEIGHT)
    off = found.plane.middle - (true.x, true.y)
    assert float(off @ found.plane.normal) == pytest.approx(0.0, abs=0.06)
    assert float(off @ found.plane.along) == pytest.approx(0.0, abs=0.2)
    assert found.farthest == pytest.approx(HEIGHT - 0.4, abs=0.15)


@pytest.mark.parametrize("kind", [Kind.WALL, Kind.GLASS])
def test_what_stands_is_none_however_it_drives(kind: Kind) -> None:
    beams = beams_of(MirrorRoom(kind=kind).drive(*TO_IT, *ALONG_IT))
    assert [own_image_planes(beams, UP + quarter * UP) for quarter in range(4)] == [[]] * 4


def test_from_one_distance_alone_it_may_be_a_wall() -> None:
    assert own_image_planes(beams_of(MirrorRoom().drive(*ALONG_IT)), UP) == []


def test_in_other_directions_a_mirror_shows_no_such_plane() -> None:
    beams = beams_of(MirrorRoom().drive(*TO_IT))
    assert own_image_planes(beams, 0.0) == own_image_planes(beams, math.pi) == []


def test_without_beams_there_is_none() -> None:
    assert own_image_planes(Beams(*np.zeros((3, 0, 2))), UP) == []


def straight_ahead(*away: float) -> Beams:
    """Beams that meet the robot's own image, from so far before a mirror at y = 0, m."""
    starts = np.array([(0.001 * number, -each) for number, each in enumerate(away)])
    ends = np.array([(x, -y - 0.08) for x, y in starts])
    return Beams(starts, ends, np.tile((0.0, -1.0), (len(away), 1)))


def test_it_takes_six_places_and_turning_on_the_spot_is_one() -> None:
    six = np.arange(1.05, 2.6, 0.3).tolist()
    (found,) = own_image_planes(straight_ahead(*six), UP)
    assert found.plane.y == pytest.approx(0.0, abs=0.01)
    assert own_image_planes(straight_ahead(*six[:5]), UP) == []
    assert (
        own_image_planes(straight_ahead(*(five for five in six[:5] for _ in range(18))), UP) == []
    )


def test_from_farther_than_four_metres_no_image_counts() -> None:
    far = np.arange(4.45, 6.0, 0.3).tolist()
    assert own_image_planes(straight_ahead(*far), UP) == []
    assert len(own_image_planes(straight_ahead(*(each - 2.0 for each in far)), UP)) == 1
