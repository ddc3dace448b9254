"""A robot that drives against a mirror: its map ends there, and stays so."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.free_walls import home_with, straight_wall
from fixtures.homes.worlds import DT, NOISY
from fixtures.robots.located import LIDAR
from fixtures.robots.mapped import CIRCLE, CUPBOARD, SHELF, Mapped, wrong_cells

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mirrors.mirror import KeptMirror
from roomba.perception.slam.mirrors.mirrors import Mirrors
from roomba.perception.slam.submap_map import SubmapMap
from roomba.perception.slam.submaps.parts import Carried

MIRROR = straight_wall([(0.8, 3.98), (2.6, 3.98)], "mirror", 0.02)
"""On the upper wall of the room, y = 4."""
GLASS = straight_wall([(0.8, 3.0), (2.6, 3.0)], "glass", 0.02)
START = Pose(2.5, 1.2, 0.0)
BODY = NOISY.body


def floor_behind(robot: Mapped, y: float = 4.1) -> float:
    """Return how much floor its map shows beyond a line, m2."""
    made = robot.mapper.occupancy()
    _, rows_y = made.frame.centres()
    beyond = made.values[np.asarray(rows_y).ravel() > y]
    return float((beyond == FREE).sum()) * made.frame.resolution**2


def driven_against(kind: str = "mirror", seed: int = 1) -> Mapped:
    """A robot that drove a circle, and then up until its bumper was pressed."""
    wall = MIRROR if kind == "mirror" else GLASS
    robot = Mapped(home_with([wall], (CUPBOARD, SHELF)), START, seed=seed)
    robot.drive(CIRCLE, 2.0 * math.pi * 0.75 / CIRCLE.angular)
    while abs(math.pi / 2.0 - robot.world.pose.theta % (2.0 * math.pi)) > 0.05:
        robot.drive(Twist(0.0, 0.4), DT)
    while not robot.world.observe().bumper.pressed:
        robot.drive(Twist(0.2, 0.0), DT)
    return robot


def feel(robot: Mapped) -> None:
    bumper = robot.world.observe().bumper
    robot.mapper.feel(BODY.radius, *BODY.pressed(bumper.left, bumper.right))


def test_a_mirror_in_which_it_saw_itself_is_no_room_even_before_it_touched_it() -> None:
    robot = driven_against()
    assert floor_behind(robot) < 0.1
    assert wrong_cells(robot.mapper.finish(), robot.world.home) == (0, 0)


def test_the_room_behind_a_touched_mirror_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    # It does not look for itself.
    monkeypatch.setattr(Mirrors, "_look_for_itself", lambda *_: None)
    robot = driven_against()
    before, version = floor_behind(robot), robot.mapper.version
    assert before > 3.0, "it took what it saw in it for a room"
    feel(robot)
    assert robot.mapper.version > version
    assert floor_behind(robot) < 0.1
    robot.drive(Twist(-0.1, 0.0), 2.0).drive(Twist(0.0, 0.5), 8.0)
    assert floor_behind(robot) < 0.1
    finished = robot.mapper.finish()
    assert floor_behind(robot) < 0.1
    assert wrong_cells(finished, robot.world.home) == (0, 0)


def test_glass_does_not_hide_what_is_behind_it() -> None:
    robot = driven_against("glass")
    before, version = floor_behind(robot, 3.1), robot.mapper.version
    feel(robot)
    assert robot.mapper.version == version
    assert floor_behind(robot, 3.1) == before > 1.0


def test_another_process_knows_the_mirror_too() -> None:
    robot = driven_against()
    feel(robot)
    state = robot.mapper.state()
    assert state is not None
    assert len(state.mirrors) == 1
    config, here = robot.world.config, robot.mapper.pose
    robot.mapper = Mapper.taken_up(MappingConfig(), config.localization, config.gyro, state, here)
    assert floor_behind(robot) < 0.1
    robot.drive(Twist(-0.1, 0.0), 2.0).drive(Twist(0.0, 0.5), 8.0)
    assert floor_behind(robot) < 0.1


@pytest.mark.parametrize("is_lifted", [False, True])
def test_before_it_knows_where_it_is_a_touch_tells_nothing(is_lifted: bool) -> None:
    robot = driven_against() if is_lifted else Mapped()
    if is_lifted:
        robot.mapper.lift(is_lifted=True)
    version = robot.mapper.version
    robot.mapper.feel(BODY.radius, 0.0, 1.5)
    assert robot.mapper.version == version


def crossing(between: str) -> SubmapMap:
    """A map with a mirror across y = 1, and keyframes before and behind it, each of a place.

    ``between`` is what happens between the two.
    """
    config = NOISY
    made = SubmapMap(MappingConfig(), config.localization, np.zeros(3))
    made.use(LIDAR.arrays())
    points, ranges = np.ones((30, 4)), np.ones(LIDAR.beams, np.float32)
    before, behind = np.array([0.0, 0.8, 0.0]), np.array([0.0, 1.2, 0.0])
    made.mirrors.take_over([KeptMirror(0, np.array([0.0, 1.0, math.pi / 2.0]), np.ones(2))])
    made.keep(points, ranges, before)
    match between:
        case "a submap begins":
            made.begin(behind, 1.0, 0.01)
        case "it is carried":
            made.begin_piece(behind, 1.0, (1.0, 1.0), 0.01, carried=Carried.TOLD)
        case "it is told where it is":
            made.begin_at(behind, 1.0, 0.01)
    made.keep(points, ranges, behind if between == "nothing" else np.zeros(3))
    return made


@pytest.mark.parametrize("between", ["nothing", "a submap begins"])
def test_what_the_robot_drives_through_is_no_mirror(between: str) -> None:
    assert len(crossing(between).mirrors) == 0


@pytest.mark.parametrize("between", ["it is carried", "it is told where it is"])
def test_a_robot_that_was_carried_did_not_drive_through(between: str) -> None:
    assert len(crossing(between).mirrors) == 1


@pytest.mark.parametrize("ends", ["begin", "begin_piece", "begin_at", "finish"])
def test_each_submap_that_ends_tells_of_mirrors(ends: str, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []

    def see(_: Mirrors, number: int, *__: object) -> bool:
        seen.append(number)
        return False

    monkeypatch.setattr(Mirrors, "see", see)
    robot = driven_against()
    feel(robot)
    made, here = robot.mapper._map, np.zeros(3)
    newest = len(made.graph.submaps) - 1
    seen.clear()
    match ends:
        case "begin":
            made.begin(here, 5.0, 0.01)
        case "begin_piece":
            made.begin_piece(here, 5.0, (1.0, 1.0), 0.01, carried=None)
        case "begin_at":
            made.begin_at(here, 5.0, 0.01)
        case _:
            made.finish(0.01)
    assert seen == [newest]
