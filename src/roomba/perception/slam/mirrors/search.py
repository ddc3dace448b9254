"""The search for a mirror's plane, near a plane that was touched or seen, by the beams' images."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.geometry import wrap_angle
from roomba.perception.slam.mirrors.images import (
    Beams,
    Flags,
    MappedFloor,
    Plane,
    count_of_places,
    images,
    own_images,
)

_TURNS: Final = np.radians(np.arange(-3.0, 3.01, 0.5))
_SHIFTS: Final = np.arange(-0.06, 0.061, 0.01)
"""rad and m; turns and shifts that are tried about the expected plane."""
_SPARE: Final = 0.1
"""rad; the touched plane may face so far beyond the pressed part of the bumper."""
_ASIDE: Final = 0.12
"""m; a beam passed the plane's middle if it went by less than this beside the middle."""
_BEYOND: Final = 0.25
"""m; a beam counts as one that passed if it also ended more than this behind the plane."""
_LEAST: Final = 25
"""The fewest beams that passed the plane; fewer show nothing."""
_LEAST_INFORMING: Final = 10
"""The fewest beams whose images fit a mirror and tell something."""
_LEAST_FITTING: Final = 0.4
"""The least share of the beams that passed whose images fit a mirror."""
_LEAST_SHARE: Final = 0.7
"""The least share that fits of all images that fit or contradict: of true mirrors 0.72 to 0.93, of
glass 0.04 to 0.6."""
_BEFORE: Final = 1.0
_BEFORE_ASIDE: Final = 0.3
"""m; so near before a mirror, and so near beside its middle, a robot sees itself."""
_LEAST_STOOD: Final = 2
"""The fewest places so near to a mirror where the robot was, if it touched the mirror."""
_LEAST_STOOD_AWAY: Final = 3
"""The fewest places so near to a mirror where the robot was, if it did not touch the mirror."""
_LEAST_SHOWN: Final = 0.6
"""The least share of scans from there that show the robot: at true mirrors all do, at glass a tenth
at most."""
_ALIKE: Final = 0.02
"""Share of the beams; planes fit alike if their numbers of fitting images differ by no more."""
_MOST: Final = 1500
"""Beams that are looked at, at most."""


class FoundMirror(NamedTuple):
    """The ``plane`` of a mirror, of which ``net`` more images fit than contradict."""

    net: int
    plane: Plane


class Touch(NamedTuple):
    """A touch of a round body, map frame: its middle ``x``, ``y`` and its ``radius``, m.

    The part of its rim that was pressed has the bearings from ``first`` to ``last``, rad.
    """

    x: float
    y: float
    radius: float
    first: float
    last: float

    def plane(self, facing: float) -> Plane:
        """Return the plane that touches the body on the side ``facing``, rad, and faces away."""
        return Plane(self.x, self.y, facing).moved(0.0, self.radius)

    def has_pressed(self, facing: float) -> bool:
        """Whether that plane may have pressed the pressed part of the rim."""
        off = wrap_angle(facing - 0.5 * (self.first + self.last))
        return abs(off) <= 0.5 * (self.last - self.first) + _SPARE


def touched_mirror(beams: Beams, floor: MappedFloor, touch: Touch) -> Plane | None:
    """Return the plane of the mirror that was touched; None if it seems to be none.

    Mirrors hang on walls, or are the sides of furniture. So only planes parallel or at right angles
    to most surfaces are tried. In an oblique plane a corner of two walls would often be its own
    image.
    """
    found = [
        _mirror_about(beams, floor, touch.plane(facing), _BEFORE, _LEAST_STOOD)
        for facing in ways_that_surfaces_face(beams)
        if touch.has_pressed(facing)
    ]
    good = [each for each in found if each is not None]
    return max(good).plane if good else None


def seen_mirror(beams: Beams, floor: MappedFloor, about: Plane, farthest: float) -> Plane | None:
    """Return the plane of a mirror in which the robot saw itself, from ``farthest`` m away on.

    Return None if there seems to be no mirror near the plane ``about``.
    """
    found = _mirror_about(beams, floor, about, farthest, _LEAST_STOOD_AWAY)
    return None if found is None else found.plane


def still_shows_itself(beams: Beams, plane: Plane, farthest: float) -> bool:
    """Whether a supposed mirror still shows the robot, which saw itself from ``farthest`` m on.

    All scans from before the plane count. If it was only a thing that came towards the robot, most
    scans do not show the robot any more once it has driven there again.
    """
    return _shows_itself(beams, plane, farthest, _LEAST_STOOD_AWAY)


def ways_that_surfaces_face(beams: Beams) -> list[float]:
    """Return the four directions, rad, at right angles, that most surfaces face."""
    angles = np.arctan2(beams.normals[:, 1], beams.normals[:, 0])[_is_known(beams.normals)]
    turn = float(np.angle(np.exp(4.0j * angles).sum())) / 4.0
    return [turn + quarter * math.pi / 2.0 for quarter in range(4)]


def _mirror_about(
    beams: Beams, floor: MappedFloor, about: Plane, before: float, stood: int
) -> FoundMirror | None:
    """Return the mirror near a plane; None if there seems to be none.

    The robot must have seen itself in the mirror from less than ``before`` m away, from ``stood``
    places or more.
    """
    near = _that_passed(beams, about)
    count = len(near.starts)
    if count < _LEAST:
        return None
    tried = [(turn, shift) for turn in _TURNS for shift in _SHIFTS]
    net = np.array([_net(near, floor, about.moved(turn, shift)) for turn, shift in tried])
    # Cells are coarse, so that several planes fit alike: take their mean.
    alike = net >= net.max() - _ALIKE * count
    turn, shift = np.array(tried)[alike].mean(axis=0).tolist()
    plane = about.moved(turn, shift)
    is_mirror = _is_mirror(near, floor, plane) and _shows_itself(beams, plane, before, stood)
    return FoundMirror(int(net.max()), plane) if is_mirror else None


def _net(beams: Beams, floor: MappedFloor, plane: Plane) -> int:
    """Return the number of images that fit, less those that contradict."""
    seen = images(beams, plane, floor)
    return int(seen.fits.sum()) - int(seen.contradicts.sum())


def _is_mirror(beams: Beams, floor: MappedFloor, plane: Plane) -> bool:
    """Whether beams that passed a plane show that it is one."""
    seen = images(beams, plane, floor)
    fitting, against = int(seen.fits.sum()), int(seen.contradicts.sum())
    return (
        fitting >= _LEAST_SHARE * (fitting + against)
        and fitting >= _LEAST_FITTING * len(beams.starts)
        and int((seen.fits & seen.informs).sum()) >= _LEAST_INFORMING
    )


def _shows_itself(beams: Beams, plane: Plane, before: float, least: int) -> bool:
    """Whether the robot saw itself in a plane when it was before the plane's middle.

    It must have been at ``least`` places, up to ``before`` m off. Without this test the middle of a
    symmetric room, with two walls alike, would be a mirror.
    """
    off = beams.starts - plane.middle
    away, aside = -off @ plane.normal, np.abs(off @ plane.along)
    near = beams.chosen((away > 0.0) & (away < before) & (aside < _BEFORE_ASIDE))
    scans = len(np.unique(near.starts, axis=0))
    shown = len(np.unique(near.starts[own_images(near, plane)], axis=0))
    return count_of_places(near.starts) >= least and shown >= _LEAST_SHOWN * scans


def _that_passed(beams: Beams, plane: Plane) -> Beams:
    """Return the beams that passed the middle of a plane, or a part of them if there are many."""
    ways = beams.ends - beams.starts
    lengths = np.hypot(ways[:, 0], ways[:, 1])
    to_middle = plane.middle - beams.starts
    along = np.einsum("ij,ij->i", to_middle, ways) / lengths
    aside = np.abs(to_middle[:, 0] * ways[:, 1] - to_middle[:, 1] * ways[:, 0]) / lengths
    passed = (aside < _ASIDE) & (along > 0.0) & (lengths > along + _BEYOND)
    numbers = np.flatnonzero(passed)
    return beams.chosen(numbers[:: -(-len(numbers) // _MOST) or 1])


def _is_known(normals: Floats) -> Flags:
    known: Flags = np.any(normals != 0.0, axis=1)
    return known
