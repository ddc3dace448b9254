"""Making a map while something is wrong: sensors, clocks, wheels, and people."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import LIDAR, Ranges
from fixtures.robots.mapped import (
    AROUND,
    CIRCLE,
    FURNISHED,
    START,
    Mapped,
    driven_around,
    wrong_cells,
)

from roomba.geometry import Pose, Twist
from roomba.grid import OCCUPIED
from roomba.perception.localization.estimate import Knowledge
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Box, Move, MovingKind, MovingThing, Script

WORST = 0.03


def person(*moves: Move, pose: Pose) -> MovingThing:
    box = Box(0.0, 0.0, 0.0, 0.3, 0.4, 0.0, 1.7, "cloth")
    return MovingThing("person", MovingKind.PERSON, (box,), pose, True, Script(moves))


def test_a_scan_of_long_ago_is_left_out() -> None:
    robot = driven_around(0, 4.0)
    mapper, now = robot.mapper, robot.world.time
    before, version = mapper.pose, mapper.version
    for stamp in (now - 2.5, now - 1e6, 0.0):
        mapper.see(stamp, np.full(LIDAR.beams, 0.5, np.float32), LIDAR)
    assert mapper.pose == before
    assert mapper.version == version
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.drive(CIRCLE, 4.0).worst < WORST


@pytest.mark.parametrize(("jump", "drives"), [(-1e5, CIRCLE), (-1.0, CIRCLE), (1e5, CIRCLE)])
def test_a_clock_that_is_set_does_not_carry_it_away(jump: float, drives: Twist) -> None:
    robot = driven_around(1, 5.0).drive(drives, 0.5)
    robot.clock = jump
    robot.drive(drives, 0.5)
    robot.drive(CIRCLE, AROUND - 5.0)
    assert robot.worst < 0.05
    assert robot.error < WORST
    assert robot.knowledge is Knowledge.KNOWN
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


def test_a_blind_lidar_leaves_the_place_rough_and_the_map_as_it_is() -> None:
    robot = driven_around(2, 6.0)
    version = robot.mapper.version
    robot.world.inject(Fault.LIDAR_BLOCKED, 1.0)
    robot.drive(CIRCLE, 0.2)
    for _ in range(4):
        robot.drive(CIRCLE, 0.5)
        assert robot.knowledge is Knowledge.ROUGH
        assert "wheels and gyro" in robot.mapper.estimate.reason
    assert robot.mapper.version == version
    assert robot.error < 0.1
    robot.world.inject(Fault.LIDAR_BLOCKED, 0.0)
    robot.drive(CIRCLE, 1.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST
    robot.drive(CIRCLE, AROUND - 9.2)
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


@pytest.mark.parametrize("seconds", [4.0, 15.0])
def test_after_a_long_time_blind_on_a_wheel_that_slips_it_finds_back(seconds: float) -> None:
    """The longer it went by its wheels the farther around it looks for what it knows."""
    robot = driven_around(1, 5.0)
    robot.world.inject(Fault.LIDAR_BLOCKED, 1.0)
    robot.world.inject(Fault.SLIP_LEFT, 0.2)
    robot.drive(Twist(0.2, 0.2), seconds)
    assert robot.error > 0.05
    assert robot.turn_error > 0.02
    robot.world.inject(Fault.LIDAR_BLOCKED, 0.0)
    robot.world.inject(Fault.SLIP_LEFT, 0.0)
    robot.drive(Twist(0.1, 0.1), 2.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


@pytest.mark.parametrize("to", [Pose(4.4, 1.8, 0.5), Pose(6.3, 0.9, 2.5)])
def test_put_elsewhere_unnoticed_it_draws_nothing_wrong(to: Pose) -> None:
    """Behind a wall, where it has never been."""
    home = room_home(7.0, 2.4, ((3.5, 0.0, 3.6, 2.4), (5.0, 1.9, 5.6, 2.4)))
    robot = Mapped(home, Pose(1.0, 1.0, 0.0)).drive(Twist(0.2, 0.0), 4.0).drive(Twist(0, 0.5), 3.0)
    version = robot.mapper.version
    robot.world.put(to)
    for _ in range(10):
        robot.drive(Twist(0.0, 0.3), 0.2)
        assert robot.knowledge is Knowledge.ROUGH
    assert robot.mapper.version == version


@pytest.mark.parametrize("to", [Pose(2.5, 2.6, 2.0), Pose(3.4, 1.2, -2.5)])
def test_carried_unnoticed_what_it_sees_then_is_laid_where_it_fits(to: Pose) -> None:
    """The wheels did not tell; while it drives on it draws the room twice."""
    robot = driven_around(1, 2.0 * AROUND)
    robot.world.put(to)
    for _ in range(12):
        robot.drive(Twist(0.2, 0.25), 4.0).drive(Twist(0.2, -0.1), 1.0)
    assert robot.error > 1.0
    assert len(robot.mapper.ways_apart) == 1
    made = robot.mapper.finish()
    assert robot.mapper.ways_apart == []
    assert robot.mapper.parts_laid == 1
    assert wrong_cells(made, FURNISHED) == (0, 0)
    assert robot.error < WORST


def test_set_down_elsewhere_it_goes_on_apart_until_the_map_is_finished() -> None:
    robot = driven_around(1, 2.0 * AROUND)
    robot.mapper.lift(True)
    robot.world.put(Pose(3.4, 1.2, -2.5))
    version = robot.mapper.version
    robot.drive(Twist(), 1.0)
    assert robot.mapper.version == version
    robot.mapper.set_down()
    for _ in range(12):
        robot.drive(Twist(0.2, 0.25), 4.0).drive(Twist(0.2, -0.1), 1.0)
    assert robot.mapper.version > version
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)
    assert robot.error < WORST


@pytest.mark.parametrize("is_told", [True, False])
def test_a_map_that_ends_as_it_was_set_down_is_whole(is_told: bool) -> None:
    """No scan came since: the map is that of before."""
    robot = driven_around(1, AROUND)
    robot.mapper.lift(True)
    if is_told:
        robot.mapper.told(robot.world.pose)
    else:
        robot.mapper.lift(False)
        robot.mapper.set_down()
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)
    assert robot.mapper.ways_apart == []


def test_blind_from_the_beginning_it_begins_when_it_sees() -> None:
    robot = Mapped()
    robot.world.inject(Fault.LIDAR_BLOCKED, 1.0)
    robot.drive(CIRCLE, 1.0)
    assert robot.mapper.version == 0
    assert robot.knowledge is Knowledge.ROUGH
    robot.world.inject(Fault.LIDAR_BLOCKED, 0.0)
    assert robot.drive(CIRCLE, AROUND).error < 0.06
    assert robot.mapper.version > 20


@pytest.mark.parametrize("fault", [Fault.SLIP_LEFT, Fault.SLIP_RIGHT])
def test_a_wheel_that_slips_does_not_carry_it_away(fault: Fault) -> None:
    robot = Mapped(seed=1)
    robot.world.inject(fault, 0.2)
    # The circle becomes another one, of 0.6 m or of 2 m.
    robot.drive(Twist(0.25, 0.25), 5.0).drive(Twist(), 0.5).drive(Twist(0.0, 1.0), 8.0)
    assert robot.worst < 0.05
    assert robot.knowledge is Knowledge.KNOWN
    made = robot.mapper.finish()
    assert robot.error < WORST
    assert wrong_cells(made, FURNISHED) == (0, 0)


def test_a_person_who_walks_through_leaves_nothing_behind() -> None:
    """There and back behind the circle, 0.5 m/s."""
    walk = [Move(2.0, 8.0, Pose(4.2, 2.4, 1.6)), Move(11.0, 8.0, Pose(4.2, 0.5, -1.6))]
    home = room_home(
        5.0,
        4.0,
        ((3.3, 3.1, 3.8, 4.0), (0.0, 1.4, 0.3, 1.9)),
        moving=(person(*walk, Move(20.0, 0.0, Pose(), False), pose=Pose(4.2, 0.5, 1.6)),),
    )
    robot = Mapped(home, seed=1).drive(CIRCLE, 2.0 * AROUND)
    assert robot.worst < WORST
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


def test_a_person_who_stands_there_is_drawn() -> None:
    home = room_home(5.0, 4.0, moving=(person(pose=Pose(4.2, 2.0, 0.0)),))
    made = Mapped(home).drive(CIRCLE, AROUND).mapper.finish()
    row, column = made.frame.cell_of(4.2, 2.0)
    around = made.values[row - 6 : row + 7, column - 6 : column + 7]
    assert (around == OCCUPIED).sum() >= 8


def test_a_single_wrong_scan_is_outvoted() -> None:
    """Another home's walls for a tenth of a second."""
    robot = driven_around(3, 6.0)
    wrong = np.random.default_rng(1).uniform(0.4, 3.0, LIDAR.beams).astype(np.float32)
    robot.see_as = lambda ranges: wrong
    robot.drive(CIRCLE, 0.1)
    robot.see_as = lambda ranges: ranges
    robot.drive(CIRCLE, AROUND - 6.1)
    assert robot.worst < WORST
    assert wrong_cells(robot.mapper.finish(), FURNISHED) == (0, 0)


def crowd(ranges: Ranges) -> Ranges:
    """Legs half a metre away, but for a gap through which little is seen."""
    around = np.full_like(ranges, 0.5)
    around[30:90] = ranges[30:90]
    return around


def bent(ranges: Ranges) -> Ranges:
    """All a tenth farther than it is, as through glass."""
    return (1.1 * ranges).astype(np.float32)


@pytest.mark.parametrize("see_as", [crowd, bent])
def test_what_fits_badly_is_not_gone_by(see_as: Callable[[Ranges], Ranges]) -> None:
    robot = driven_around(1, 8.0)
    version = robot.mapper.version
    robot.see_as = see_as
    for _ in range(5):
        robot.drive(CIRCLE, 0.2)
        assert robot.knowledge is Knowledge.ROUGH
    assert robot.mapper.version == version
    assert robot.error < 0.05
    robot.see_as = lambda ranges: ranges
    robot.drive(CIRCLE, 2.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < WORST


def test_numbers_that_are_none_are_no_beams() -> None:
    robot = driven_around(4, 3.0)

    def spoil(ranges: Ranges) -> Ranges:
        ranges[::4] = np.nan
        ranges[1::4] = -np.inf
        return ranges

    robot.see_as = spoil
    robot.drive(CIRCLE, 5.0)
    assert robot.worst < WORST
    assert all(map(math.isfinite, robot.mapper.trajectory.ravel()))
    assert robot.knowledge is Knowledge.KNOWN


def carried(robot: Mapped, to: Pose) -> Mapped:
    """Lift it, carry it, and set it down."""
    robot.mapper.lift(True)
    robot.world.inject(Fault.LIFTED, 1.0)
    robot.drive(Twist(), 0.3)
    robot.world.put(to)
    robot.drive(Twist(), 0.3)
    robot.world.inject(Fault.LIFTED, 0.0)
    robot.mapper.lift(False)
    return robot.drive(Twist(), 0.5)


def test_carried_elsewhere_it_is_lost_until_it_is_told() -> None:
    robot = carried(driven_around(0, 8.0), Pose(1.2, 3.0, 2.0))
    version = robot.mapper.version
    assert robot.knowledge is Knowledge.LOST
    assert "put it on its station" in robot.mapper.estimate.reason
    robot.drive(Twist(0.1, 0.0), 1.0)
    assert robot.knowledge is Knowledge.LOST
    assert robot.mapper.version == version
    robot.worst = 0.0
    true = robot.world.pose
    robot.mapper.told(Pose(true.x + 0.03, true.y - 0.03, true.theta + 0.03))
    robot.drive(Twist(0.0, 0.5), 3.0).drive(Twist(0.2, 0.0), 1.0)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.worst < 0.06
    made = robot.mapper.finish()
    assert robot.error < WORST
    assert wrong_cells(made, FURNISHED) == (0, 0)


@pytest.mark.parametrize("to", [Pose(1.2, 3.0, 2.0), Pose(4.2, 1.0, -2.5), Pose(0.8, 0.8, 0.3)])
def test_carried_about_the_room_it_finds_itself_when_it_drives(to: Pose) -> None:
    """Two scans from different places agree; the map goes on as if it had been told."""
    robot = carried(driven_around(0, 8.0), to)
    assert robot.knowledge is Knowledge.LOST
    robot.drive(Twist(0.15, 0.5), 2.5)
    assert robot.knowledge is Knowledge.KNOWN
    assert robot.error < 0.06
    robot.drive(Twist(0.1, 0.5), 4.0)
    made = robot.mapper.finish()
    assert robot.error < WORST
    assert wrong_cells(made, FURNISHED) == (0, 0)


def test_carried_into_a_room_that_it_has_not_seen_it_stays_lost_and_draws_nothing() -> None:
    home = room_home(7.0, 2.4, ((3.5, 0.0, 3.6, 2.4), (5.0, 1.9, 5.6, 2.4)))
    robot = Mapped(home, Pose(1.0, 1.0, 0.0)).drive(Twist(0.2, 0.0), 4.0).drive(Twist(0, 0.5), 3.0)
    version = robot.mapper.version
    carried(robot, Pose(4.4, 1.0, 0.5)).drive(Twist(0.15, 0.5), 4.0)
    assert robot.knowledge is Knowledge.LOST
    assert robot.mapper.version == version


def test_told_where_it_is_before_it_saw_anything() -> None:
    robot = Mapped()
    robot.mapper.told(START)
    assert robot.drive(CIRCLE, 5.0).worst < WORST
