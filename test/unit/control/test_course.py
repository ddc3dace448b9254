"""A path made ready: its sections, its curve, and how fast that may be driven."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.control.course import SHORTEST_LEG, course_of
from roomba.control.curve_kernels import Course

BODY, CONFIG = RobotConfig().body, RobotConfig().tracking
ROUNDING = 1e-9
STRAIGHT = 1e-6
"""1/m; less is no bend to a side."""

Legs = list[tuple[float, float]]
Floats = NDArray[np.float64]


def path(*legs: tuple[float, float]) -> Floats:
    """Return the points along legs: how much it turns before each, rad, and its length, m."""
    headings = itertools.accumulate(turn for turn, _ in legs)
    ways = [
        (way * math.cos(a), way * math.sin(a)) for a, (_, way) in zip(headings, legs, strict=True)
    ]
    return np.concatenate((np.zeros((1, 2)), np.cumsum(np.array(ways), axis=0)))


def course(*legs: tuple[float, float]) -> Course:
    return course_of(path(*legs), CONFIG, BODY)


def curve(course: Course, section: int = 0) -> NDArray[np.void]:
    """Return the samples of a section."""
    row = course.sections[section]
    samples: NDArray[np.void] = course.samples[row["first"] : row["last"] + 1]
    return samples


def places(samples: NDArray[np.void]) -> Floats:
    return np.column_stack((samples["x"], samples["y"]))


lengths = st.floats(0.001, 1.0)
any_legs = st.lists(st.tuples(st.floats(-math.pi, math.pi), lengths), min_size=1, max_size=12)
soft_legs = st.lists(st.tuples(st.floats(-0.49, 0.49), lengths), min_size=2, max_size=12)


@given(any_legs)
def test_points_and_stations_are_those_of_the_path(legs: Legs) -> None:
    made = course(*legs)
    assert made.points == pytest.approx(path(*legs))
    assert made.stations[0] == 0.0
    assert np.diff(made.stations) == pytest.approx([way for _, way in legs])


@given(any_legs)
def test_sections_end_at_sharp_corners_and_nowhere_else(legs: Legs) -> None:
    made = course(*legs)
    sharp = [0]
    for leg, (turn, _) in enumerate(legs[1:], start=1):
        # Rounding would tell on which side it is.
        assume(abs(abs(turn) - CONFIG.sharp_corner) > 1e-6)
        if abs(turn) > CONFIG.sharp_corner:
            sharp.append(leg)
    assert made.sections["leg"].tolist() == sharp
    assert made.sections["end_leg"].tolist() == [*sharp[1:], len(legs)]
    assert made.sections["begin"] == pytest.approx(made.stations[sharp])
    assert made.sections["end"] == pytest.approx(made.stations[made.sections["end_leg"]])
    assert len(made.samples) == made.sections["last"][-1] + 1
    assert (made.sections["first"][1:] == made.sections["last"][:-1] + 1).all()


@given(any_legs)
def test_the_curve_stays_near_its_path_from_end_to_end(legs: Legs) -> None:
    made = course(*legs)
    for row, section in enumerate(made.sections):
        points = made.points[section["leg"] : section["end_leg"] + 1]
        found = places(curve(made, row))
        off = shapely.distance(shapely.LineString(points), shapely.points(found))
        assert off.max() <= CONFIG.off_corner + ROUNDING
        # Corners lie beside the curve, too; between two samples that cuts them off.
        off = shapely.distance(shapely.LineString(found), shapely.points(points))
        assert off.max() <= CONFIG.off_corner + 0.001
        for end in (0, -1):
            assert np.hypot(*(found[end] - points[end])) <= CONFIG.off_corner + ROUNDING


def test_a_straight_section_is_told_by_its_ends() -> None:
    made = course((0.3, 2.0), (2.0, 1.0))
    assert len(made.samples) == 4
    assert curve(made)["heading"] == pytest.approx(0.3)
    assert curve(made, 1)["heading"] == pytest.approx(2.3)
    assert (made.samples["curvature"] == 0.0).all()
    assert made.samples["speed"] == pytest.approx(BODY.max_speed)


@given(soft_legs)
def test_headings_and_curvature_are_those_of_the_places(legs: Legs) -> None:
    samples = curve(course(*legs))
    found, step = places(samples), np.hypot(*np.diff(places(samples), axis=0).T)
    between = np.unwrap(np.arctan2(*np.diff(found, axis=0).T[::-1]))
    middle = 0.5 * (between[:-1] + between[1:])
    assert np.cos(samples["heading"][1:-1] - middle) == pytest.approx(1.0)
    assert (np.abs(np.diff(samples["heading"])) < CONFIG.sharp_corner).all()
    # All that the headings turn is what the curvature says.
    turned = samples["heading"][-1] - samples["heading"][0]
    bends = 0.5 * (samples["curvature"][1:] + samples["curvature"][:-1]) * step
    # Each bend is told by samples, and is off by a share of itself, to whichever side it turns.
    assert bends.sum() == pytest.approx(turned, abs=0.01 + 0.05 * np.abs(bends).sum())


@given(soft_legs)
def test_speeds_are_what_drive_and_brakes_can_do(legs: Legs) -> None:
    made = course(*legs)
    samples, section = curve(made), made.sections[0]
    step = (section["end"] - section["begin"]) / (len(samples) - 1)
    speeds = samples["speed"]
    assert (speeds >= CONFIG.slowest_corner - ROUNDING).all()
    assert (speeds <= BODY.max_speed + ROUNDING).all()
    energy = np.diff(speeds**2) / (2.0 * step)
    assert energy.max(initial=0.0) <= BODY.max_acceleration + ROUNDING
    assert energy.min(initial=0.0) >= -CONFIG.braking - ROUNDING
    is_free = speeds > CONFIG.slowest_corner + ROUNDING
    turning = speeds * np.abs(samples["curvature"])
    assert (turning[is_free] <= CONFIG.corner_turning + ROUNDING).all()
    outer = speeds + 0.5 * BODY.wheel_separation * turning
    assert (outer[is_free] <= BODY.max_speed + ROUNDING).all()
    before, after = samples["curvature"][:-2], samples["curvature"][2:]
    faster = speeds[1:-1] ** 2 * np.abs(after - before) / (2.0 * step)
    changes_sides = (before * after < 0.0) & (np.minimum(np.abs(before), np.abs(after)) > STRAIGHT)
    opens = ~changes_sides & (np.abs(after) <= np.abs(before))
    most = np.where(opens, CONFIG.corner_braking, CONFIG.corner_acceleration)
    assert (faster <= most + 1e-6)[is_free[1:-1]].all()


@pytest.mark.parametrize("limit", ["body", "tracking"])
def test_bends_are_no_faster_than_the_robot_can_turn(limit: str) -> None:
    body, config = BODY, CONFIG
    if limit == "body":
        body = BODY.model_copy(update={"max_angular_speed": 1.0})
    else:
        config = CONFIG.model_copy(update={"turning_speed": 1.0})
    samples = curve(course_of(path((0.0, 1.0), (0.25, 1.0)), config, body))
    turning = samples["speed"] * np.abs(samples["curvature"])
    assert turning.max() == pytest.approx(1.0)


def test_a_section_begins_as_fast_as_it_may_by_itself() -> None:
    # The one before it ends in a tight bend, and between both it turns on the spot.
    made = course((0.0, 0.3), (0.48, 0.01), (2.0, 0.3), (0.01, 0.3))
    assert curve(made)["speed"][-1] < 0.3
    assert curve(made, 1)["speed"][0] == pytest.approx(BODY.max_speed)


@given(st.floats(0.05, 0.3))
def test_a_corner_by_itself_is_as_wide_as_it_may_be(turn: float) -> None:
    samples = curve(course((0.0, 1.0), (turn, 1.0)))
    half = min(6.0 * CONFIG.off_corner / turn, CONFIG.longest_blend)
    bent = np.flatnonzero(np.abs(samples["curvature"]) > 1e-6) * 2.0 / (len(samples) - 1)
    assert bent.min() == pytest.approx(1.0 - half, abs=0.012)
    assert bent.max() == pytest.approx(1.0 + half, abs=0.012)
    nearest = np.hypot(*(places(samples) - (1.0, 0.0)).T).min()
    assert nearest == pytest.approx(turn * half / 6.0, abs=2e-4)


def test_the_softer_a_corner_the_faster() -> None:
    speeds = [
        float(curve(course((0.0, 1.0), (turn, 1.0)))["speed"].min())
        for turn in (0.05, 0.1, 0.2, 0.3)
    ]
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[0] > 0.3
    assert speeds[-1] < 0.2


def test_an_arc_of_short_legs_is_an_arc() -> None:
    # As around the corner of a wall, 0.17 m from it; legs of grid paths are not of one length.
    around = np.cumsum(np.tile([0.11, 0.15, 0.19, 0.13], 3))
    points = 0.17 * np.column_stack((np.sin(around), 1.0 - np.cos(around)))
    samples = curve(course_of(points, CONFIG, BODY))
    middle = samples[len(samples) // 4 : 3 * len(samples) // 4]
    assert middle["curvature"] == pytest.approx(1.0 / 0.17, rel=0.15)
    assert middle["speed"].min() > 0.25


@pytest.mark.parametrize("length", [0.01, 0.05, 0.15, 0.25, 1.0])
def test_sections_as_long_as_a_grid_makes_them_have_room(length: float) -> None:
    # The mean reaches over a whole number of samples: rounding may tell one more or one less.
    for turn in (0.1, -0.3):
        for scale in np.linspace(1.0 - 1e-15, 1.0 + 1e-15, 7):
            made = course((0.0, 0.5 * length * scale), (turn, 0.5 * length * scale))
            section = made.sections[0]
            step = (section["end"] - section["begin"]) / (section["last"] - section["first"])
            assert section["around"] * step >= CONFIG.longest_blend - ROUNDING


def test_a_section_that_begins_in_a_bend_is_bent_from_its_first_sample() -> None:
    around = np.linspace(0.0, 2.0, 60)
    points = 0.3 * np.column_stack((np.sin(around), 1.0 - np.cos(around)))
    # A sharp corner before it: so the bend begins with a section.
    made = course_of(np.vstack(((-0.2, 0.2), points)), CONFIG, BODY)
    samples = curve(made, 1)
    inside = samples["curvature"][len(samples) // 2]
    assert inside == pytest.approx(1.0 / 0.3, rel=0.05)
    assert samples["curvature"][len(samples) // 4 : -len(samples) // 4] == pytest.approx(
        inside, rel=0.1
    )
    # Towards its ends the path is thought to go straight on: it bends less, evenly.
    assert (np.abs(np.diff(samples["curvature"])) < 0.2 * inside).all()


def test_points_that_are_nearly_the_same_are_one() -> None:
    points = np.array([(0.0, 0.0), (1.0, 0.0), (1.0 + 0.5 * SHORTEST_LEG, 0.0), (2.0, 0.0)])
    made = course_of(points, CONFIG, BODY)
    assert len(made.points) == 3
    assert made.stations[-1] == pytest.approx(2.0)
    assert len(course_of(points[:1], CONFIG, BODY).sections) == 0


def test_headings_are_compared_around_the_circle() -> None:
    # From nearly pi to nearly -pi is a soft corner to the left.
    made = course((math.pi - 0.05, 1.0), (0.1, 1.0))
    assert len(made.sections) == 1
    headings = made.samples["heading"]
    assert headings[-1] - headings[0] == pytest.approx(0.1)


def test_it_speeds_up_in_a_bend_as_the_turning_speed_can() -> None:
    # A tight corner, and an even bend behind it: there the turning speed grows with the speed.
    samples = curve(course((0.0, 0.3), (0.48, 0.02), *[(0.1, 0.012)] * 20))
    step = (0.3 + 0.02 + 20 * 0.012) / (len(samples) - 1)
    speeds, bends = samples["speed"], np.abs(samples["curvature"])
    gained = np.diff(speeds**2)[1:] / (2.0 * step)
    tightening = (bends[2:] - bends[:-2]) / (2.0 * step)
    rates = gained * bends[1:-1] + speeds[1:-1] ** 2 * tightening
    is_free = (speeds[1:-1] > CONFIG.slowest_corner + ROUNDING) & (gained > 0.0)
    assert is_free.sum() > 5
    assert rates[is_free].max() <= CONFIG.corner_acceleration + 1e-6
    # Without that, it would speed up as much as on a straight way.
    is_bound = is_free & (rates > 0.9 * CONFIG.corner_acceleration)
    assert is_bound.sum() > 3
    assert gained[is_bound].max() < BODY.max_acceleration


def test_no_bend_is_taken_faster_than_the_body_turns_up_and_down() -> None:
    slow = BODY.model_copy(update={"max_angular_acceleration": 2.0, "max_deceleration": 0.4})
    corners = path((0.0, 0.3), *[(0.3, 0.02), (-0.3, 0.02)] * 5, (0.3, 0.3))
    made = course_of(corners, CONFIG, slow)
    samples = curve(made)
    step = float(made.stations[-1]) / (len(samples) - 1)
    before, after = samples["curvature"][:-2], samples["curvature"][2:]
    speeds = samples["speed"][1:-1]
    rates = speeds**2 * np.abs(after - before) / (2.0 * step)
    is_free = speeds > CONFIG.slowest_corner + ROUNDING
    opens = (before * after >= 0.0) & (np.abs(after) <= np.abs(before))
    for those, most in (
        (is_free & ~opens, slow.max_angular_acceleration),
        (is_free & opens, slow.max_angular_deceleration),
    ):
        assert 0.9 * most < rates[those].max() <= most + 1e-6


@given(
    st.sampled_from([0.37, 0.5, 1.0]),
    st.lists(st.sampled_from([-0.45, -0.375, 0.2, 0.375, 0.45]), min_size=1, max_size=4),
    st.floats(0.0, math.tau),
    st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0)),
)
def test_the_heading_of_a_whole_path_changes_nothing(
    way: float, turns: list[float], heading: float, place: tuple[float, float]
) -> None:
    legs = [(turn, way) for turn in turns]
    plain = course((0.0, way), *legs).samples
    moved = course_of(path((heading, way), *legs) + place, CONFIG, BODY).samples
    assert len(moved) == len(plain)
    assert moved["speed"] == pytest.approx(plain["speed"], abs=1e-6)
