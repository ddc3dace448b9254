"""Where the robot came from, and the way back over it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Point, Pose
from roomba.mission.driving.trail import Trail

CONFIG = RobotConfig()
LONGEST = 5.0
"""m; about as much of the way is remembered."""


def nowhere(place: Point) -> None:
    return None


def places_of(trail: Trail) -> NDArray[np.float64]:
    """Return what is remembered, the newest first."""
    asked: list[Point] = []

    def plan(place: Point) -> NDArray[np.float64] | None:
        asked.append(place)
        return None

    trail.back_and_on(plan)
    return np.array(asked).reshape(-1, 2)


def test_the_way_back_is_the_way_in_the_other_way_round() -> None:
    trail = Trail()
    for step in range(21):
        trail.add(0.1 * step, 0.0)
    goal = np.array([(1.0, 3.0), (1.0, 4.0)])
    points, way = trail.back_and_on(lambda place: goal if place[0] <= 1.0 else None)
    assert points is not None
    assert points[0] == pytest.approx((2.0, 0.0))
    assert (points[-2:] == goal).all()
    back = points[:-2]
    assert (np.diff(back[:, 0]) < 0.0).all()
    # No farther than need be, but for a place or three.
    assert 0.6 <= back[-1, 0] <= 1.0
    assert way == pytest.approx(2.0 - back[-1, 0])


def test_it_asks_from_the_nearest_place_on() -> None:
    trail = Trail()
    for step in range(100):
        trail.add(0.06 * step, 0.0)
    asked = places_of(trail)
    assert len(asked) > 5
    assert (np.diff(asked[:, 0]) < 0.0).all()


def test_without_a_place_that_leads_on_there_is_no_way() -> None:
    trail = Trail()
    assert trail.back_and_on(nowhere) == (None, 0.0)
    for step in range(50):
        trail.add(0.1 * step, 0.0)
    assert trail.back_and_on(nowhere) == (None, 0.0)


def test_forgotten_there_is_no_way_back() -> None:
    trail = Trail()
    for step in range(50):
        trail.add(0.1 * step, 0.0)
    trail.forget()
    assert len(places_of(trail)) == 0
    assert trail.back_and_on(lambda place: np.zeros((1, 2))) == (None, 0.0)


def test_it_remembers_the_last_metres_only() -> None:
    trail = Trail()
    for step in range(2000):
        trail.add(0.01 * step, 0.0)
    asked = places_of(trail)
    assert 20.0 - 1.3 * LONGEST < asked[-1, 0] < 20.0 - 0.7 * LONGEST


def test_standing_and_turning_it_adds_nothing() -> None:
    trail = Trail()
    for step in range(40):
        trail.add(0.1 * step, 0.0)
    before = places_of(trail)
    for _ in range(500):
        trail.add(3.91, 0.01)
    assert (places_of(trail) == before).all()


def test_carried_there_is_no_way_back_to_where_it_was() -> None:
    trail = Trail()
    for step in range(30):
        trail.add(0.1 * step, 0.0)
    for step in range(30):
        trail.add(6.0, 6.0 + 0.1 * step)
    assert (places_of(trail)[:, 0] == 6.0).all()


def test_in_another_frame_the_way_back_is_the_same() -> None:
    trail, moved = Trail(), Pose(1.0, -2.0, 0.07)
    for step in range(30):
        trail.add(0.1 * step, 0.5)
    before = places_of(trail)
    trail.move(moved)
    there = [moved.compose(Pose(x, y)) for x, y in before.tolist()]
    assert places_of(trail) == pytest.approx(np.array([(place.x, place.y) for place in there]))
