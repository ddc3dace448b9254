"""The whole of localization in the simulator, with the noise that the robot's sensors have."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import (
    CLOSED,
    CONFIG,
    CORRIDOR,
    FURNISHED,
    HASTY,
    LIDAR,
    MOVED,
    SQUARE,
    START,
    TWO_ROOMS,
    WORST_ERROR,
    Located,
    Ranges,
    glass,
    look_until_known,
    started,
    steps,
)
from numpy.typing import NDArray

from roomba.geometry import Pose, Twist
from roomba.grid import FREE, OCCUPIED
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.world.home.home import Home


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_it_knows_where_it_is_all_the_way(home: Home) -> None:
    robot = Located(home, START)
    for _ in steps(12.0):
        robot.look()
        estimate = robot.estimate
        assert estimate.knowledge is Knowledge.KNOWN
        assert estimate.reason == ""
        assert robot.error < 0.02
        assert robot.turn_error < math.radians(1.0)
    assert estimate.agreement > 0.9
    assert estimate.position_deviation < 0.02
    assert (
        robot.world.pose.distance_to(START.x, START.y) > 0.3
        or robot.world.numbers["distance"] > 1.5
    )


def test_the_frame_of_the_odometry_lies_where_it_fits() -> None:
    robot = started()
    odometry = robot.world.observe().odometry
    there = robot.localizer.map_to_odometry.compose(odometry)
    assert there.distance_to(robot.world.pose.x, robot.world.pose.y) < 0.02


def test_the_frame_of_the_odometry_is_that_of_the_wheels_wherever_they_began() -> None:
    robot = Localizer(TWO_ROOMS.map, CONFIG.localization, CONFIG.gyro, 0.17, START)
    odometry = Pose(3.0, 4.0, 1.0)
    robot.move(1.0, odometry)
    odometry = odometry.compose(Pose(0.5, 0.0, 0.4))
    robot.move(2.0, odometry)
    there = robot.map_to_odometry.compose(odometry)
    expected = START.compose(Pose(0.5, 0.0, 0.4))
    for found in (there, robot.estimate.pose):
        assert found.distance_to(expected.x, expected.y) < 1e-6
        assert found.theta == pytest.approx(expected.theta)


def test_a_few_beams_of_something_near_make_no_doubts() -> None:
    """All others come back from nowhere."""
    robot = started()

    def see_feet(ranges: Ranges) -> Ranges:
        few = np.full_like(ranges, np.inf)
        few[:12] = 0.4
        return few

    robot.see_as = see_feet
    for _ in steps(2.0):
        robot.step(Twist(0.0, 0.3))
        assert robot.estimate.knowledge in (Knowledge.KNOWN, Knowledge.ROUGH)
        assert robot.error < WORST_ERROR


def add_discs(robot: Located) -> None:
    for x, y in ((2.2, 0.6), (3.2, 1.2), (1.0, 2.7), (3.6, 2.6)):
        robot.world.place_obstacle(x, y, 0.12)


def make_glass(behind: float) -> Callable[[Located], None]:
    def make(robot: Located) -> None:
        robot.see_as = lambda ranges: glass(ranges, robot.world.pose, behind)

    return make


def nothing(robot: Located) -> None:
    pass


CHANGES = [
    pytest.param(MOVED, nothing, id="moved furniture"),
    pytest.param(CLOSED, nothing, id="closed door"),
    pytest.param(FURNISHED, add_discs, id="unknown discs"),
    pytest.param(FURNISHED, make_glass(math.inf), id="glass"),
    pytest.param(SQUARE, make_glass(math.inf), id="glass in an empty room"),
    pytest.param(FURNISHED, make_glass(2.0), id="glass and what is behind"),
    pytest.param(SQUARE, make_glass(2.0), id="glass in an empty room and what is behind"),
]


@pytest.mark.parametrize(("home", "change"), CHANGES)
@pytest.mark.parametrize("seed", range(2))
def test_what_the_map_does_not_show_drags_nothing_away(
    home: Home, change: Callable[[Located], None], seed: int
) -> None:
    """It may doubt; it ends nowhere else than where it is."""
    robot = Located(home, START, seed)
    change(robot)
    for _ in steps(8.0):
        robot.look()
        assert robot.error < WORST_ERROR


@pytest.mark.parametrize(("home", "change"), CHANGES)
def test_in_a_changed_home_a_robot_that_is_told_right_is_known(
    home: Home, change: Callable[[Located], None]
) -> None:
    robot = Located(home, START)
    change(robot)
    robot.stay(0.5)
    look_until_known(robot, 12.0)
    assert robot.error < WORST_ERROR


@pytest.mark.parametrize("change", [add_discs, make_glass(2.0), make_glass(math.inf)])
def test_a_home_that_changes_before_its_eyes_stays_known_or_is_found_again(
    change: Callable[[Located], None],
) -> None:
    robot = started(FURNISHED)
    change(robot)
    for _ in steps(6.0):
        robot.look()
        assert robot.error < WORST_ERROR
    assert robot.estimate.knowledge is Knowledge.KNOWN


def test_along_a_corridor_without_features_it_says_that_it_is_unsure() -> None:
    """Both ends are out of reach."""
    robot = Located(CORRIDOR, Pose(13.2, 0.6, 0.0), localization=HASTY, deviation=(0.01, 0.01))
    assert robot.estimate.knowledge is not Knowledge.LOST
    seen = set()
    for _ in steps(12.0):
        robot.step(Twist(0.3, 0.0))
        estimate = robot.estimate
        seen.add(estimate.knowledge)
        assert math.sqrt(estimate.covariance[1, 1]) < 0.02
        assert robot.error < 3.0 * estimate.position_deviation
        if estimate.knowledge is Knowledge.ROUGH:
            assert "what is in sight does not tell" in estimate.reason
    assert Knowledge.ROUGH in seen
    assert Knowledge.SEARCHING not in seen


def test_without_a_map_it_goes_by_wheels_and_gyro_until_there_is_one() -> None:
    robot = Located(TWO_ROOMS, START)
    robot.localizer = Localizer(
        None, CONFIG.localization, CONFIG.gyro, CONFIG.body.radius, START, (0.05, 0.05)
    )
    for _ in steps(2.0):
        robot.look()
        assert robot.estimate.knowledge is Knowledge.ROUGH
        assert "no map" in robot.estimate.reason
        assert robot.error < 0.1
    robot.localizer.use_map(TWO_ROOMS.map)
    robot.stay(0.5)
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_the_same_map_again_changes_nothing() -> None:
    robot = started()
    field, before = robot.localizer.field, robot.estimate.covariance.copy()
    robot.localizer.use_map(room_like(TWO_ROOMS).map)
    assert robot.localizer.field is field
    assert (robot.estimate.covariance == before).all()


def room_like(home: Home) -> Home:
    """The same once more, so that nothing is told by identity."""
    again = room_home(7.0, 4.0)
    again.map.values[:] = home.map.values
    return again


def test_another_map_is_used_and_the_pose_stays() -> None:
    """On it the door is closed, as it really is."""
    robot = started(CLOSED)
    field = robot.localizer.field
    another = room_like(TWO_ROOMS).map
    another.values[~CLOSED.solid] = FREE
    another.values[CLOSED.solid] = OCCUPIED
    robot.localizer.use_map(another)
    assert robot.localizer.field is not field
    assert robot.error < WORST_ERROR
    for _ in steps(2.0):
        robot.look()
        assert robot.estimate.knowledge is Knowledge.KNOWN
        assert robot.error < WORST_ERROR
    assert robot.estimate.agreement > 0.95


def test_another_map_does_not_bring_back_what_was_forgotten() -> None:
    robot = started()
    robot.carry(Pose(6.0, 1.2, 2.0))
    robot.step(Twist())
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    another = room_like(TWO_ROOMS).map
    another.values[40:50, 60:70] = OCCUPIED
    robot.localizer.use_map(another)
    assert robot.estimate.knowledge is Knowledge.SEARCHING or robot.error < 0.15


@pytest.mark.parametrize("back", [0.3, 0.9, 1.5, 5.0, 1000.0])
def test_a_clock_that_is_set_back_changes_nothing(back: float) -> None:
    robot = Located(TWO_ROOMS, START)
    robot.clock = 5000.0
    for _ in steps(2.0):
        robot.look()
    robot.clock -= back
    for _ in steps(3.0):
        robot.look()
        assert robot.estimate.knowledge is Knowledge.KNOWN
        assert robot.error < WORST_ERROR
    # And what goes by time goes by the new one.
    robot.see_as = lambda ranges: None
    robot.stay(1.0)
    assert robot.estimate.knowledge is Knowledge.ROUGH


def test_a_lidar_that_dies_while_the_clock_is_set_back_is_noticed() -> None:
    robot = started()
    robot.clock = -1000.0
    robot.see_as = lambda ranges: None
    robot.stay(CONFIG.localization.scan_timeout + 0.2)
    assert robot.estimate.knowledge is Knowledge.ROUGH
    assert "the lidar sends no scans" in robot.estimate.reason


def test_a_search_while_the_clock_is_set_back_lasts_no_longer() -> None:
    robot = started(SQUARE)
    robot.localizer.forget("it was told so")
    robot.clock = -1000.0
    robot.stay(CONFIG.localization.search_timeout - 2.0)
    assert robot.estimate.knowledge is Knowledge.SEARCHING
    robot.stay(4.0)
    assert robot.estimate.knowledge is Knowledge.LOST


@pytest.mark.parametrize("late", [0.1, 0.5, 1.5])
def test_a_scan_that_comes_late_counts_for_where_it_was_taken(late: float) -> None:
    robot = started()
    waiting: list[tuple[float, NDArray[np.float32]]] = []

    def keep(ranges: NDArray[np.float32]) -> None:
        waiting.append((robot.world.time, ranges))

    robot.see_as = keep
    for step in steps(3.0):
        robot.step(Twist(0.2 if step < 40 else 0.0, 1.0))
        while waiting and waiting[0][0] <= robot.world.time - late:
            stamp, ranges = waiting.pop(0)
            robot.localizer.see(stamp, ranges, LIDAR)
        assert robot.error < WORST_ERROR
        assert robot.turn_error < math.radians(2.0)
    assert robot.estimate.agreement > 0.9
    assert robot.estimate.knowledge is not Knowledge.SEARCHING


@pytest.mark.parametrize("late", [0.1, 0.5])
def test_a_scan_that_comes_late_does_not_drag_the_pose_back(late: float) -> None:
    """Straight on, where it fits well enough now as well."""
    robot = started()
    waiting: list[tuple[float, NDArray[np.float32]]] = []
    robot.see_as = lambda ranges: waiting.append((robot.world.time, ranges))
    for _ in steps(3.0):
        robot.step(Twist(0.1, 0.0))
        while waiting and waiting[0][0] <= robot.world.time - late:
            stamp, ranges = waiting.pop(0)
            robot.localizer.see(stamp, ranges, LIDAR)
        assert robot.error < 0.01


@pytest.mark.parametrize("late", [0.75, 1.25])
def test_a_lidar_is_silent_when_no_scan_comes_and_not_when_each_is_late(late: float) -> None:
    """Two scans a second over a slow line, as a Neato sends them."""
    robot = started()
    on_line: list[tuple[float, NDArray[np.float32]]] = []
    told: list[tuple[Knowledge, str]] = []
    robot.see_as = lambda ranges: on_line.append((robot.world.time, ranges))
    for _ in steps(6.0):
        robot.step(Twist(0.05, 0.2))
        if on_line and on_line[0][0] <= robot.world.time - late:
            stamp, ranges = on_line.pop(0)
            on_line = [each for each in on_line if each[0] > stamp + 0.45]
            robot.localizer.see(stamp, ranges, LIDAR)
            told.append((robot.estimate.knowledge, robot.estimate.reason))
        elif told:
            told.append((robot.estimate.knowledge, robot.estimate.reason))
    assert len(told) > 60
    assert set(told) == {(Knowledge.KNOWN, "")}
    robot.see_as = lambda ranges: None
    robot.stay(CONFIG.localization.scan_timeout + 0.1)
    assert "the lidar sends no scans" in robot.estimate.reason


def test_a_scan_from_long_ago_is_left_out() -> None:
    robot = started()
    before = robot.estimate
    wrong = np.full(LIDAR.beams, 0.4, np.float32)
    for _ in range(20):
        robot.localizer.see(robot.world.time - 10.0, wrong, LIDAR)
    assert robot.estimate.pose == before.pose
    assert robot.estimate.knowledge is Knowledge.KNOWN


def test_another_number_of_beams_is_refused_and_changes_nothing() -> None:
    robot = started()
    before = robot.estimate
    with pytest.raises(ValueError, match="expected a scan of 360 ranges, got shape"):
        robot.localizer.see(robot.world.time, np.ones(180, np.float32), LIDAR)
    assert robot.estimate.pose == before.pose
    assert robot.estimate.knowledge is Knowledge.KNOWN


def test_the_same_input_gives_the_same_output_bit_for_bit() -> None:
    def trace() -> list[tuple[Pose, bytes, Knowledge, int]]:
        robot = Located(TWO_ROOMS, START, seed=4)
        found = []
        for step in steps(6.0):
            if step == 100:
                robot.world.put(Pose(6.0, 1.2, 2.0))
            robot.look()
            estimate = robot.estimate
            count = len(robot.localizer.hypotheses)
            found.append((estimate.pose, estimate.covariance.tobytes(), estimate.knowledge, count))
        return found

    assert trace() == trace()


def test_whatever_the_sensors_say_the_estimate_is_finite() -> None:
    random = np.random.default_rng(7)
    robot = Located(FURNISHED, START)
    for step in range(150):
        robot.localizer.move(
            0.1 * step, Pose(*random.uniform(-9.0, 9.0, 3).tolist()), float(random.normal(0.0, 9.0))
        )
        ranges = random.choice([np.nan, np.inf, -np.inf, -1.0, 0.0, 0.3, 2.0, 1e30], LIDAR.beams)
        robot.localizer.see(0.1 * step, ranges.astype(np.float32), LIDAR)
        estimate = robot.estimate
        pose = estimate.pose
        assert np.isfinite([pose.x, pose.y, pose.theta]).all()
        assert np.isfinite(estimate.covariance).all()
        assert np.linalg.eigvalsh(estimate.covariance)[0] > 0.0


def test_odometry_that_is_always_late_does_not_stop_the_time() -> None:
    """Stamps 0.3 s behind the clock are no clock that is set back at every message."""
    robot = Located(TWO_ROOMS, Pose(1.0, 1.0, 0.3))
    robot.world.step(Twist(), 0.1)
    for step in range(40):
        robot.localizer.move(0.05 * step, Pose(), 0.0)
        if step < 10 and step % 2 == 0:
            robot.localizer.see(0.05 * step, robot.world.ranges, LIDAR)
        robot.localizer.pass_time(0.05 * step + 0.3)
    assert robot.estimate.knowledge is Knowledge.ROUGH
    assert "sends no scans" in robot.estimate.reason


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_numbers_that_are_none_are_refused(bad: float) -> None:
    robot = Located(TWO_ROOMS, Pose(1.0, 1.0, 0.3))
    before = robot.estimate.pose
    with pytest.raises(ValueError, match="finite"):
        robot.localizer.move(1.0, Pose(bad, 0.0, 0.0), 0.0)
    with pytest.raises(ValueError, match="finite"):
        robot.localizer.move(1.0, Pose(), bad)
    assert robot.estimate.pose == before
