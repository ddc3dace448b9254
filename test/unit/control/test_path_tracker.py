"""Following polylines with a body that does exactly what it is told, a tick at a time."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.body import BodyConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Pose, Twist

CONFIG = RobotConfig()
TRACKING, BODY = CONFIG.tracking, CONFIG.body
TICK = 0.05
LIMIT = 0.3
ANGULAR = min(TRACKING.turning_speed, BODY.max_angular_speed)
ASIDE = 0.005
"""m; farther from its line it never is, beginning on it: twice 3 mm before a corner may add up."""
BESIDE_A_WALL = 0.004
"""m; the same along walls, from which plans keep 5 mm."""
ROUNDING = 1e-9
FINE = 10
"""Steps of the body in a tick."""

Points = NDArray[np.float64]


def moved(pose: Pose, twist: Twist, seconds: float) -> Pose:
    """Return where an ideal body is then: on an arc."""
    turn = twist.angular * seconds
    half = 0.5 * turn
    way = twist.linear * seconds * (math.sin(half) / half if half else 1.0)
    heading = pose.theta + half
    return Pose(
        pose.x + way * math.cos(heading), pose.y + way * math.sin(heading), pose.theta + turn
    )


class Drive:
    """A tracker, and the body that it drives; all twists, and poses in between."""

    def __init__(
        self,
        points: Points,
        pose: Pose | None = None,
        limit: float = LIMIT,
        body: BodyConfig = BODY,
    ) -> None:
        self.tracker = PathTracker(points, TRACKING, body, TICK)
        self.pose = pose or Pose(float(points[0, 0]), float(points[0, 1]), 0.0)
        self.limit = limit
        self.twists: list[Twist] = []
        self.poses = [self.pose]
        self.legs: list[int] = []

    def tick(self) -> Twist:
        twist = self.tracker.tick(self.pose, self.limit)
        self.twists.append(twist)
        self.legs.append(self.tracker.leg)
        for _ in range(FINE):
            self.pose = moved(self.pose, twist, TICK / FINE)
            self.poses.append(self.pose)
        return twist

    def to_the_end(self, seconds: float = 300.0) -> Drive:
        for _ in range(round(seconds / TICK)):
            self.tick()
            if self.tracker.is_done:
                return self
        raise AssertionError(f"no end within {seconds} s: {self.pose}, leg {self.tracker.leg}")

    @property
    def places(self) -> Points:
        return np.array([(pose.x, pose.y) for pose in self.poses])


class LateDrive(Drive):
    """A body that obeys a tick late, and with no more acceleration than the robot's own has."""

    def __init__(self, points: Points, pose: Pose | None = None, limit: float = LIMIT) -> None:
        super().__init__(points, pose, limit)
        self.told = self.twist = Twist()

    def tick(self) -> Twist:
        told, self.told = self.told, self.tracker.tick(self.pose, self.limit)
        self.twists.append(self.told)
        step = TICK / FINE
        for _ in range(FINE):
            self.twist = Twist(
                towards(
                    self.twist.linear,
                    told.linear,
                    BODY.max_acceleration * step,
                    BODY.max_deceleration * step,
                ),
                towards(
                    self.twist.angular,
                    told.angular,
                    BODY.max_angular_acceleration * step,
                    BODY.max_angular_deceleration * step,
                ),
            )
            self.pose = moved(self.pose, self.twist, step)
            self.poses.append(self.pose)
        return self.told


def towards(now: float, wanted: float, more: float, less: float) -> float:
    """Return a speed a step later, which grows by ``more`` and falls by ``less`` at most."""
    most = less if abs(wanted) < abs(now) or wanted * now < 0.0 else more
    return now + min(max(wanted - now, -most), most)


def line(*points: tuple[float, float]) -> Points:
    return np.array(points, np.float64)


def polyline(headings: list[float], lengths: list[float]) -> Points:
    ways = [
        (way * math.cos(a), way * math.sin(a)) for a, way in zip(headings, lengths, strict=True)
    ]
    return np.concatenate((np.zeros((1, 2)), np.cumsum(np.array(ways), axis=0)))


lengths = st.floats(0.02, 1.0)
legs = st.lists(st.tuples(st.floats(-math.pi, math.pi), lengths), min_size=1, max_size=8)
soft_legs = st.lists(st.tuples(st.floats(-0.49, 0.49), lengths), min_size=1, max_size=12)


def check(drive: Drive, points: Points) -> None:
    """It is at the end, was never too fast, nor far from the path, and met all of it."""
    assert drive.pose.distance_to(*points[-1].tolist()) < ASIDE + TRACKING.arrival_tolerance
    assert drive.twists[-1] == Twist()
    assert drive.tracker.left == 0.0
    assert all(0.0 <= twist.linear <= LIMIT + 1e-9 for twist in drive.twists)
    assert all(abs(twist.angular) <= ANGULAR + 1e-9 for twist in drive.twists)
    path = shapely.LineString(points)
    assert shapely.distance(path, shapely.points(drive.places)).max() < ASIDE
    driven = shapely.LineString(drive.places)
    met = shapely.points(points)
    assert shapely.distance(driven, met).max() < ASIDE + TRACKING.arrival_tolerance


@given(legs, st.floats(-math.pi, math.pi))
@settings(max_examples=examples(60))
def test_any_polyline_is_driven_to_its_end(legs: list[tuple[float, float]], heading: float) -> None:
    points = polyline([leg[0] for leg in legs], [leg[1] for leg in legs])
    drive = Drive(points, Pose(0.0, 0.0, heading)).to_the_end()
    check(drive, points)


@given(soft_legs)
@settings(max_examples=examples(60))
def test_soft_corners_are_taken_without_stopping(legs: list[tuple[float, float]]) -> None:
    headings = list(itertools.accumulate(turn for turn, _ in legs))
    points = polyline(headings, [way for _, way in legs])
    drive = Drive(points, Pose(0.0, 0.0, headings[0])).to_the_end()
    check(drive, points)
    # Once it drives it does not stop, nor creep but at the end.
    began = next(tick for tick, twist in enumerate(drive.twists) if twist.linear > 0.0)
    left = np.hypot(*(drive.places[::FINE][:-1] - points[-1]).T)
    speeds = np.array([twist.linear for twist in drive.twists])
    assert (speeds[began:-1] > 0.0).all()
    assert (speeds[began:][left[began:] > 0.05] > 0.05).all()


@given(st.floats(0.51, 3.1), st.booleans())
def test_sharp_corners_are_turned_on_the_spot(corner: float, is_left: bool) -> None:
    turn = corner if is_left else -corner
    points = polyline([0.0, turn], [0.5, 0.5])
    drive = Drive(points).to_the_end()
    check(drive, points)
    turning = [twist for twist in drive.twists if twist.linear == 0.0 and twist.angular != 0.0]
    assert all(twist.angular * turn > 0.0 or abs(twist.angular) < 0.2 for twist in turning)
    turned = sum(twist.angular for twist in turning) * TICK
    if corner < math.pi - 0.02:
        assert turned == pytest.approx(turn, abs=0.05)
    while_driving = [abs(twist.angular) for twist in drive.twists if twist.linear > 0.0]
    assert max(while_driving) < 0.2


def test_a_straight_way_is_driven_at_the_speed_wanted() -> None:
    points = line((0.0, 0.0), (3.0, 0.0))
    for limit in (0.1, 0.3, 0.5):
        drive = Drive(points, limit=limit).to_the_end()
        assert len(drive.twists) * TICK == pytest.approx(3.0 / limit, abs=2.0)
        assert max(twist.linear for twist in drive.twists) == pytest.approx(limit)
        assert {twist.angular for twist in drive.twists} == {0.0}


def test_it_brakes_for_the_end_and_for_corners() -> None:
    points = line((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    drive = Drive(points).to_the_end()
    speeds = [twist.linear for twist in drive.twists]
    slowing = np.diff([speed for speed in speeds if speed > 0.02]) / TICK
    assert -2.5 * TRACKING.braking < slowing.min() < 0.0
    places = drive.places[::FINE][:-1]
    for corner, leg in (((1.0, 0.0), 0), ((1.0, 1.0), 1)):
        left = np.hypot(*(places - corner).T)[np.array(drive.legs) == leg]
        on_leg = np.array(speeds)[np.array(drive.legs) == leg]
        assert (on_leg <= np.sqrt(2.0 * TRACKING.braking * left) + 0.03).all()
        # But it does not begin to brake long before.
        assert on_leg[(left > 0.15) & (left < 0.9)] == pytest.approx(LIMIT)


# Around the end of a wall on a grid of 1 cm: bends to either side, and corners at their ends.
AROUND_A_WALL = line(
    *[(0.805, 0.375), (0.815, 0.395), (0.815, 0.655), (0.805, 0.675), (0.785, 0.705)],
    *[(0.755, 0.735), (0.725, 0.755), (0.705, 0.765), (0.695, 0.765), (0.605, 0.765)],
    *[(0.545, 0.785), (0.515, 0.795), (0.365, 0.795)],
)
INTO_A_CORNER = line(
    *[(0.115, 0.275), (0.155, 0.285), (0.755, 0.285), (0.775, 0.295), (0.805, 0.315)],
    *[(0.835, 0.345), (0.855, 0.375), (0.865, 0.395), (0.865, 0.705), (0.855, 0.725)],
    *[(0.835, 0.755), (0.725, 0.865), (0.715, 0.905)],
)


@pytest.mark.parametrize("points", [AROUND_A_WALL, INTO_A_CORNER], ids=["around", "into"])
@pytest.mark.parametrize("is_reversed", [False, True])
def test_a_drive_that_answers_late_keeps_to_bends_along_walls(
    points: Points, is_reversed: bool
) -> None:
    points = points[::-1].copy() if is_reversed else points
    drive = LateDrive(points).to_the_end()
    path = shapely.LineString(points)
    # How it stops is another matter: the last leg goes on here.
    beyond = shapely.LineString(np.vstack((points, 2.0 * points[-1] - points[-2])))
    assert shapely.distance(beyond, shapely.points(drive.places)).max() < BESIDE_A_WALL
    # Between its first and its last decimetre it slows down for bends, and does not stop.
    speeds = np.array([twist.linear for twist in drive.twists])
    ways = np.cumsum(speeds) * TICK
    is_between = (ways > 0.1) & (ways < path.length - 0.1)
    assert speeds[is_between].min() >= 0.9 * TRACKING.slowest_corner
    assert speeds[is_between].mean() > 0.6 * LIMIT


@pytest.mark.parametrize("turning", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("points", [AROUND_A_WALL, INTO_A_CORNER], ids=["around", "into"])
def test_a_body_that_turns_slowly_is_slow_in_bends_and_keeps_to_them(
    points: Points, turning: float
) -> None:
    drive = Drive(points, body=BODY.model_copy(update={"max_angular_speed": turning}))
    drive.to_the_end()
    assert max(abs(twist.angular) for twist in drive.twists) <= turning + ROUNDING
    off = shapely.distance(shapely.LineString(points), shapely.points(drive.places))
    assert off.max() < BESIDE_A_WALL


def test_where_it_is_on_its_path_is_told() -> None:
    points = line((0.0, 0.0), (1.0, 0.0), (1.0, 0.5))
    drive = Drive(points)
    tracker = drive.tracker
    assert (tracker.length, tracker.left, tracker.along) == pytest.approx((1.5, 1.5, 0.0))
    before, seen = 0.0, set()
    while not tracker.is_done:
        drive.tick()
        assert tracker.along >= before - 1e-9
        assert tracker.along + tracker.left == pytest.approx(1.5)
        before = tracker.along
        seen.add(tracker.leg)
    assert seen == {0, 1}
    assert tracker.along == pytest.approx(1.5)
    assert drive.tick() == Twist()


def test_the_rest_of_its_path_begins_where_it_is() -> None:
    points = line((0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (1.6, 0.5))
    drive = Drive(points)
    tracker = drive.tracker
    assert tracker.rest == pytest.approx(points)
    while not tracker.is_done:
        drive.tick()
        rest = tracker.rest
        assert shapely.LineString(np.vstack((rest, rest[-1:]))).length == pytest.approx(
            tracker.left, abs=1e-6
        )
        assert rest[-1] == pytest.approx(points[-1])
        assert math.dist(rest[0], (drive.pose.x, drive.pose.y)) < 0.03
        # Corners behind it are no part of it.
        assert len(rest) <= len(points) - tracker.leg
    assert tracker.rest == pytest.approx(points[-1:])


def test_how_far_it_is_off_its_path_is_told() -> None:
    tracker = PathTracker(line((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), TRACKING, BODY, TICK)
    assert tracker.off_path(Pose(0.5, 0.2, 0.0)) == pytest.approx(0.2)
    assert tracker.off_path(Pose(0.5, -0.2, 0.0)) == pytest.approx(0.2)
    # Beyond its ends it counts from these.
    assert tracker.off_path(Pose(-0.3, 0.4, 0.0)) == pytest.approx(0.5)
    assert tracker.off_path(Pose(1.3, 0.4, 0.0)) == pytest.approx(0.5)
    tracker.tick(Pose(0.5, 0.02, 0.0), LIMIT)
    assert tracker.aside == pytest.approx(0.02)
    tracker.tick(Pose(0.5, -0.02, 0.0), LIMIT)
    assert tracker.aside == pytest.approx(-0.02)


@given(st.floats(-0.08, 0.08), st.floats(-math.pi, math.pi))
def test_from_aside_it_comes_back_to_its_line(aside: float, heading: float) -> None:
    points = line((0.0, 0.0), (1.5, 0.0))
    drive = Drive(points, Pose(0.0, aside, heading)).to_the_end()
    behind = drive.places[drive.places[:, 0] > 0.8]
    assert np.abs(behind[:, 1]).max() < ASIDE
    # Not beyond it to the other side.
    assert (drive.places[:, 1] * math.copysign(1.0, aside)).min() > -ASIDE


@pytest.mark.parametrize("turn", [-2.5, -1.0, 1.0, 2.5])
def test_turned_away_it_aims_first(turn: float) -> None:
    drive = Drive(line((0.0, 0.0), (1.5, 0.0)))
    while drive.pose.x < 0.5:
        drive.tick()
    drive.pose = Pose(drive.pose.x, 0.0, turn)
    twist = drive.tick()
    assert twist.linear == 0.0
    assert twist.angular * turn < 0.0
    drive.to_the_end()
    assert drive.pose.distance_to(1.5, 0.0) < ASIDE + TRACKING.arrival_tolerance


def test_a_robot_that_was_not_driven_for_a_while_is_taken_to_stand() -> None:
    bend = polyline([0.1 * leg for leg in range(16)], [0.04] * 16)
    drive = Drive(bend)
    for _ in range(20):
        drive.tick()
    going = drive.tracker.tick(drive.pose, LIMIT)
    drive.tracker.stand()
    standing = drive.tracker.tick(drive.pose, LIMIT)
    # Without a speed the curvature makes no turn.
    assert abs(standing.angular) < 0.5 * abs(going.angular)


def test_points_that_are_the_same_are_one() -> None:
    points = line((0.0, 0.0), (0.0, 0.0), (0.5, 0.0), (0.5, 1e-5), (0.5, 0.5), (0.5, 0.5))
    drive = Drive(points).to_the_end()
    check(drive, points)
    assert drive.tracker.length == pytest.approx(1.0, abs=1e-4)


def test_a_path_of_one_point_is_done_at_once() -> None:
    drive = Drive(line((1.0, 2.0)), Pose(1.0, 2.5, 0.0))
    assert drive.tracker.off_path(drive.pose) == pytest.approx(0.5)
    assert drive.tick() == Twist()
    assert drive.tracker.is_done
    assert drive.tracker.left == drive.tracker.length == 0.0
