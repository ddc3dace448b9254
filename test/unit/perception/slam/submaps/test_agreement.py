"""Far loops need a second one that agrees; corridors that look alike are told apart."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.robots.located import LIDAR, Eye
from fixtures.robots.mapped import Floats, row

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.submaps.agreement import is_backed, is_far
from roomba.perception.slam.submaps.pose_graph import Link, composed, relative_to

BACKING = MappingConfig().backing
SURE = 1e4 * np.eye(3)
CHAIN = np.column_stack((np.arange(12) * 3.0, np.zeros(12), np.zeros(12)))
"""Where twelve submaps lie, one each 3 m."""


def moved_by(child: int, x: float, y: float = 0.0, turn: float = 0.0, parent: int = 0) -> Link:
    """A link that says that a submap lies elsewhere."""
    there = CHAIN[child] + (x, y, turn)
    return Link(parent, child, relative_to(CHAIN[parent][None], there[None])[0], SURE)


@pytest.mark.parametrize(("x", "far"), [(0.9, False), (-1.9, False), (2.1, True), (-4.0, True)])
def test_a_link_is_far_that_moves_its_child_by_more_than_two_metres(x: float, far: bool) -> None:
    assert is_far(moved_by(9, x), CHAIN, BACKING) == far


def test_it_is_backed_by_another_child_that_was_found_where_it_must_lie() -> None:
    link = moved_by(9, 4.0, 1.0)
    assert is_backed(link, [moved_by(8, 4.1, 1.1, parent=1)], CHAIN, BACKING)
    assert is_backed(link, [moved_by(11, 4.0, 1.0, parent=2)], CHAIN, BACKING)
    # Turned around the ninth one, the seventh lies 6 m behind it on the turned line.
    turned = moved_by(9, 4.0, 1.0, 0.5)
    behind = composed(
        composed(CHAIN[0][None], turned.relative[None]),
        relative_to(CHAIN[9][None], CHAIN[7][None]),
    )[0]
    assert is_backed(turned, [Link(0, 7, behind, SURE)], CHAIN, BACKING)


@pytest.mark.parametrize(
    "other",
    [
        moved_by(9, 4.0, 1.0, parent=1),
        moved_by(5, 4.0, 1.0),
        moved_by(8, 4.6, 1.0),
        moved_by(8, 4.0, 1.0, 0.1),
    ],
    ids=["of the same child", "of one far away", "elsewhere", "turned"],
)
def test_a_link_is_not_backed_by_links_that_disagree(other: Link) -> None:
    link = moved_by(9, 4.0, 1.0)
    assert not is_backed(link, [link, other], CHAIN, BACKING)


LONG, WIDE, WALL = 12.0, 1.6, 0.4
"""m; of three corridors that look alike, and of the walls between them."""
PITCH = WIDE + WALL


def corridors() -> tuple[Block, ...]:
    """The walls between them, open at one end in turn, and the same cupboards in each."""
    walls = (
        (0.0, WIDE, LONG - 1.6, PITCH),
        (1.6, PITCH + WIDE, LONG, 2 * PITCH),
    )
    cupboards = [
        (x, number * PITCH, x + 0.5, number * PITCH + 0.3)
        for number in range(3)
        for x in (2.5, 5.0, 7.5)
    ]
    return (*walls, *cupboards)


HOME = room_home(LONG, 2 * PITCH + WIDE, corridors())
SPEED, TURNING, PERIOD = 0.5, 1.0, 0.2
"""m/s, rad/s, s."""


def way(points: list[tuple[float, float]]) -> list[Pose]:
    """Where a robot is at each scan that drives from point to point, turning on the spot."""
    heading, poses = math.atan2(points[1][1] - points[0][1], points[1][0] - points[0][0]), []
    for (x, y), (to_x, to_y) in pairwise(points):
        to = math.atan2(to_y - y, to_x - x)
        turn, length = wrap_angle(to - heading), math.hypot(to_x - x, to_y - y)
        for step in range(round(abs(turn) / (TURNING * PERIOD))):
            poses.append(Pose(x, y, heading + math.copysign(TURNING * PERIOD, turn) * step))
        heading = to
        for step in range(round(length / (SPEED * PERIOD))):
            share = SPEED * PERIOD * step / length
            poses.append(Pose(x + share * (to_x - x), y + share * (to_y - y), heading))
    return poses


def test_corridors_that_look_alike_are_not_taken_for_each_other() -> None:
    """There, and back on the same way: all loops are true, and they are found."""
    first, second, third = (number * PITCH + 1.0 for number in range(3))
    left, right = 0.8, LONG - 0.8
    there = [(left, first), (right, first), (right, second), (left, second), (left, third)]
    poses = way([*there, (right, third), *there[::-1]])
    config, eye, random = RobotConfig(), Eye(HOME), np.random.default_rng(4)
    mapper = Mapper(MappingConfig(), config.localization, config.gyro, poses[0])
    odometry, before = Pose(), poses[0]
    kept: dict[int, Pose] = {}
    for number, here in enumerate(poses):
        step = before.inverse().compose(here)
        before = here
        odometry = odometry.compose(Pose(1.05 * step.x, 1.05 * step.y, 1.05 * step.theta))
        mapper.move(PERIOD * number, odometry)
        mapper.see(PERIOD * number, eye.scan(here, random), LIDAR)
        kept.setdefault(len(mapper.trajectory) - 1, here)
    state = mapper.state()
    assert state is not None
    firsts = np.cumsum([0, *(len(each.keyframes) for each in state.submaps)])
    truth: list[Floats] = [row(kept[int(first)]) for first in firsts[:-1]]
    loops = [link for link in state.links if link.may_be_wrong]
    for link in loops:
        expected = relative_to(truth[link.parent][None], truth[link.child][None])[0]
        assert math.hypot(*(link.relative - expected)[:2]) < 0.15
    back = [link for link in loops if link.child - link.parent > 8]
    assert len(back) > 5
    mapper.finish()
    end = poses[-1]
    assert mapper.at_scan.distance_to(end.x, end.y) < 0.05
