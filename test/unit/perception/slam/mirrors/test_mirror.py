"""How far a mirror goes to both sides: as far as images fit, and on to a surface near by."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.mirror_room import HEIGHT, WIDTH, Kind, MirrorRoom, beams_of, drawn
from numpy.typing import NDArray

from roomba.perception.slam.mirrors.images import MappedFloor, Plane
from roomba.perception.slam.mirrors.mirror import Mirror, placed

WAY = ((0.5, 0.6), (3.5, 0.6), (3.5, 2.3), (0.5, 2.3))
HOME = np.zeros(3)


def widened(room: MirrorRoom, pose: NDArray[np.float64] = HOME) -> Mirror:
    """A mirror that was touched at x = 1.8, in the frame of a submap at ``pose``."""
    frames = room.drive(*WAY)
    plane = Plane(1.8, HEIGHT, math.pi / 2.0)
    inverse = np.array([-pose[0], -pose[1], 0.0])
    mirror = Mirror.found(0, placed(plane, inverse))
    mirror.count(beams_of(frames), MappedFloor.of(drawn(frames)), pose)
    return mirror


@pytest.mark.parametrize("pose", [HOME, np.array([2.0, -1.0, 0.0])])
def test_it_goes_as_far_as_images_fit(pose: NDArray[np.float64]) -> None:
    # To both sides another wall is seen at once: it goes on to that.
    right, left = widened(MirrorRoom(), pose).ends(pose)
    assert right == pytest.approx((2.55, HEIGHT), abs=0.1)
    assert left == pytest.approx((0.95, HEIGHT), abs=0.1)


def test_a_touch_alone_is_of_more_than_a_point() -> None:
    right, left = Mirror.found(0, Plane(1.0, 2.0, 0.0)).ends(HOME)
    assert 0.1 < math.dist(right, left) < 0.3
    assert (right + left) / 2.0 == pytest.approx((1.0, 2.0))


def test_beside_an_opening_it_ends_there() -> None:
    frames = MirrorRoom(1.0, 1.5, Kind.GLASS).drive(*WAY)
    mirror = Mirror.found(0, Plane(1.25, HEIGHT, math.pi / 2.0))
    mirror.count(beams_of(frames), MappedFloor.of(drawn(frames)), HOME)
    right, left = mirror.ends(HOME)
    assert math.dist(right, left) < 0.3, "no image fits: it stays as it was touched"


def test_counted_anew_it_is_as_wide_as_it_was() -> None:
    room = MirrorRoom()
    mirror, frames = widened(room), room.drive(*WAY)
    before = mirror.ends(HOME)
    mirror.forget()
    assert math.dist(*mirror.ends(HOME)) < 0.3
    mirror.count(beams_of(frames), MappedFloor.of(drawn(frames)), HOME)
    assert (mirror.ends(HOME) == before).all()
    assert before[:, 0].min() > 0.0
    assert before[:, 0].max() < WIDTH


def test_where_more_contradicts_than_fits_it_is_no_more() -> None:
    mirror = widened(MirrorRoom())
    glass = MirrorRoom(kind=Kind.GLASS).drive(*WAY)
    for _ in range(8):
        mirror.count(beams_of(glass), MappedFloor.of(drawn(glass)), HOME)
    assert math.dist(*mirror.ends(HOME)) < 0.3


def test_what_is_kept_of_it_lies_as_it_did() -> None:
    mirror = widened(MirrorRoom())
    again = Mirror.of(mirror.kept)
    assert (again.ends(HOME) == mirror.ends(HOME)).all()
    assert again.submap == mirror.submap
    assert not again.fits.any()


def test_it_goes_on_over_what_no_beam_shows_to_a_surface_that_is_seen() -> None:
    frames = MirrorRoom().drive(*WAY)
    beams, ground = beams_of(frames), MappedFloor.of(drawn(frames))
    plane = Plane(1.8, HEIGHT, math.pi / 2.0)
    behind = beams.ends[:, 1] > HEIGHT + 0.1
    ways = beams.ends - beams.starts
    share = (HEIGHT - beams.starts[:, 1]) / np.where(behind, ways[:, 1], 1.0)
    there = np.where(behind, beams.starts[:, 0] + share * ways[:, 0], 0.0)
    # Nothing shows the mirror from 2.25 m on; from 2.5 m on a wall is seen.
    mirror = Mirror.found(0, plane)
    mirror.count(beams.chosen(there < 2.25), ground, HOME)
    right, _ = mirror.ends(HOME)
    assert right[0] == pytest.approx(2.55, abs=0.1)
    # Where the wall is farther off than a robot is wide, it is not known to go on.
    narrower = Mirror.found(0, plane)
    narrower.count(beams.chosen(there < 2.0), ground, HOME)
    right, _ = narrower.ends(HOME)
    assert right[0] == pytest.approx(2.05, abs=0.1)
