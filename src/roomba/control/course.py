"""A path prepared for driving: its legs, and how fast its corners can be taken."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.configuration.loops import TrackingConfig
from roomba.control.tracking_kernels import Course

Floats = NDArray[np.float64]

SHORTEST_LEG: Final = 1e-4
"""m; points nearer to the one before are left out."""
_STRAIGHT: Final = 1e-6
"""rad."""


def course_of(points: Floats, config: TrackingConfig) -> Course:
    """Return the course along ``points``, float64 [n, 2], m.

    Soft corners are rounded off: over ``half`` m before and after a corner of a rad the heading
    changes evenly, which leaves the corner by half * a / 4. Where the curvature changes by k, the
    drive follows late by the way s, and is aside by k s^2 / 6; with the angular acceleration b it
    needs s = v^2 k / b. From both follows the speed at which it is aside by ``config.off_corner``.
    """
    legs = np.hypot(*np.diff(points, axis=0).T)
    points = np.ascontiguousarray(points[np.concatenate(([True], legs > SHORTEST_LEG))])
    ways = np.diff(points, axis=0)
    lengths = np.hypot(ways[:, 0], ways[:, 1])
    headings = np.arctan2(ways[:, 1], ways[:, 0])
    stations = np.concatenate(([0.0], np.cumsum(lengths)))
    corners = wrap_angles(np.diff(headings))
    through, halves = np.zeros(len(points)), np.zeros(len(points))
    if len(corners):
        is_soft = np.abs(corners) <= config.sharp_corner
        halves[1:-1] = np.where(is_soft, _halves(corners, lengths, config), 0.0)
        through[1:-1] = np.where(is_soft, _speeds(corners, lengths, halves, config), 0.0)
    return Course(points, headings, stations, through, halves)


def _halves(corners: Floats, lengths: Floats, config: TrackingConfig) -> Floats:
    """Return how far before and after each corner the heading changes, m."""
    wanted = 4.0 * config.off_corner / np.maximum(np.abs(corners), _STRAIGHT)
    room = 0.5 * np.minimum(lengths[:-1], lengths[1:])
    halves: Floats = np.minimum(np.minimum(wanted, config.longest_blend), room)
    return halves


def _speeds(corners: Floats, lengths: Floats, halves: Floats, config: TrackingConfig) -> Floats:
    """Return how fast each corner can be taken, m/s."""
    curvature = corners / (2.0 * np.maximum(halves[1:-1], SHORTEST_LEG))
    between = lengths[1:-1] - halves[1:-2] - halves[2:-1]
    is_joined = between < halves[1:-2] + halves[2:-1]
    joined = np.where(is_joined, np.abs(np.diff(curvature)), 0.0)
    before = np.abs(curvature).copy()
    after = np.abs(curvature).copy()
    before[1:] = np.where(is_joined, joined, before[1:])
    after[:-1] = np.where(is_joined, joined, after[:-1])
    change = np.maximum(np.maximum(before, after), 1e-9)
    speeds = math.sqrt(config.corner_acceleration) * (6.0 * config.off_corner) ** 0.25
    ramped = speeds / change**0.75
    turning = config.corner_turning / np.maximum(np.abs(curvature), 1e-9)
    slowest: Floats = np.maximum(np.minimum(ramped, turning), config.slowest_corner)
    return slowest
