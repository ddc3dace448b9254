"""What beams show behind a plane: images of a mirror fit what is before it, others do not."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.drives.mirror_room import HEIGHT, WIDTH, Kind, MirrorRoom, beams_of, drawn

from roomba.perception.slam.mirrors.images import (
    Beams,
    Images,
    MappedFloor,
    Plane,
    images,
    own_images,
    places_of_ends,
)

UPPER_WALL = Plane(1.8, HEIGHT, np.pi / 2.0)
WAY = ((0.6, 0.6), (3.4, 0.6), (1.8, 2.2))


def seen(kind: Kind) -> tuple[Beams, Images]:
    frames = MirrorRoom(kind=kind).drive(*WAY)
    beams = beams_of(frames)
    return beams, images(beams, UPPER_WALL, MappedFloor.of(drawn(frames)))


def test_images_of_a_mirror_fit_where_it_is() -> None:
    _, shown = seen(Kind.MIRROR)
    # From 1.0 to 2.5 m: 0.8 m to the left of one who looks at it, and 0.7 to the right.
    assert shown.places.min() == pytest.approx(-0.7, abs=0.02)
    assert shown.places.max() == pytest.approx(0.8, abs=0.02)
    assert shown.fits.mean() > 0.9
    assert not (shown.fits & shown.contradicts).any()
    assert (shown.fits & shown.informs).sum() > 100


def test_what_is_seen_through_glass_contradicts() -> None:
    _, shown = seen(Kind.GLASS)
    assert (shown.fits & shown.informs).sum() < 0.3 * (shown.contradicts & shown.informs).sum()


def test_no_beam_passes_a_wall() -> None:
    beams, shown = seen(Kind.WALL)
    assert not len(shown.places)
    on_it = places_of_ends(beams, UPPER_WALL)
    assert len(on_it) > 100
    assert on_it.min() > -(WIDTH - 1.8) - 0.1
    assert on_it.max() < 1.8 + 0.1


def test_the_robot_sees_itself_in_a_mirror_alone() -> None:
    for kind, sees_itself in ((Kind.MIRROR, True), (Kind.GLASS, False), (Kind.WALL, False)):
        beams = beams_of([MirrorRoom(kind=kind).keyframe(1.8, 2.4)])
        assert own_images(beams, UPPER_WALL).any() == sees_itself


def test_its_own_image_fits_though_floor_is_free_where_it_stood() -> None:
    room = MirrorRoom()
    ground = MappedFloor.of(drawn(room.drive((0.6, 0.6), (3.4, 0.6), (1.8, 2.4))))
    beams = beams_of([room.keyframe(1.8, 2.4)])
    own = beams.chosen(own_images(beams, UPPER_WALL))
    shown = images(own, UPPER_WALL, ground)
    assert len(shown.places) == len(own.starts) > 10
    assert shown.fits.all()
    assert shown.informs.all()
    assert not shown.contradicts.any()


def test_a_plane_turns_points_over_to_its_other_side_and_back() -> None:
    plane = Plane(1.8, HEIGHT, 0.4)
    points = np.array([[0.3, -2.0], [4.0, 1.0], [1.8, HEIGHT]])
    over = plane.turned_over(points)
    assert plane.turned_over(over) == pytest.approx(points)
    off, off_over = ((each - plane.middle) @ plane.normal for each in (points, over))
    assert off_over == pytest.approx(-off)
    assert (over - points) @ plane.along == pytest.approx(np.zeros(3))
