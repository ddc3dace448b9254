"""Dead reckoning: arcs, slipping wheels, a gyro's bias, and stamps as they come."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, IDEAL
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator

CONFIG = RobotConfig()
BIG = room_home(8.0, 8.0)
MIDDLE = Pose(4.0, 4.0, 0.0)


def reckoning() -> DeadReckoning:
    return DeadReckoning(CONFIG.localization, CONFIG.gyro)


def spread_of(reckoned: DeadReckoning) -> NDArray[np.float64]:
    """Take what it became unsure by since this was last asked for: ahead, left, m2; theta, rad2."""
    spread: NDArray[np.float64] = reckoned.belief[0]["spread"].copy()
    reckoned.belief[0]["spread"] = 0.0
    return spread


def same(pose: Pose, other: Pose, tolerance: float = 1e-9) -> bool:
    turn = abs(wrap_angle(pose.theta - other.theta))
    return max(pose.distance_to(other.x, other.y), turn) <= tolerance


def arc(linear: float, angular: float, time: float) -> Pose:
    turn = angular * time
    if angular == 0.0:
        return Pose(linear * time, 0.0, 0.0)
    radius = linear / angular
    return Pose(radius * math.sin(turn), radius * (1.0 - math.cos(turn)), wrap_angle(turn))


SPEEDS = st.floats(-0.5, 0.5)
TURNS = st.floats(-3.0, 3.0)


@given(SPEEDS, TURNS, st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-3, 3)))
def test_by_wheels_alone_arcs_are_exact(
    linear: float, angular: float, start: tuple[float, float, float]
) -> None:
    """Wherever the frame of the odometry lies: only what is driven counts."""
    reckoned, at = reckoning(), Pose(*start)
    for step in range(41):
        reckoned.move(DT * step, at.compose(arc(linear, angular, DT * step)), None)
    assert same(reckoned.pose, arc(linear, angular, DT * 40))
    assert same(reckoned.odometry, at.compose(arc(linear, angular, DT * 40)))


@given(SPEEDS, TURNS)
def test_a_gyro_that_agrees_with_the_wheels_changes_nothing(linear: float, angular: float) -> None:
    reckoned = reckoning()
    for step in range(41):
        reckoned.move(DT * step, arc(linear, angular, DT * step), angular)
    assert same(reckoned.pose, arc(linear, angular, DT * 40), 1e-6)


def test_a_little_slip_that_the_gyro_sees_bends_the_arc() -> None:
    """The wheels say straight on; the gyro says a wide arc, as it is driven."""
    reckoned = reckoning()
    for step in range(401):
        reckoned.move(DT * step, Pose(0.3 * DT * step, 0.0, 0.0), 0.02)
    true = arc(0.3, 0.02, 10.0)
    assert reckoned.pose.theta == pytest.approx(true.theta, abs=0.15 * true.theta)
    assert reckoned.pose.distance_to(true.x, true.y) < 0.15 * true.y


def test_the_way_of_one_step_is_bent_to_the_turn_that_is_believed() -> None:
    reckoned = reckoning()
    reckoned.move(0.0, Pose(), 0.02)
    reckoned.move(0.5, Pose(0.5, 0.0, 0.0), 0.02)
    assert reckoned.pose.theta > 0.005
    assert reckoned.pose.y == pytest.approx(0.5 * math.sin(0.5 * reckoned.pose.theta), rel=1e-6)


@pytest.mark.parametrize("slip", [0.02, 0.1, 0.3])
@pytest.mark.parametrize("side", [Fault.SLIP_LEFT, Fault.SLIP_RIGHT])
def test_the_gyro_sees_what_slipping_wheels_do_not(slip: float, side: Fault) -> None:
    world, reckoned, by_wheels = Simulator(BIG, IDEAL, start=MIDDLE), reckoning(), reckoning()
    world.inject(side, slip)
    spread = 0.0
    for _ in range(200):
        seen = world.step(Twist(0.2, 0.0), DT)
        reckoned.move(seen.time, seen.odometry, seen.angular_velocity)
        by_wheels.move(seen.time, seen.odometry, None)
        spread += spread_of(reckoned)[2]
    missed = abs(wrap_angle(by_wheels.pose.theta - seen.pose.theta))
    error = abs(wrap_angle(reckoned.pose.theta - seen.pose.theta))
    assert missed > 0.05
    assert error < 0.15 * missed
    assert error < 3.0 * math.sqrt(spread) + 0.01


def test_a_robot_whose_wheels_stand_and_that_a_person_turns_sees_it_by_its_gyro() -> None:
    reckoned = reckoning()
    for step in range(41):
        reckoned.move(DT * step, Pose(), 0.5)
    assert reckoned.pose.theta == pytest.approx(0.5, abs=0.1)


def test_the_bias_of_the_gyro_is_learned_while_it_stands() -> None:
    random = np.random.default_rng(1)
    bias = 0.002

    def drift(standing: float) -> float:
        """Return how much it seems to turn on 6 m straight on, after it stood for a while."""
        reckoned = reckoning()
        time = 0.0
        for step in range(round((standing + 20.0) / DT)):
            time = DT * step
            way = 0.3 * max(0.0, time - standing)
            shown = bias + float(random.normal(0.0, CONFIG.gyro.noise))
            reckoned.move(time, Pose(way, 0.0, 0.0), shown)
            if time < standing:
                start = reckoned.pose.theta
        return reckoned.pose.theta - (start if standing else 0.0)

    unlearned = abs(drift(0.0))
    assert unlearned > 0.02
    assert abs(drift(10.0)) < 0.2 * unlearned


def test_no_bias_is_learned_from_turning_while_it_goes_or_has_just_stopped() -> None:
    """What the gyro shows then is a turn; a bias of that would turn the way that follows."""
    reckoned = reckoning()
    time, odometry = 0.0, Pose()
    for _ in range(20):
        for _ in range(10):
            time += DT
            odometry = odometry.compose(Pose(0.005, 0.0, 0.1 * DT))
            reckoned.move(time, odometry, 0.1)
        for _ in range(10):
            time += DT
            reckoned.move(time, odometry, 0.007)
    before = reckoned.pose.theta
    for _ in range(200):
        time += DT
        odometry = odometry.compose(Pose(0.005, 0.0, 0.0))
        reckoned.move(time, odometry, 0.0)
    assert reckoned.pose.theta - before == pytest.approx(0.0, abs=0.004)


def test_no_bias_is_learned_from_a_robot_that_a_person_turns_fast() -> None:
    reckoned = reckoning()
    for step in range(400):
        reckoned.move(DT * step, Pose(), 1.0)
    before = reckoned.pose.theta
    for step in range(400, 600):
        reckoned.move(DT * step, Pose(0.3 * DT * (step - 400), 0.0, 0.0), 0.0)
    assert wrap_angle(reckoned.pose.theta - before) == pytest.approx(0.0, abs=0.02)


def driven(stamps: list[float]) -> DeadReckoning:
    """Drive 1 m/s ahead, told at these times."""
    reckoned = reckoning()
    for stamp in stamps:
        reckoned.move(stamp, Pose(stamp, 0.0, 0.0), 0.0)
    return reckoned


def test_the_first_odometry_is_where_it_begins() -> None:
    reckoned = reckoning()
    assert reckoned.at(0.0) is None
    assert reckoned.odometry == Pose()
    reckoned.move(5.0, Pose(3.0, 4.0, 1.0), 2.0)
    assert reckoned.pose == Pose()
    assert reckoned.odometry == Pose(3.0, 4.0, 1.0)
    assert not spread_of(reckoned)[:2].any()


def test_a_stamp_that_comes_twice_or_late_is_left_out() -> None:
    reckoned = driven([1.0, 1.1, 1.2])
    for stamp in (1.2, 1.15, 1.19):
        reckoned.move(stamp, Pose(7.0, 7.0, 1.0), 3.0)
    assert same(reckoned.pose, Pose(0.2, 0.0, 0.0))
    reckoned.move(1.3, Pose(1.3, 0.0, 0.0), 0.0)
    assert same(reckoned.pose, Pose(0.3, 0.0, 0.0))


def test_what_was_left_out_is_not_lost() -> None:
    """Odometry counts from the beginning: one that is missing is in the next one."""
    assert same(driven([1.0, 1.1, 1.5, 1.6]).pose, driven([1.0, 1.6]).pose, 1e-9)


@pytest.mark.parametrize("back", [0.35, 1.5, 2.5, 1000.0])
def test_a_clock_set_back_loses_no_way(back: float) -> None:
    reckoned = driven([5000.0 + 0.1 * step for step in range(11)])
    way = 5001.0
    for step in range(11):
        way += 0.1
        reckoned.move(5001.1 - back + 0.1 * step, Pose(way, 0.0, 0.0), 0.0)
    assert same(reckoned.pose, Pose(2.1, 0.0, 0.0), 1e-6)
    if back > 2.0:
        assert reckoned.at(5001.0 - back) is None
    later = reckoned.at(5001.65 - back)
    assert later is not None
    assert same(later, Pose(1.65, 0.0, 0.0), 1e-6)


def test_over_a_clock_set_back_the_wheels_alone_say_the_turn() -> None:
    """It is not known for how long the gyro's turning speed went on."""
    reckoned = reckoning()
    reckoned.move(5000.0, Pose(), 0.5)
    reckoned.move(4000.0, Pose(0.0, 0.0, 0.02), 0.5)
    assert reckoned.pose.theta == pytest.approx(0.02, abs=1e-9)


def test_a_stamp_that_is_far_out_of_order_counts_no_way_twice() -> None:
    assert same(driven([10.0, 9.5, 10.1]).pose, Pose(0.1, 0.0, 0.0))


def test_the_gyro_says_nothing_of_a_time_that_was_not_sampled() -> None:
    """After a minute without news a turning speed is not that of the whole minute."""
    reckoned = driven([0.0, 0.1])
    reckoned.move(60.1, Pose(0.1, 0.0, 0.3), 0.2)
    assert 0.0 < reckoned.pose.theta <= 0.3


def test_between_stamps_it_is_in_between() -> None:
    reckoned = driven([1.0, 1.1, 1.3])
    for stamp, way in ((1.0, 0.0), (1.05, 0.05), (1.1, 0.1), (1.15, 0.15), (1.3, 0.3)):
        at = reckoned.at(stamp)
        assert at is not None
        assert same(at, Pose(way, 0.0, 0.0))


def test_what_is_newer_than_the_newest_is_the_newest_and_long_ago_is_none() -> None:
    reckoned = driven([0.1 * step for step in range(41)])
    assert reckoned.at(9.0) == reckoned.pose
    assert reckoned.at(1.5) is None
    assert reckoned.at(2.5) is not None


def test_between_two_headings_the_short_way_counts() -> None:
    reckoned = reckoning()
    reckoned.move(0.0, Pose(), None)
    reckoned.move(1.0, Pose(0.0, 0.0, 3.0), None)
    reckoned.move(2.0, Pose(0.0, 0.0, -3.0), None)
    at = reckoned.at(1.25)
    assert at is not None
    assert at.theta == pytest.approx(3.0 + 0.25 * (2.0 * math.pi - 6.0))
    at = reckoned.at(1.75)
    assert at is not None
    assert at.theta == pytest.approx(-3.0 - 0.25 * (2.0 * math.pi - 6.0))


def test_variances_grow_with_the_way_and_are_taken_once() -> None:
    def spread(way: float, pieces: int) -> NDArray[np.float64]:
        reckoned = reckoning()
        for step in range(pieces + 1):
            reckoned.move(DT * step, Pose(way * step / pieces, 0.0, 0.0), None)
        taken = spread_of(reckoned)
        assert not spread_of(reckoned).any()
        return taken

    one = spread(1.0, 10)
    noise = CONFIG.localization
    assert one[0] == pytest.approx(noise.way_noise**2)
    assert one[1] == pytest.approx(noise.side_noise**2)
    assert one[2] == pytest.approx(noise.wheel_turn_noise**2, rel=1e-3)
    assert spread(1.0, 200) == pytest.approx(one, rel=1e-2)
    assert spread(3.0, 30) == pytest.approx(3.0 * one, rel=1e-2)


def test_a_turn_on_the_spot_leaves_the_place_unsure() -> None:
    """No robot turns around the very point that it calls its middle."""
    reckoned = reckoning()
    for step in range(41):
        reckoned.move(DT * step, Pose(0.0, 0.0, 0.1 * step), None)
    expected = 4.0 * CONFIG.localization.turn_way_noise**2
    assert spread_of(reckoned)[:2] == pytest.approx(expected)


def test_with_a_gyro_headings_are_surer_and_never_surer_than_either() -> None:
    def variance(turning: float | None) -> float:
        reckoned = reckoning()
        for step in range(101):
            reckoned.move(DT * step, Pose(0.3 * DT * step, 0.0, 0.0), turning)
        return float(spread_of(reckoned)[2])

    assert 0.0 < variance(0.0) < 0.2 * variance(None)


def test_between_two_samples_the_gyro_turned_by_their_mean() -> None:
    """It turns ever faster while the wheels slip and say straight on; 10 samples a second."""
    reckoned = reckoning()
    for step in range(11):
        reckoned.move(0.1 * step, Pose(0.03 * step, 0.0, 0.0), 0.1 * step)
    assert reckoned.pose.theta == pytest.approx(0.5, abs=0.02)


def test_a_turn_that_changes_between_samples_is_less_sure() -> None:
    def variance(samples: tuple[float, float]) -> float:
        reckoned = reckoning()
        for step in range(41):
            odometry = arc(0.3, 0.25, 0.1 * step)
            reckoned.move(0.1 * step, odometry, samples[step % 2])
        return float(spread_of(reckoned)[2])

    assert variance((0.0, 0.5)) > 2.0 * variance((0.25, 0.25))


def test_odometry_that_begins_anew_is_no_motion_and_a_long_gap_is_one() -> None:
    reckoned = reckoning()
    reckoned.move(1.0, Pose(5.0, 2.0, 1.0), None)
    reckoned.move(1.05, Pose(0.0, 0.0, 0.0), None)
    assert reckoned.pose == Pose()
    reckoned.move(1.1, Pose(0.02, 0.0, 0.0), None)
    assert same(reckoned.pose, Pose(0.02, 0.0, 0.0))
    reckoned.move(11.1, Pose(5.02, 0.0, 0.0), None)
    assert same(reckoned.pose, Pose(5.02, 0.0, 0.0))


def test_while_odometry_is_guessed_it_is_as_unsure_as_told_and_then_as_before() -> None:
    reckoned = reckoning()
    guessed = CONFIG.localization.model_copy(update={"way_noise": 0.2})

    def spread_of_a_metre(begin: int) -> float:
        spread_of(reckoned)
        for step in range(begin, begin + 41):
            reckoned.move(DT * step, Pose(0.025 * step), None)
        return float(spread_of(reckoned)[0])

    spread_of_a_metre(0)
    known = spread_of_a_metre(41)
    reckoned.begin_guessing(guessed)
    assert spread_of_a_metre(82) > 50.0 * known
    reckoned.end_guessing(CONFIG.localization)
    assert spread_of_a_metre(123) == pytest.approx(known, rel=0.05)
    assert reckoned.pose.x == pytest.approx(0.025 * 163)


def test_what_was_measured_of_the_wheels_does_not_count_for_what_is_guessed() -> None:
    reckoned = reckoning()
    calibration = reckoned.belief[0]["calibration"]
    calibration["errors"][0] = calibration["applied"][0] = 0.1
    calibration["is_applied"] = True
    reckoned.move(0.0, Pose(), None)
    reckoned.move(0.1, Pose(0.1), None)
    reckoned.begin_guessing(CONFIG.localization)
    reckoned.move(0.2, Pose(0.2), None)
    reckoned.end_guessing(CONFIG.localization)
    reckoned.move(0.3, Pose(0.3), None)
    assert reckoned.pose.x == pytest.approx(0.11 + 0.1 + 0.11)


def test_how_far_wheels_are_trusted_does_not_count_for_what_is_guessed() -> None:
    reckoned = reckoning()
    scale = reckoned.belief[0]["odometry_scale"]
    scale[:] = 5.0
    reckoned.begin_guessing(CONFIG.localization)
    assert (scale == 1.0).all()
    scale[:] = 3.0
    reckoned.end_guessing(CONFIG.localization)
    assert (scale == 5.0).all()
