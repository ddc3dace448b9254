"""Paths on the newest map, with and without a walk; no graph is needed for that."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest
import rospy
from fixtures.robots.missions import HOME, TABLE
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlanRequest

from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.things import ThingConfig
from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.mission.inputs.senses import Senses
from roomba.robot.lookout import Lookout
from roomba_ros.runtime.parameters import LiveSeedParameters
from roomba_ros.senses.senses import HeardSenses
from roomba_ros.walking.plan_service import PlanService

HERE = Pose(0.5, 0.5, 0.0)
LIMITS = SimpleNamespace(
    min_cordinate=0.0, max_cordinate=2.5, allows=lambda x, y: min(x, y) >= 0.0 and max(x, y) <= 2.5
)


class WrittenSenses:
    """Knows a pose, and sees nothing."""

    def __init__(self) -> None:
        self.pose: Pose | None = HERE

    def show(self, lookout: Lookout) -> None:
        pass


@pytest.fixture
def senses() -> WrittenSenses:
    return WrittenSenses()


@pytest.fixture
def plans(senses: WrittenSenses, monkeypatch: pytest.MonkeyPatch) -> PlanService:
    module = "roomba_ros.walking.plan_service"
    monkeypatch.setattr(f"{module}.read_thing_config", ThingConfig)
    monkeypatch.setattr(f"{module}.read_mission_config", lambda _: MissionConfig())
    monkeypatch.setattr("rospy.get_time", lambda: 7.0)
    parameters = cast(LiveSeedParameters, SimpleNamespace(values=LIMITS))
    return PlanService(RobotConfig(), parameters, cast(HeardSenses, senses))


def knowing(plans: PlanService) -> PlanService:
    plans._on_map(HOME.map)
    plans.use_newer_map()
    return plans


def place(x: float, y: float) -> PoseStamped:
    message = PoseStamped()
    message.header.frame_id = "map"
    message.pose.position.x, message.pose.position.y = x, y
    message.pose.orientation.w = 1.0
    return message


def asked(plans: PlanService, goal: PoseStamped, start: PoseStamped | None = None) -> Any:
    """Return the ends of the path that is answered, m."""
    request = GetPlanRequest(goal=goal, start=start or PoseStamped())
    path = plans._on_make_plan(request).plan
    assert path.header.stamp.to_sec() == 7.0
    ends = [path.poses[0].pose.position, path.poses[-1].pose.position]
    return [(round(end.x, 6), round(end.y, 6)) for end in ends]


def test_a_map_is_used_when_it_is_taken(plans: PlanService) -> None:
    plans._on_map(HOME.map)
    assert not plans.knows_map
    plans.use_newer_map()
    assert plans.knows_map
    before = plans._planner
    plans.use_newer_map()
    assert plans._planner is before, "no newer map came"


def test_a_walk_is_planned_on_the_map(plans: PlanService) -> None:
    with pytest.raises(RoombaError, match="does not know its map yet"):
        plans.walk_to((2.5, 2.0), Senses(7.0, HERE))
    walk = knowing(plans).walk_to((2.5, 2.0), Senses(7.0, HERE))
    assert tuple(walk.path.points[0]) == (HERE.x, HERE.y)
    assert tuple(walk.path.points[-1]) == (2.5, 2.0)
    in_table = ((TABLE[0] + TABLE[2]) / 2.0, (TABLE[1] + TABLE[3]) / 2.0)
    with pytest.raises(RoombaError):
        plans.walk_to(in_table, Senses(7.0, HERE))


def test_a_walk_begins_with_no_edge_that_one_before_it_felt(plans: PlanService) -> None:
    knowing(plans)
    plans._obstacles.feel(Senses(7.0, Pose(1.5, 1.5, 0.0), cliff_left=True))
    plans.walk_to((2.5, 2.0), Senses(7.0, HERE))
    assert plans._obstacles.edges() == []


def test_a_path_is_answered_from_here_or_from_where_it_was_asked_for(plans: PlanService) -> None:
    knowing(plans)
    assert asked(plans, place(2.5, 2.0)) == [(0.5, 0.5), (2.5, 2.0)]
    assert asked(plans, place(2.5, 2.0), place(1.0, 2.0)) == [(1.0, 2.0), (2.5, 2.0)]


@pytest.mark.parametrize(
    ("goal", "reason"),
    [
        (place(2.6, 1.0), r"\(2.60, 1.00\) is outside the limits: .* from 0 to 2.5 m"),
        (place(float("nan"), 1.0), "finite"),
        (
            place((TABLE[0] + TABLE[2]) / 2.0, (TABLE[1] + TABLE[3]) / 2.0),
            "the body does not fit there",
        ),
    ],
)
def test_a_path_that_there_is_not_is_refused_with_the_reason(
    plans: PlanService, goal: PoseStamped, reason: str
) -> None:
    with pytest.raises(rospy.ServiceException, match=reason):
        asked(knowing(plans), goal)


def test_without_a_map_or_a_pose_no_path_is_answered(
    plans: PlanService, senses: WrittenSenses
) -> None:
    with pytest.raises(rospy.ServiceException, match="does not know its map and position"):
        asked(plans, place(2.5, 2.0))
    senses.pose = None
    with pytest.raises(rospy.ServiceException, match="does not know its map and position"):
        asked(knowing(plans), place(2.5, 2.0))


def test_places_are_allowed_by_the_limits_in_force(plans: PlanService) -> None:
    plans.require_allowed(0.0, 2.5)
    with pytest.raises(RoombaError, match="outside the limits"):
        plans.require_allowed(-0.1, 2.5)
    with pytest.raises(RoombaError, match="finite numbers"):
        plans.require_allowed(float("inf"), 0.0)


def test_it_looks_while_no_path_is_planned(
    plans: PlanService, senses: WrittenSenses, monkeypatch: pytest.MonkeyPatch
) -> None:
    held = []
    monkeypatch.setattr(senses, "show", lambda _: held.append(plans.lock.locked()))
    plans.look()
    assert held == [True]
