"""Finding the robot in its map, when it was carried, or told wrong, or asked to forget."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.corridors import AHEAD, TELLING, coarse_and_thick, ranges_ahead
from fixtures.homes.worlds import DT
from fixtures.robots.located import (
    CONFIG,
    FURNISHED,
    LIDAR,
    MOVED,
    SQUARE,
    START,
    TWO_ROOMS,
    WORST_ERROR,
    Eye,
    Located,
    Ranges,
    look_until_known,
    started,
    steps,
)
from fixtures.robots.missions import HOME
from fixtures.thoroughness import examples

from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

ELSEWHERE = [
    Pose(6.0, 1.2, 2.0),
    Pose(1.2, 2.6, -2.0),
    Pose(3.3, 0.6, 1.0),
    Pose(5.0, 3.0, 0.0),
    Pose(1.5, 1.0, 1.8),
]


@pytest.mark.parametrize("seed", range(examples(3)))
@pytest.mark.parametrize("to", ELSEWHERE)
def test_carried_away_it_knows_nothing_until_it_is_found(to: Pose, seed: int) -> None:
    robot = started(seed=seed)
    robot.carry(to)
    for _ in steps(0.1):
        robot.step(Twist())
        assert robot.estimate.knowledge is not Knowledge.KNOWN or robot.error < 0.15
    for _ in steps(6.0):
        robot.look()
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR
    assert robot.turn_error < math.radians(1.0)


def test_in_the_air_it_says_so_whatever_it_sees() -> None:
    robot = started()
    before = robot.estimate.pose
    robot.localizer.lift(True)
    for _ in range(3):
        robot.localizer.see(robot.world.time, robot.world.ranges, LIDAR)
        assert robot.estimate.knowledge is Knowledge.SEARCHING
        assert "wheels hang in the air" in robot.estimate.reason
        assert robot.localizer.sight_to_look_around is None
    assert robot.estimate.pose == before
    robot.localizer.lift(False)
    assert "lifted and set down again" in robot.estimate.reason
    # The next scan may tell; if none comes, nothing says where there is room to go.
    assert robot.localizer.sight_to_look_around is None
    robot.localizer.pass_time(robot.world.time + 2.0)
    assert robot.localizer.sight_to_look_around is None


@pytest.mark.parametrize("seed", range(examples(3)))
@pytest.mark.parametrize("to", ELSEWHERE)
def test_moved_without_a_wheel_drop_it_is_noticed_within_half_a_second(to: Pose, seed: int) -> None:
    robot = started(seed=seed)
    robot.world.put(to)
    for _ in steps(0.5):
        robot.look()
    for _ in steps(6.0):
        assert not robot.is_wrong
        robot.look()
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


@pytest.mark.parametrize(
    ("to", "before"),
    [
        (Pose(2.22, 1.89, 1.69), Pose(0.70, 0.90, -1.20)),
        (Pose(2.68, 1.33, -2.19), Pose(0.72, 0.78, 0.90)),
        (Pose(2.06, 0.55, -2.97), Pose(0.60, 1.80, 0.40)),
    ],
)
def test_carried_to_the_mirror_of_a_place_near_by_it_does_not_believe_itself_there(
    to: Pose, before: Pose
) -> None:
    """But for its station the room looks the same from the other side."""
    robot = Located(HOME, before)
    robot.stay(2.0)
    robot.world.put(to)
    for _ in steps(0.5):
        robot.look()
    for _ in steps(8.0):
        robot.look()
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_carried_to_where_a_place_near_by_looks_the_same_it_does_not_believe_itself_there() -> None:
    """From there a square room looks the same but for the station, which is hardly in sight."""
    near = Pose(1.1, 6.0, 1.6)
    turned = Pose(near.y, 10.0 - near.x, near.theta - 0.5 * math.pi)
    robot = Located(load_home("empty", HOMES), Pose(0.8, 6.1, 1.7))
    robot.stay(2.0)
    robot.world.put(turned)
    for _ in steps(1.0):
        robot.look()
    for _ in steps(8.0):
        assert not robot.is_wrong
        robot.look()
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_set_down_at_the_same_place_it_is_found_there() -> None:
    robot = started()
    robot.carry(robot.world.pose)
    look_until_known(robot, 5.0)
    assert robot.error < WORST_ERROR


def test_where_all_sides_look_alike_it_is_searched_for_and_then_lost_and_never_known() -> None:
    robot = started(SQUARE)
    robot.carry(Pose(1.9, 1.3, 2.0))
    robot.stay(0.3)
    middle = Pose(1.5, 1.5, 0.0)
    for step in steps(32.0):
        robot.look()
        estimate = robot.estimate
        is_early = step * DT < CONFIG.localization.search_timeout - 1.0
        if is_early:
            assert estimate.knowledge is Knowledge.SEARCHING
        assert not estimate.knowledge.is_usable
    assert estimate.knowledge is Knowledge.LOST
    assert "several places fit" in estimate.reason
    assert "tell where it is" in estimate.reason
    assert robot.localizer.sight_to_look_around is None
    # The true place is among the four.
    truth = robot.world.pose
    hypotheses = robot.localizer.hypotheses
    assert len(hypotheses) == 4
    assert min(each.distance_to(truth.x, truth.y) for each in hypotheses) < WORST_ERROR
    radii = [each.distance_to(middle.x, middle.y) for each in hypotheses]
    assert max(radii) - min(radii) < 0.05
    robot.localizer.told(truth, (0.1, 0.1))
    robot.stay(0.3)
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_the_likeliest_hypothesis_comes_first() -> None:
    """Of the left room's corner, seen to 1.3 m only; the truth has the evidence of more views."""
    robot = started()
    assert robot.localizer.hypotheses == [robot.estimate.pose]
    robot.see_as = lambda ranges: np.where(ranges < 1.6, ranges, np.inf).astype(np.float32)
    robot.carry(Pose(0.7, 0.7, 0.3))
    firsts, lasts = [], []
    for _ in steps(6.0):
        robot.look()
        assert not robot.is_wrong
        hypotheses = robot.localizer.hypotheses
        if len(hypotheses) > 1:
            truth = robot.world.pose
            away = [each.distance_to(truth.x, truth.y) for each in hypotheses]
            firsts.append(away[0] < WORST_ERROR)
            lasts.append(away[-1] < WORST_ERROR)
    assert len(firsts) > 10
    assert np.mean(firsts) > 0.7
    assert np.mean(lasts) < 0.2


@pytest.mark.parametrize(
    "off",
    [
        Pose(0.28, 0.28, math.radians(20.0)),
        Pose(-0.4, 0.0, math.radians(-20.0)),
        Pose(0.0, 0.4, math.radians(20.0)),
        Pose(0.28, -0.28, math.radians(-20.0)),
    ],
)
@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_a_pose_that_is_told_a_little_wrong_is_corrected(home: Home, off: Pose) -> None:
    told = Pose(START.x + off.x, START.y + off.y, START.theta + off.theta)
    robot = Located(home, START, told=told)
    robot.stay(0.5)
    for _ in steps(3.0):
        robot.look()
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


@pytest.mark.parametrize(
    "told",
    [
        Pose(6.0, 2.0, 0.3),
        # There three of four beams fit: the room looks much the same, turned by a quarter.
        Pose(3.0, 1.0, START.theta + 0.5 * math.pi),
        Pose(3.3, 0.6, 2.0),
        Pose(2.4, 2.0, 0.0),
        Pose(50.0, -20.0, 1.0),
    ],
)
def test_a_pose_that_is_told_elsewhere_is_corrected_or_refused(told: Pose) -> None:
    robot = Located(TWO_ROOMS, START, told=told)
    robot.stay(0.5)
    for _ in steps(4.0):
        robot.look()
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_what_is_told_unsurely_is_rough_until_scans_confirm_it() -> None:
    robot = started()
    robot.localizer.told(Pose(1.1, 0.9, 0.2), (0.5, 0.3))
    assert robot.estimate.knowledge is Knowledge.ROUGH
    assert robot.estimate.pose == Pose(1.1, 0.9, 0.2)
    look_until_known(robot, 5.0)
    assert robot.error < WORST_ERROR


def test_told_to_forget_it_looks_in_the_whole_map() -> None:
    robot = started()
    robot.localizer.forget("the operator asked for it")
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    assert robot.estimate.reason == "the operator asked for it"
    look_until_known(robot, 5.0)
    assert robot.error < WORST_ERROR


def test_a_search_that_found_nothing_is_tried_anew() -> None:
    """A person's feet are all around it, for a while; it stands."""
    robot = started()
    random = np.random.default_rng(1)
    feet = random.uniform(0.3, 6.0, LIDAR.beams).astype(np.float32)
    robot.see_as = lambda ranges: feet
    robot.localizer.forget("the operator asked for it")
    robot.stay(0.5)
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    robot.see_as = lambda ranges: ranges
    robot.stay(2.0)
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_told_to_forget_before_anything_is_sensed_it_is_not_lost_at_once() -> None:
    robot = Localizer(TWO_ROOMS.map, CONFIG.localization, CONFIG.gyro, 0.17, START)
    robot.forget("it was not told where it is")
    robot.move(1.7e9, Pose(), 0.0)
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    robot.move(1.7e9 + CONFIG.localization.search_timeout + 1.0, Pose(), 0.0)
    assert robot.estimate.knowledge is Knowledge.LOST


def test_a_robot_that_sees_too_little_is_lost_in_the_end_though_it_was_told() -> None:
    """Half a dozen beams never confirm a pose: a metre unsure, it is not to be driven by."""
    robot = Located(TWO_ROOMS, START)
    robot.world.step(Twist(), 0.1)
    few = np.full_like(robot.world.ranges, np.inf)
    few[:3] = robot.world.ranges[:3]
    for step in range(3000):
        robot.localizer.move(0.05 * step, Pose(0.5 * 0.05 * step, 0.0, 0.0), 0.0)
        if step < 3:
            robot.localizer.see(0.05 * step, few, LIDAR)
    assert robot.estimate.position_deviation > CONFIG.localization.lost_deviation
    assert robot.estimate.knowledge is Knowledge.LOST


def test_what_closes_in_on_it_does_not_take_its_place_away() -> None:
    """Things come nearer on three sides, until hardly any beam meets what the map shows."""
    robot = started()
    nearest = 4.0

    def closing_in(ranges: Ranges) -> Ranges:
        seen = ranges.copy()
        seen[:270] = np.minimum(seen[:270], nearest)
        return seen

    robot.see_as = closing_in
    for _ in steps(60.0):
        nearest = max(0.35, nearest - 0.065 * DT)
        robot.step(Twist())
        assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.estimate.agreement < 0.35
    assert robot.error < WORST_ERROR


def test_what_stands_around_it_all_at_once_makes_it_look_for_its_place() -> None:
    robot = started()
    robot.stay(2.0)
    robot.see_as = lambda ranges: np.minimum(ranges, 0.35).astype(np.float32)
    robot.stay(2.0)
    assert robot.estimate.knowledge is Knowledge.SEARCHING


def test_wrong_all_along_it_finds_that_out_though_it_was_not_carried() -> None:
    robot = Located(TWO_ROOMS, START)
    robot.stay(2.0)
    robot.localizer.belief["pose"] = (6.0, 2.0, 0.3)
    for _ in steps(8.0):
        robot.look()
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_told_where_a_scan_fits_in_part_it_goes_on_while_places_are_compared() -> None:
    robot = Located(MOVED, START)
    states = set()
    for _ in steps(3.0):
        robot.look()
        states.add(robot.estimate.knowledge)
        assert robot.error < 2.0 * WORST_ERROR
    assert states == {Knowledge.ROUGH, Knowledge.KNOWN}
    assert robot.estimate.knowledge is Knowledge.KNOWN


def test_in_a_corridor_on_a_coarse_map_it_is_found_on_its_way_and_held() -> None:
    """The lidar looks one way only, and walls are drawn 20 cm thicker than they are."""
    localizer = Localizer(
        coarse_and_thick(TELLING, 2), CONFIG.localization, CONFIG.gyro, CONFIG.body.radius, Pose()
    )
    eye, pose, odometry, known = Eye(TELLING), Pose(4.0, 0.9, 0.0), Pose(), []
    localizer.move(0.0, odometry, None)
    localizer.forget("no start was given")
    for number in range(1, 240):
        pose = pose.compose(Pose(0.1, 0.0, 0.0))
        odometry = odometry.compose(Pose(0.102, 0.0, 0.0005))
        localizer.move(0.2 * number, odometry, None)
        localizer.see(0.2 * number, ranges_ahead(TELLING, pose, eye), AHEAD)
        estimate = localizer.estimate
        if estimate.knowledge.is_usable:
            known.append(estimate.pose.distance_to(pose.x, pose.y))
    assert len(known) > 30
    assert max(known) < 0.2
    assert localizer.estimate.knowledge is Knowledge.KNOWN
