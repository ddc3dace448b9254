"""Docking in the simulator, through the speed loop, with noise and late senses."""

from __future__ import annotations

import math

import pytest
from fixtures.robots.docking_rig import CONFIG, ROBOT, STATION, TICK, Rig
from fixtures.thoroughness import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st

from roomba.geometry import Pose, Twist
from roomba.mission.docking.docking import (
    Docking,
    DockSenses,
    DockState,
    DockStep,
    Trouble,
    staging_pose,
)
from roomba.world.engine.state.arrays import Fault


@given(
    st.floats(-0.05, 0.05),
    st.floats(-0.05, 0.05),
    st.floats(-0.35, 0.35),
    st.floats(0.0, 0.05),
    st.floats(-math.pi, math.pi),
    st.floats(-0.0524, 0.0524),
    st.integers(0, 3),
    st.integers(0, 1000),
)
@example(0.05, -0.05, -0.14, 0.05, -1.12, 0.0523, 0, 336)
@example(-0.05, 0.05, 0.35, 0.05, 1.57, -0.0523, 3, 1)
@settings(max_examples=examples(25))
def test_it_docks_from_where_it_is_brought(
    x: float, y: float, theta: float, off: float, way: float, turn: float, delay: int, seed: int
) -> None:
    wrong = Pose(off * math.cos(way), off * math.sin(way), turn)
    rig = Rig(Pose(x - 0.65, y, theta), wrong=wrong, delay=delay, seed=seed)
    step = rig.run(15.0)
    assert step == DockStep(DockState.DOCKED, Twist(), "", 1, None)
    assert rig.seconds < 9.0
    assert rig.hits == []
    rig.stay(0.5)
    assert rig.world.observe().battery.is_docked
    assert (
        rig.states
        == [
            DockState.SEARCHING,
            DockState.APPROACHING,
            DockState.TOUCHING,
            DockState.DOCKED,
        ][-len(rig.states) :]
    )


@given(
    st.floats(0.1, 1.5), st.floats(-1.25, 1.25), st.floats(-math.pi, math.pi), st.integers(0, 1000)
)
@example(0.1, 0.0, 0.0, 0)
@example(0.3, 1.2, 1.0, 0)
@settings(max_examples=examples(20))
def test_it_docks_from_anywhere_near(away: float, way: float, theta: float, seed: int) -> None:
    start = Pose(-away * math.cos(way), away * math.sin(way), theta)
    step = Rig(start, seed=seed).run(60.0)
    assert step.state is DockState.DOCKED
    assert step.attempts <= 3


def test_beside_the_way_or_too_near_it_first_goes_to_where_it_can_get_straight() -> None:
    starts = [
        Pose(-0.085, -0.13, 1.85),
        Pose(-0.3, 0.153, 1.24),
        Pose(-0.027, -0.205, -1.07),
        Pose(-0.05, 0.1, 3.0),
        Pose(-0.35, -0.15, -2.0),
        Pose(-0.15, 0.0, 1.6),
    ]
    for seed, start in enumerate(starts):
        step = Rig(start, wrong=Pose(0.02, -0.03, 0.04), seed=seed).run(30.0)
        assert (step.state, step.attempts) == (DockState.DOCKED, 1)


def test_docked_already_it_is_done_at_once() -> None:
    rig = Rig(Pose())
    assert rig.tick() == DockStep(DockState.DOCKED, Twist(), "", 0, None)
    rig.inject(Fault.STATION_DEAD)
    rig.stay(1.0)
    # What has ended stays so.
    assert set(rig.steps) == {DockStep(DockState.DOCKED, Twist(), "", 0, None)}


def test_in_the_station_without_current_it_goes_back_straight_and_tries_again() -> None:
    rig = Rig(Pose(-0.02, 0.0, 0.0), delay=0)
    rig.run_until(lambda step: step.twist.linear != 0.0)
    assert rig.steps[-1].state is DockState.BACKING_OFF
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    assert rig.pose.x < -0.35
    assert rig.run(20.0).state is DockState.DOCKED
    assert max(abs(pose.theta) for pose in rig.poses) < 0.5


@pytest.mark.parametrize("current_delay", [10, 20, 30])
@pytest.mark.parametrize("wrong", [Pose(), Pose(0.012, 0.01, 0.0), Pose(-0.012, 0.01, 0.0)])
def test_current_that_is_told_late_comes_before_it_meets_the_station(
    current_delay: int, wrong: Pose
) -> None:
    # As over a slow line: by then it would be past the contacts, which touch within 15 mm.
    rig = Rig(wrong=wrong, current_delay=current_delay)
    step = rig.run(20.0)
    assert (step.state, step.attempts) == (DockState.DOCKED, 1)
    assert rig.hits == []


def test_it_goes_slowly_at_the_end() -> None:
    rig = Rig(delay=0)
    rig.run()
    for pose, step in zip(rig.poses, rig.steps, strict=True):
        if pose.x > -0.07:
            assert step.twist.linear <= CONFIG.creep_speed + 1e-9
    assert max(step.twist.linear for step in rig.steps) > 2.0 * CONFIG.creep_speed


def test_the_current_must_last_before_it_is_docked() -> None:
    rig = Rig(delay=0)
    rig.run_until(lambda step: step.state is DockState.TOUCHING)
    rig.run()
    touching = rig.ticks_in(DockState.TOUCHING)
    assert len(touching) * TICK == pytest.approx(CONFIG.settle_time, abs=0.11)
    assert {step.twist for step in touching} == {Twist()}


def test_pressed_in_too_far_it_creeps_back_until_current_comes() -> None:
    rig = Rig(delay=0)
    rig.run_until(lambda step: step.state is DockState.TOUCHING)
    rig.world.put(STATION.compose(Pose(0.0349, 0.0, 0.0)))
    step = rig.run()
    assert (step.state, step.attempts) == (DockState.DOCKED, 1)
    backing = rig.ticks_in(DockState.BACKING_OFF)
    assert {round(step.twist.linear, 6) for step in backing} <= {0.0, -CONFIG.creep_speed}
    assert rig.states[-4:] == [
        DockState.TOUCHING,
        DockState.BACKING_OFF,
        DockState.TOUCHING,
        DockState.DOCKED,
    ]
    waited = len(rig.ticks_in(DockState.TOUCHING)) * TICK
    assert waited == pytest.approx(CONFIG.contact_wait + CONFIG.settle_time, abs=0.2)


def test_it_stops_in_time_though_it_creeps_at_twice_the_speed_and_senses_come_late() -> None:
    hasty = CONFIG.model_copy(update={"creep_speed": 2.0 * CONFIG.creep_speed})
    for seed in range(5):
        step = Rig(seed=seed, delay=3, config=hasty).run(30.0)
        assert (step.state, step.attempts) == (DockState.DOCKED, 1)


def test_with_its_receiver_covered_it_docks_by_its_place_and_says_so() -> None:
    rig = Rig(faults=[Fault.INFRARED_BLOCKED])
    step = rig.run(60.0)
    assert step.state is DockState.DOCKED
    assert "receiver" in step.reason
    rig = Rig(wrong=Pose(0.0, 0.05, 0.04), faults=[Fault.INFRARED_BLOCKED])
    step = rig.run(60.0)
    assert step.trouble is Trouble.NO_POWER
    assert step.attempts == 1


def test_beams_that_come_late_are_followed() -> None:
    rig = Rig(wrong=Pose(0.0, 0.05, 0.04), faults=[Fault.INFRARED_BLOCKED])
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    rig.run_until(lambda step: step.twist.linear > 0.15)
    rig.world.inject(Fault.INFRARED_BLOCKED, 0.0)
    step = rig.run(30.0)
    assert (step.state, step.reason) == (DockState.DOCKED, "")


def test_each_time_it_backs_off_to_another_side() -> None:
    rig = Rig()
    rig.put_obstacle(-0.3, 0.0)
    rig.run(60.0)
    turned = [step for step in rig.ticks_in(DockState.BACKING_OFF) if step.twist.linear < 0.0]
    sides = {step.attempts: math.copysign(1.0, step.twist.angular) for step in turned}
    assert sides[1] == sides[3] != sides[2] == sides[4]
    for attempt in (1, 2, 3, 4):
        ticks = [
            i for i, step in enumerate(rig.steps) if step in turned and step.attempts == attempt
        ]
        way = rig.poses[ticks[-1]].distance_to(rig.poses[ticks[0]].x, rig.poses[ticks[0]].y)
        assert 0.3 < way < 0.5


def test_it_finds_a_station_that_stands_somewhat_elsewhere() -> None:
    for off in (
        Pose(0.0, -0.3, 0.0),
        Pose(0.0, 0.3, 0.0),
        Pose(-0.2, 0.0, 0.0),
        Pose(0.2, 0.0, 0.1),
    ):
        rig = Rig(Pose(off.x - 0.65, off.y, off.theta), station=off)
        assert rig.run(60.0).state is DockState.DOCKED


def test_it_takes_no_longer_than_its_time_limit() -> None:
    short = CONFIG.model_copy(update={"time_limit": 4.0})
    rig = Rig(config=short)
    rig.put_obstacle(-0.3, 0.0)
    step = rig.run(10.0)
    assert step.trouble is Trouble.TIMEOUT
    assert rig.seconds == pytest.approx(4.0, abs=0.25)
    assert "blocked" in step.reason


@pytest.mark.parametrize("jump", [-1e4, 1e4, -0.04])
def test_a_clock_that_is_set_changes_nothing(jump: float) -> None:
    rig = Rig()
    for after in (1.0, 2.0, 1.5):
        rig.stay(after)
        rig.clock += jump
    step = rig.run(10.0)
    assert (step.state, step.attempts) == (DockState.DOCKED, 1)
    # And a failure is as late as ever.
    rig = Rig(Pose(-1.5, 0.5, 0.0))
    rig.is_known = False
    rig.stay(5.0)
    rig.clock += jump
    assert rig.run(20.0).trouble is Trouble.LOST
    assert rig.seconds == pytest.approx(CONFIG.lost_timeout, abs=2.3)


senses = st.builds(
    DockSenses,
    st.floats(0.0, 0.4),
    st.builds(Pose, st.floats(-1.5, 0.2), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0)),
    *[st.booleans()] * 6,
    st.just(False),
    st.booleans(),
)


@given(st.lists(st.tuples(senses, st.integers(1, 40)), min_size=1, max_size=25))
@settings(max_examples=examples(40))
def test_by_any_senses_it_keeps_to_its_speeds_and_ends(
    runs: list[tuple[DockSenses, int]],
) -> None:
    short = CONFIG.model_copy(update={"time_limit": 20.0})
    docking = Docking(short, ROBOT.body, ROBOT.station, Pose(), runs[0][0])
    now, states = 0.0, []
    for sensed, ticks in [*runs, (runs[-1][0], 500)]:
        for _ in range(ticks):
            now += TICK
            step = docking.tick(
                DockSenses(
                    now,
                    sensed.pose,
                    sensed.halo,
                    sensed.green,
                    sensed.red,
                    sensed.bumper_left,
                    sensed.bumper_right,
                    sensed.cliff,
                    sensed.is_charging,
                    sensed.is_known,
                )
            )
            assert step.twist.is_finite
            assert abs(step.twist.linear) <= CONFIG.speed + 1e-9
            assert abs(step.twist.angular) <= CONFIG.turning_speed + 1e-9
            assert step.attempts <= CONFIG.max_attempts
            assert (step.reason != "") == (step.state is DockState.FAILED)
            if step.state is DockState.APPROACHING and (sensed.bumper_left or sensed.bumper_right):
                assert step.twist == Twist()
            states.append(step.state)
    assert states[-1] is DockState.FAILED
    failed = states.index(DockState.FAILED)
    assert set(states[failed:]) == {DockState.FAILED}


def test_the_place_where_it_is_brought_looks_at_the_station() -> None:
    place = staging_pose(Pose(2.0, 1.0, math.pi / 2.0), CONFIG.staging_distance)
    assert (place.x, place.y) == pytest.approx((2.0, 0.35))
    assert place.theta == pytest.approx(math.pi / 2.0)


def test_a_station_nowhere_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        Docking(
            CONFIG, ROBOT.body, ROBOT.station, Pose(math.inf, 0.0, 0.0), DockSenses(0.0, Pose())
        )
