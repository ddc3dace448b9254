"""The mirrors of a map that is being made.

A lidar takes what a mirror shows for a room behind it. The robot may see itself there. At the
latest it drives against the mirror, and so touches a thing that beams pass. If the beams show
behind that thing the image of what is before it, the thing is a mirror, and reaches to both sides
as far as that holds (compare Yang and Wang, "On solving mirror reflection in LIDAR sensing",
IEEE/ASME T-Mech 2011, who look for mirrors in gaps of walls).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.grid import OccupancyMap
from roomba.perception.slam.mirrors.images import Beams, MappedFloor, Plane
from roomba.perception.slam.mirrors.mirror import KeptMirror, Mirror, placed
from roomba.perception.slam.mirrors.own_image import own_image_planes
from roomba.perception.slam.mirrors.search import (
    Touch,
    seen_mirror,
    still_shows_itself,
    touched_mirror,
    ways_that_surfaces_face,
)
from roomba.perception.slam.submaps.pose_graph import composed, inverse
from roomba.perception.slam.submaps.submap import moved
from roomba.perception.slam.submaps.submap_graph import SubmapGraph

_NEAR: Final = 6.0
"""m; keyframes from nearer than this to a touch or a mirror are looked at."""
_MOST: Final = 400
"""Keyframes that are looked at, at most."""
_RECENT: Final = 120
"""Newest keyframes in which the robot's own image is searched for, when a submap ends."""
_SAME_TURN: Final = 0.1
_SAME_PLACE: Final = 0.08
_SAME_GAP: Final = 0.3
"""rad, m, m; mirrors are one if they differ less than this in angle, in plane, and in place."""


class PlacedPoints(NamedTuple):
    """A scan's ``points`` [n, 4], robot's frame, and the robot's ``pose`` [3], map frame."""

    points: NDArray[np.float32] | Floats
    pose: Floats


class Mirrors:
    """Mirrors in the frames of the graph's submaps."""

    def __init__(self, graph: SubmapGraph) -> None:
        """Begin without a mirror."""
        self._graph = graph
        self._mirrors: list[Mirror] = []

    def take_over(self, kept: Iterable[KeptMirror]) -> None:
        """Go on with the mirrors that another process had found."""
        self._mirrors = [Mirror.of(each) for each in kept]

    def __len__(self) -> int:
        """Return the number of mirrors."""
        return len(self._mirrors)

    @property
    def kept(self) -> tuple[KeptMirror, ...]:
        """The parts of the mirrors that are saved."""
        return tuple(mirror.kept for mirror in self._mirrors)

    @property
    def ends(self) -> Floats:
        """Ends of the mirrors where the graph places them, float64 [n, 2, 2], m, map frame."""
        poses = self._graph.poses
        return np.array([mirror.ends(poses[mirror.submap]) for mirror in self._mirrors]).reshape(
            -1, 2, 2
        )

    def feel(
        self, touch: Touch, newest: PlacedPoints, mount: Floats, occupancy: OccupancyMap
    ) -> bool:
        """Find out whether a mirror was touched; tell whether a mirror is new or changed by that.

        ``newest`` is the scan before the touch, which need not be a keyframe; ``mount``, x and y,
        m, is that of the lidar; ``occupancy`` the map as it is known.
        """
        scans = self._scans_near(touch.x, touch.y)
        beams, floor = _beams_of([*scans, newest], mount), MappedFloor.of(occupancy)
        plane = touched_mirror(beams, floor, touch)
        if plane is None:
            return False
        before = self.ends
        known = next((mirror for mirror in self._mirrors if self._is_of(plane, mirror)), None)
        if known is not None:
            known.seen_from = 0.0
            self._count_anew(known, beams, floor)
        if known is None or not self._reaches(known, plane):
            self._add(self._framed(len(self._graph.poses) - 1, plane), beams, floor)
        return not np.array_equal(self.ends, before)

    def see(self, number: int, mount: Floats, occupancy: Callable[[], OccupancyMap]) -> bool:
        """Update the reach of mirrors, and search for new ones, as a submap ends.

        Returns whether a mirror changed. ``occupancy`` makes the map as it is known, if that is
        needed. Keyframes that were counted before are not counted again.
        """
        poses, before, scans = self._graph.poses, self.ends, self._scans_of(number)
        if not scans:
            return False
        self._take_back(mount)
        first = sum(len(each.keyframes) for each in self._graph.submaps[:number])
        if self._mirrors:
            floor = MappedFloor.of(occupancy())
            for mirror in self._mirrors:
                new = scans[max(mirror.counted - first, 0) :]
                if not mirror.counted:
                    self._count_anew(mirror, self._beams_about(self._placed(mirror), mount), floor)
                elif new:
                    mirror.count(_beams_of(new, mount), floor, poses[mirror.submap])
                    mirror.counted = first + len(scans)
        self._look_for_itself(self._newest_scans(), mount, occupancy)
        return not np.array_equal(self.ends, before)

    def see_all(self, mount: Floats, occupancy: Callable[[], OccupancyMap]) -> bool:
        """Search for mirrors by all keyframes, once the drive is over; tell whether one changed.

        Known mirrors are counted anew, as keyframes have moved since.
        """
        before = self.ends
        self._take_back(mount)
        if self._mirrors:
            floor = MappedFloor.of(occupancy())
            for mirror in self._mirrors:
                self._count_anew(mirror, self._beams_about(self._placed(mirror), mount), floor)
        self._look_for_itself(_some(self._scans()), mount, occupancy)
        return not np.array_equal(self.ends, before)

    def _look_for_itself(
        self, scans: list[PlacedPoints], mount: Floats, occupancy: Callable[[], OccupancyMap]
    ) -> None:
        """Add mirrors on planes in which the robot saw itself, if the images of beams fit."""
        beams = _beams_of(scans, mount)
        for facing in ways_that_surfaces_face(beams):
            for plane, farthest in own_image_planes(beams, facing):
                if any(self._is_of(plane, mirror) for mirror in self._mirrors):
                    continue
                around = self._beams_about(plane, mount)
                floor = MappedFloor.of(occupancy())
                found = seen_mirror(around, floor, plane, farthest)
                if found is not None:
                    mirror = self._framed(self._nearest_before(found), found, farthest)
                    self._add(mirror, around, floor)

    def _take_back(self, mount: Floats) -> None:
        """Drop mirrors that were never touched, if scans no longer show the robot in them."""

        def is_left(mirror: Mirror) -> bool:
            plane = self._placed(mirror)
            return not mirror.seen_from or still_shows_itself(
                self._beams_about(plane, mount), plane, mirror.seen_from
            )

        self._mirrors = [mirror for mirror in self._mirrors if is_left(mirror)]

    def pass_through(self, start: Floats, end: Floats) -> bool:
        """Drop the mirrors between two places of the robot, [2], m, map frame: it drove through.

        Return whether there were any.
        """
        known = len(self._mirrors)
        poses = self._graph.poses
        self._mirrors = [
            mirror
            for mirror in self._mirrors
            if not _crosses(start, end, *mirror.ends(poses[mirror.submap]))
        ]
        return len(self._mirrors) < known

    def _scans_of(self, number: int) -> list[PlacedPoints]:
        """Return the scans of a submap's keyframes."""
        submap = self._graph.submaps[number]
        frames = zip(submap.keyframes, submap.poses(self._graph.poses[number]), strict=True)
        return [PlacedPoints(frame.points, pose) for frame, pose in frames]

    def _newest_scans(self) -> list[PlacedPoints]:
        scans = list[PlacedPoints]()
        for number in reversed(range(len(self._graph.submaps))):
            if len(scans) >= _RECENT:
                break
            scans = self._scans_of(number) + scans
        return scans[-_RECENT:]

    def _scans(self) -> list[PlacedPoints]:
        """Return the scans of all keyframes, in the order of time."""
        return [PlacedPoints(frame.points, pose) for frame, pose in self._graph.keyframes()]

    def _scans_near(self, x: float, y: float) -> list[PlacedPoints]:
        return _some([s for s in self._scans() if math.dist(s.pose[:2], (x, y)) < _NEAR])

    def _beams_about(self, plane: Plane, mount: Floats) -> Beams:
        """Return the beams of scans that were taken near the middle of a plane, map frame."""
        return _beams_of(self._scans_near(plane.x, plane.y), mount)

    def _placed(self, mirror: Mirror) -> Plane:
        """Return a mirror's plane, map frame."""
        return placed(mirror.plane, self._graph.poses[mirror.submap])

    def _framed(self, submap: int, plane: Plane, seen_from: float = 0.0) -> Mirror:
        """Return a mirror on a plane, map frame, in the frame of the submap with a number."""
        return Mirror.found(submap, placed(plane, inverse(self._graph.poses[submap])), seen_from)

    def _nearest_before(self, plane: Plane) -> int:
        """Return the number of the submap with the keyframe that is nearest before a plane."""
        nearest, away = len(self._graph.submaps) - 1, math.inf
        for number in range(len(self._graph.submaps)):
            for scan in self._scans_of(number):
                off = scan.pose[:2] - plane.middle
                if float(off @ plane.normal) < 0.0 and math.hypot(*off) < away:
                    nearest, away = number, math.hypot(*off)
        return nearest

    def _add(self, mirror: Mirror, beams: Beams, floor: MappedFloor) -> None:
        """Add a mirror, unless the robot drove through it before."""
        self._count_anew(mirror, beams, floor)
        ends = mirror.ends(self._graph.poses[mirror.submap])
        ways = self._graph.driven_ways()
        if not any(_crosses(*step, *ends) for way in ways for step in pairwise(way)):
            self._mirrors.append(mirror)

    def _count_anew(self, mirror: Mirror, beams: Beams, floor: MappedFloor) -> None:
        """Count a mirror anew, by the beams of all keyframes that were taken near it."""
        mirror.forget()
        mirror.count(beams, floor, self._graph.poses[mirror.submap])
        mirror.counted = sum(len(submap.keyframes) for submap in self._graph.submaps)

    def _is_of(self, plane: Plane, mirror: Mirror) -> bool:
        """Whether a plane is a mirror's, and the plane's middle on the mirror, or near it."""
        other = self._placed(mirror)
        turn = float(np.cos(plane.facing - other.facing))
        off = abs(float((plane.middle - other.middle) @ other.normal))
        is_alike = turn > np.cos(_SAME_TURN) and off < _SAME_PLACE
        return is_alike and self._reaches(mirror, plane, _SAME_GAP)

    def _reaches(self, mirror: Mirror, plane: Plane, spare: float = 0.0) -> bool:
        """Whether a mirror reaches to the middle of a plane, or to ``spare`` m before that."""
        other, (right, left) = self._placed(mirror), mirror.reach
        place = float((plane.middle - other.middle) @ other.along)
        return -right - spare <= place <= left + spare


def _some(scans: list[PlacedPoints]) -> list[PlacedPoints]:
    """Return all scans, or :data:`_MOST` at most, evenly chosen, as more take long."""
    return scans[:: -(-len(scans) // _MOST) or 1]


def _beams_of(scans: list[PlacedPoints], mount: Floats) -> Beams:
    """Return the beams of scans that met something, map frame."""
    if not scans:
        return Beams(*np.zeros((3, 0, 2)))
    points = np.concatenate([moved(scan.points, scan.pose) for scan in scans])
    poses = np.array([scan.pose for scan in scans])
    lidar = np.broadcast_to(np.array([*mount[:2], 0.0]), poses.shape)
    counts = [len(scan.points) for scan in scans]
    starts = np.repeat(composed(poses, lidar)[:, :2], counts, axis=0)
    return Beams(starts, points[:, :2], points[:, 2:])


def _crosses(start: Floats, end: Floats, right: Floats, left: Floats) -> bool:
    """Whether a way crosses a line."""

    def side(a: Floats, b: Floats, point: Floats) -> float:
        return float((b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]))

    return (
        side(right, left, start) * side(right, left, end) < 0.0
        and side(start, end, right) * side(start, end, left) < 0.0
    )
