"""Where the robot is before its station: beams put a wrong belief right, and never a right one."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.body import BodyConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.sensors import StationConfig
from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams
from roomba.mission.docking.track import StationTrack

BODY, STATION = BodyConfig(), StationConfig()
CONFIG = DockingConfig()
FRONT = BODY.radius + CONFIG.plate_gap
DOCKED = Pose(3.0, -2.0, 2.1)
BOTH = StationBeams(green=True, red=True)
STILL = Twist()


def track(at: Pose) -> StationTrack:
    """Believe to be at a pose of the docked robot's frame."""
    made = StationTrack(BODY, STATION, CONFIG, DOCKED)
    made.move(DOCKED.compose(at), STILL, 0.05)
    return made


def beams_at(x: float, y: float) -> StationBeams:
    """What is received there: by the station's angles, as it looks at the robot that comes."""
    away, angle = math.hypot(FRONT - x, y), math.degrees(math.atan2(-y, FRONT - x))
    half = 0.5 * STATION.overlap
    return StationBeams(
        halo=away <= STATION.halo,
        green=away <= STATION.beam and -STATION.beam_angle <= angle <= half,
        red=away <= STATION.beam and -half <= angle <= STATION.beam_angle,
    )


def test_it_is_where_the_robot_believes_to_be() -> None:
    here = track(Pose(-0.7, 0.1, 0.2))
    assert (here.pose.x, here.pose.y) == pytest.approx((-0.7, 0.1))
    assert here.pose.theta == pytest.approx(0.2)
    assert here.left == pytest.approx(0.7)
    assert here.away == pytest.approx(math.hypot(0.7, 0.1))


@given(
    st.floats(-0.75, -0.02),
    st.floats(-0.25, 0.25),
    st.floats(-0.08, 0.08),
    st.floats(-0.08, 0.08),
)
def test_beams_never_lead_it_farther_from_the_truth_aside(
    x: float, y: float, wrong_x: float, wrong_y: float
) -> None:
    here = track(Pose(x + wrong_x, y + wrong_y))
    seen = beams_at(x, y)
    here.see(seen)
    # The wedge of a beam is narrower where the robot is nearer: its belief of the way counts too.
    off = abs(wrong_x) * math.tan(math.radians(STATION.beam_angle))
    assert abs(here.pose.y - y) <= abs(wrong_y) + off + 1e-9
    if seen.leads:
        assert abs(here.pose.x - x) <= abs(wrong_x) + abs(wrong_y) + 1e-9


def test_one_beam_tells_the_side_and_both_the_middle() -> None:
    half = math.tan(math.radians(0.5 * STATION.overlap)) * (FRONT + 0.6)
    wide = math.tan(math.radians(STATION.beam_angle)) * (FRONT + 0.6)
    for believed, beams, expected in (
        (0.0, StationBeams(green=True), half),
        (0.0, StationBeams(red=True), -half),
        (0.9, StationBeams(green=True), wide),
        (-0.9, StationBeams(red=True), -wide),
        (0.1, StationBeams(green=True), 0.1),
        (-0.1, StationBeams(red=True), -0.1),
        (0.1, BOTH, half),
        (-0.1, BOTH, -half),
        (0.01, BOTH, 0.01),
        (0.1, StationBeams(), 0.1),
    ):
        here = track(Pose(-0.6, believed))
        here.see(beams)
        assert here.pose.y == pytest.approx(expected)


def test_the_edge_of_the_halo_tells_the_way() -> None:
    edge = FRONT - STATION.halo
    for believed, beams, expected in (
        (edge - 0.05, StationBeams(True, True, True), edge),
        (edge + 0.05, BOTH, edge),
        (edge + 0.05, StationBeams(True, True, True), edge + 0.05),
        (edge - 0.05, BOTH, edge - 0.05),
        (edge - 0.05, StationBeams(halo=True), edge - 0.05),
    ):
        here = track(Pose(believed, 0.0))
        here.see(beams)
        assert here.pose.x == pytest.approx(expected, abs=1e-3)


def test_who_sees_one_beam_for_long_is_farther_aside() -> None:
    here, believed = track(Pose(-0.7, -0.02, 0.0)), Pose(-0.7, -0.02, 0.0)
    for _ in range(40):
        believed = Pose(believed.x + 0.01, believed.y + 0.001, 0.1)
        here.move(DOCKED.compose(believed), STILL, 0.05)
        here.see(StationBeams(halo=believed.x > -0.4, red=True))
    assert here.pose.y < -0.03
    # In the middle it is no longer doubted.
    here.see(StationBeams(True, True, True))
    half = math.tan(math.radians(0.5 * STATION.overlap)) * (FRONT - here.pose.x)
    assert here.pose.y == pytest.approx(-half)
    here.see(StationBeams(True, False, True))
    assert here.pose.y == pytest.approx(-half)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_where_a_lone_beam_ends_is_its_outer_edge(side: float) -> None:
    here = track(Pose(-0.5, 0.1 * side))
    here.see(StationBeams(green=side > 0.0, red=side < 0.0))
    here.see(StationBeams())
    wide = math.tan(math.radians(STATION.beam_angle)) * (FRONT - here.pose.x)
    assert here.pose.y == pytest.approx(side * wide)
    kept = here.pose
    here.see(StationBeams())
    assert here.pose == kept


def test_where_both_beams_end_nothing_is_learnt() -> None:
    here = track(Pose(-0.4, 0.0))
    here.see(StationBeams(True, True, True))
    before = here.pose
    here.see(StationBeams())
    assert here.pose == before


def test_it_moves_as_the_belief_does_from_where_beams_put_it() -> None:
    here = track(Pose(-0.6, 0.05, 0.0))
    here.see(BOTH)
    before = here.pose
    here.move(DOCKED.compose(Pose(-0.55, 0.05, 0.1)), STILL, 0.05)
    assert here.pose.x == pytest.approx(before.x + 0.05)
    assert here.pose.y == pytest.approx(before.y)
    assert here.pose.theta == pytest.approx(0.1)


def test_without_a_pose_it_goes_as_was_wanted() -> None:
    here = track(Pose(-0.6, 0.0, 0.0))
    for _ in range(20):
        here.move(None, Twist(0.2, math.pi / 2.0), 0.05)
    # A quarter of a circle.
    radius = 0.2 / (math.pi / 2.0)
    assert here.pose.theta == pytest.approx(math.pi / 2.0)
    assert here.pose.x == pytest.approx(-0.6 + radius, abs=1e-3)
    assert here.pose.y == pytest.approx(radius, abs=1e-3)
    assert here.is_known
    assert not StationTrack(BODY, STATION, CONFIG, DOCKED).is_known


def test_a_new_belief_takes_the_place_of_the_old_one_and_late_beams_do_not_count() -> None:
    here = track(Pose(-0.3, 0.0))
    here.see(StationBeams(True, True, True))
    elsewhere = DOCKED.compose(Pose(-1.5, 0.6, 2.0))
    here.move(elsewhere, STILL, 0.05)
    here.see(StationBeams(True, True, True))
    assert (here.pose.x, here.pose.y) == pytest.approx((-1.5, 0.6))
    for _ in range(8):
        here.move(elsewhere, STILL, 0.05)
    here.see(StationBeams(False, True, True))
    assert abs(here.pose.y) < 0.1


def test_beams_that_lead_too_far_off_the_belief_are_forgotten() -> None:
    here = track(Pose(-1.5, 0.0, 0.0))
    here.see(StationBeams(True, True, True))
    assert here.pose.x > -0.5
    here.move(DOCKED.compose(Pose(-1.49, 0.0, 0.0)), STILL, 0.05)
    assert here.pose.x == pytest.approx(-1.49)


def test_forgetting_the_beams_leaves_the_belief() -> None:
    here = track(Pose(-0.6, 0.1, 0.0))
    here.see(BOTH)
    here.forget_beams()
    assert here.pose.y == pytest.approx(0.1)
    here.move(None, STILL, 0.05)
    here.see(BOTH)
    before = here.pose
    here.forget_beams()
    assert here.pose == before


@given(st.floats(-0.7, 0.0), st.floats(-0.3, 0.3), st.floats(-0.5, 0.5))
def test_it_steers_at_the_middle_of_the_way(x: float, y: float, theta: float) -> None:
    here = track(Pose(x, y, theta))
    wanted = theta + here.steering(reach=0.2, most=0.4)
    assert abs(wanted) <= 0.4 + 1e-9
    assert wanted == pytest.approx(-math.copysign(min(math.atan(abs(y) / 0.2), 0.4), y))
