"""Following a path, against a search over many places along it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.loops import WalkConfig
from roomba.geometry import Pose
from roomba.mission.walking.path_follower import PathFollower
from roomba.planning.path.polyline import Path

CONFIG = WalkConfig()
SHARP, CORNER_REACHED, BRAKING, SLOWEST = 0.3, 0.04, 0.4, 0.08
CUT = 0.005
FAST = 0.5


@st.composite
def paths(draw: st.DrawFn) -> Path:
    """Up to six legs of 0.1 to 1 m, with turns of all angles but back."""
    x, y, heading = 0.0, 0.0, 0.0
    points = [(x, y)]
    for _ in range(draw(st.integers(1, 6))):
        heading += draw(st.sampled_from([0.0, 0.2, -0.25, 0.5, -1.0, math.pi / 2, -2.5]))
        length = draw(st.integers(1, 10)) / 10
        x, y = x + length * math.cos(heading), y + length * math.sin(heading)
        points.append((x, y))
    return Path(np.array(points))


def walked(path: Path, follower: PathFollower, max_speed: float) -> list[tuple[float, float]]:
    """Go exactly along the path; return the way gone and the speed at each step.

    The setpoint is checked as it goes: on the path, ahead, and never beyond a sharp corner that was
    not reached.
    """
    corners = [
        (float(station), path.point_at(float(station)))
        for station, angle in zip(path.stations[1:-1], path.corner_angles[1:-1], strict=True)
        if abs(angle) > SHARP
    ]
    speeds = []
    for along in np.arange(0.0, path.length, 0.05).tolist():
        x, y = path.point_at(along)
        setpoint, speed = follower.tick(Pose(x, y, 0.0), max_speed)
        gone = path.length - follower.left
        reach = min(gone + CONFIG.lookahead, path.length)
        waiting = [
            station
            for station, corner in corners
            if gone <= station <= reach and math.dist(corner, (x, y)) > CORNER_REACHED
        ]
        check_setpoint(path, gone, setpoint, min([reach, *waiting]))
        speeds.append((gone, speed))
    return speeds


def check_setpoint(path: Path, gone: float, setpoint: tuple[float, float], most: float) -> None:
    """It is as far ahead as it may be, and the straight way to it cuts no bend by too much."""
    if cut_by(path, gone, most) <= CUT - 1e-9:
        assert setpoint == pytest.approx(path.point_at(most), abs=1e-9)
        return
    ahead = path.project(*setpoint, gone, CONFIG.lookahead)
    assert math.dist(path.point_at(ahead), setpoint) < 1e-9
    assert ahead <= most + 1e-9
    least = min(gone + 2.0 * CORNER_REACHED, most)
    assert ahead >= least - 1e-9
    assert ahead == pytest.approx(least, abs=0.003) or cut_by(path, gone, ahead) <= CUT + 1e-9
    assert ahead == pytest.approx(most, abs=1e-9) or cut_by(path, gone, ahead + 0.003) > CUT - 1e-9


def cut_by(path: Path, start: float, end: float) -> float:
    """How far the path between two places on it leaves the straight way between them."""
    (x, y), (to_x, to_y) = path.point_at(start), path.point_at(end)
    along = np.array((to_x - x, to_y - y)) / max(math.hypot(to_x - x, to_y - y), 1e-12)
    between = [path.point_at(s) for s in np.linspace(start, end, 400)]
    return float(max(abs(along[0] * (py - y) - along[1] * (px - x)) for px, py in between))


@given(paths(), st.sampled_from([0.1, FAST]))
@settings(max_examples=examples(30))
def test_the_setpoint_runs_ahead_and_waits_at_sharp_corners(path: Path, fastest: float) -> None:
    speeds = walked(path, PathFollower(path, CONFIG), fastest)
    assert all(min(SLOWEST, fastest) <= speed <= fastest for _, speed in speeds)


@given(paths())
@settings(max_examples=examples(30))
def test_all_corners_ahead_can_be_braked_for(path: Path) -> None:
    """At a right angle it goes at the corner's speed, at less of one in between."""
    for gone, speed in walked(path, PathFollower(path, CONFIG), FAST):
        for station, angle in zip(path.stations[1:-1], path.corner_angles[1:-1], strict=True):
            # Whether a corner that was just reached lies ahead is a matter of rounding.
            if station < gone + 1e-6:
                continue
            share = min(abs(float(angle)) / (math.pi / 2), 1.0)
            through = FAST + share * (CONFIG.corner_speed - FAST)
            assert speed**2 <= through**2 + 2.0 * BRAKING * (station - gone) + 1e-9


@given(paths(), st.tuples(st.floats(-0.5, 2.0), st.floats(-0.5, 0.5)))
@settings(max_examples=examples(30))
def test_how_far_off_the_path_it_is_and_how_much_is_left(
    path: Path, place: tuple[float, float]
) -> None:
    follower = PathFollower(path, CONFIG)
    assert follower.left == pytest.approx(path.length)
    follower.tick(Pose(*place, 0.0), FAST)
    # It looks for itself no more than 0.6 m along the path from where it last was.
    stations = np.linspace(0.0, min(0.6, path.length), 601).tolist()
    away = [math.dist(path.point_at(station), place) for station in stations]
    assert follower.distance_off(Pose(*place, 0.0)) == pytest.approx(min(away), abs=1e-3)
    assert 0.0 <= path.length - follower.left <= 0.6 + 1e-9


@pytest.mark.parametrize("radius", [0.1, 0.2, 0.5])
def test_around_a_bend_of_many_small_ones_the_setpoint_comes_nearer(radius: float) -> None:
    """None of them is sharp; all together they would be cut by as much as one that is."""
    angles = np.linspace(0.0, math.pi, 33)
    path = Path(radius * np.column_stack((np.sin(angles), 1.0 - np.cos(angles))))
    follower = PathFollower(path, CONFIG)
    assert np.abs(path.corner_angles).max() < SHARP
    for along in np.arange(0.0, path.length - CONFIG.lookahead, 0.01).tolist():
        x, y = path.point_at(along)
        (to_x, to_y), _ = follower.tick(Pose(x, y, 0.0), FAST)
        # The middle of the straight way is as near to the circle as it may be.
        off = radius - math.hypot(0.5 * (x + to_x), 0.5 * (y + to_y) - radius)
        assert 0.5 * CUT < off < 1.2 * CUT or radius == 0.1
