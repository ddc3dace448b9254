"""Walks where something stands that the map does not show and the lidar sees."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.homes.worlds import block_that_moves
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.robot import RobotConfig
from roomba.configuration.things import ThingConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.headless.records import WalkRecord
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState
from roomba.perception.localization.estimate import Knowledge
from roomba.planning.path.planner import NoPathError, PathPlanner
from roomba.world.home.home import Home, Move, MovingThing

CONFIG = RobotConfig()
WALL: Block = (2.4, 0.0, 2.5, 2.6)
"""Leaves a way of 1.4 m at the top of the room."""
GAP = Pose(2.45, 3.3)
BEHIND = (4.0, 1.0)
SURELY = 0.05
"""m; a body with so much room on each side of it fits for sure."""


def shut_until(time: float) -> MovingThing:
    """Return what shuts the way at the top until it is taken away, s."""
    gone = Move(time, 0.0, GAP, is_present=False)
    return block_that_moves(gone, pose=GAP, size=(0.1, 1.4))


def nearest(record: WalkRecord, x: float, y: float) -> float:
    return float(np.hypot(record.poses[:, 1] - x, record.poses[:, 2] - y).min())


def test_before_what_shuts_its_way_it_waits_and_goes_on_when_that_is_gone() -> None:
    robot = HeadlessMission(room_home(blocks=[WALL], moving=[shut_until(12.0)]))
    record = robot.walk(*BEHIND)
    assert record.state is WalkState.ARRIVED
    assert record.bumps == 0
    assert record.duration > 12.0
    assert any("map does not show" in step.reason for step in record.steps)


def test_it_does_not_wait_for_ever_and_tells_where_what_stands() -> None:
    robot = HeadlessMission(room_home(blocks=[WALL], moving=[shut_until(1000.0)]))
    record = robot.walk(*BEHIND)
    assert record.state is WalkState.FAILED
    assert record.bumps == 0
    assert "map does not show" in record.reason
    assert "no way around it" in record.reason
    waited = [step for step in record.steps if step.cruise_speed == 0.0]
    assert 0.05 * len(waited) == pytest.approx(CONFIG.walk.blocked_wait, abs=1.5)


def test_where_something_stood_it_goes_and_looks_again() -> None:
    """What shut the way is taken away while the robot is too far off to see it."""
    gap, behind = Pose(6.45, 3.3), (8.0, 1.0)
    gone = Move(60.0, 0.0, gap, is_present=False)
    leaf = block_that_moves(gone, pose=gap, size=(0.1, 1.4))
    robot = HeadlessMission(room_home(9.0, 4.0, blocks=[(6.4, 0.0, 6.5, 2.6)], moving=[leaf]))
    assert robot.walk(*behind).state is WalkState.FAILED
    while robot.simulator.time < 60.0:
        robot.walk(0.5, 0.5)
        robot.walk(0.5, 1.0)
    assert robot.mission.obstacles.standing(robot.simulator.time), "it remembers what it saw"
    assert robot.walk(*behind).state is WalkState.ARRIVED


def test_a_thing_that_is_taken_away_is_forgotten() -> None:
    at = Pose(2.5, 2.0)
    gone = Move(15.0, 0.0, at, is_present=False)
    robot = HeadlessMission(
        room_home(moving=[block_that_moves(gone, pose=at)], station=Pose(0.5, 2.0, 0.0))
    )
    there = robot.walk(4.5, 2.0)
    assert there.state is WalkState.ARRIVED
    assert there.bumps == 0
    assert nearest(there, at.x, at.y) > CONFIG.body.radius + 0.2
    # So many scans through where it stood it takes until that is sure; of some no beam goes there.
    scans = 2 * math.ceil(ThingConfig().most / ThingConfig().loss)
    while robot.simulator.time < 15.0 + scans / robot.robot_config.lidar.rate:
        robot.walk(4.5, 3.0)
        robot.walk(4.5, 2.0)
    back = robot.walk(0.5, 2.0)
    assert back.state is WalkState.ARRIVED
    assert nearest(back, at.x, at.y) < 0.1
    assert robot.mission.obstacles.standing(robot.simulator.time) == []


@pytest.mark.parametrize(
    ("half", "told"),
    [(0.1, "at the goal: (3.00, 2.00) cannot"), (0.4, "no way around it: (3.00, 2.00) cannot")],
    ids=["small", "large: only its sides are seen"],
)
def test_a_thing_on_the_goal_is_told_as_the_reason(half: float, told: str) -> None:
    thing = (3.0 - half, 2.0 - half, 3.0 + half, 2.0 + half)
    record = HeadlessMission(room_home(hidden=[thing])).walk(3.0, 2.0)
    assert record.state is WalkState.FAILED
    assert record.bumps == 0
    assert "something that the map does not show stands" in record.reason
    assert told in record.reason
    assert "nearest reachable point" in record.reason


def test_a_robot_that_was_carried_forgets_what_stood_around_it() -> None:
    robot = HeadlessMission(room_home(hidden=[(1.8, 1.8, 2.2, 2.2)]))
    robot.walk(3.5, 3.5)
    assert robot.mission.obstacles.standing(robot.simulator.time)
    known = Senses(100.0, Pose(3.5, 3.5))
    walk = Walk(
        robot.brain.walking.planner(robot.mission.context.occupancy),
        CONFIG.walk,
        robot.mission.obstacles,
        (0.5, 0.5),
        known,
    )
    walk.tick(Senses(100.05, Pose(3.5, 3.5), knowledge=Knowledge.SEARCHING), 0.5)
    walk.tick(Senses(100.10, Pose(3.4, 3.5)), 0.5)
    assert robot.mission.obstacles.standing(100.1), "it was here all the time"
    walk.tick(Senses(100.15, Pose(3.4, 3.5), knowledge=Knowledge.SEARCHING), 0.5)
    walk.tick(Senses(100.20, Pose(1.0, 3.5)), 0.5)
    assert robot.mission.obstacles.standing(100.2) == []


@pytest.mark.parametrize("max_speed", [0.2, 0.4])
def test_the_top_speed_reaches_corners_and_the_time_it_takes(max_speed: float) -> None:
    record = HeadlessMission(room_home(blocks=[WALL]), max_speed=max_speed).walk(*BEHIND)
    assert record.state is WalkState.ARRIVED
    # At first it knows its place but roughly.
    speeds = [step.cruise_speed for step in record.steps[20:]]
    assert max(speeds) == max_speed
    assert min(speeds) >= min(CONFIG.walk.corner_speed, max_speed)
    assert (min(speeds) < max_speed) == (max_speed > CONFIG.walk.corner_speed)
    expected = record.steps[0].distance_left / max_speed
    assert expected - 1.0 < record.duration < expected + 8.0
    way = np.hypot(*np.diff(record.poses[:, 1:3], axis=0).T)
    assert (way <= 1.02 * max_speed * np.diff(record.poses[:, 0]) + 1e-9).all()


def on_grid(low: float, high: float) -> st.SearchStrategy[float]:
    """Return lengths, m, that are whole cells."""
    return st.integers(round(low / 0.05), round(high / 0.05)).map(lambda cells: 0.05 * cells)


@st.composite
def boxes(draw: st.DrawFn) -> Block:
    """Return a box in the room, away from where the robot starts."""
    x, y = draw(on_grid(0.9, 4.5)), draw(on_grid(0.0, 3.6))
    return x, y, min(x + draw(on_grid(0.1, 1.0)), 5.0), min(y + draw(on_grid(0.1, 1.0)), 4.0)


def has_way(home: Home, goal: tuple[float, float]) -> bool:
    """Whether a body with room to spare gets there, by the truth."""
    truth = OccupancyMap(home.map.frame, np.where(home.solid, OCCUPIED, FREE).astype(np.int8))
    try:
        PathPlanner(truth, CONFIG.body.radius, SURELY, SURELY).plan((0.5, 0.5), goal)
    except NoPathError:
        return False
    return True


@settings(max_examples=examples(40))
@given(
    st.lists(boxes(), min_size=1, max_size=4),
    st.floats(0.3, 4.7),
    st.floats(0.3, 3.7),
    st.integers(0, 1000),
)
def test_among_unknown_boxes_it_touches_nothing_and_arrives_if_it_can(
    hidden: list[Block], x: float, y: float, seed: int
) -> None:
    home = room_home(hidden=hidden)
    record = HeadlessMission(home, seed=seed).walk(x, y)
    assert record.bumps == 0
    if has_way(home, (x, y)):
        assert record.state is WalkState.ARRIVED, record.reason
        assert math.dist(record.poses[-1, 1:3], (x, y)) < 0.05
    elif record.state is WalkState.FAILED:
        assert "map does not show" in record.reason
