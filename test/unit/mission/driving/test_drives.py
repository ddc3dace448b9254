"""One path after another: out of zones, home, and what the robot remembers on the way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.missions import HOME

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.perception.things.layer import ThingLayer
from roomba.planning.path.planner import NoPathError

ROBOT, CONFIG = RobotConfig(), MissionConfig()
ZONE = Zone("rug", ZoneKind.NO_GO, ((2.3, 0.2), (2.9, 0.2), (2.9, 0.8), (2.3, 0.8)))
HERE = Pose(1.0, 0.6, 0.0)
AWAY = Senses(0.0, HERE)
IN_ZONE = replace(AWAY, pose=Pose(2.6, 0.5, 0.0))


def context(*zones: Zone) -> PlanningContext:
    return PlanningContext(
        HOME.map, HOME.station, ROBOT, CONFIG, DockingConfig(), zones=Zones(zones)
    )


class Ringed(Obstacles):
    """The robot at HERE is shut in."""

    def standing(self, now: float) -> list[RoundObstacle]:
        angles = np.arange(0.0, 2.0 * math.pi, 0.2).tolist()
        return [(HERE.x + 0.3 * math.cos(a), HERE.y + 0.3 * math.sin(a), 0.05) for a in angles]

    def at_least(self, now: float) -> list[RoundObstacle]:
        return self.standing(now)


def drives(*zones: Zone, kind: type[Obstacles] = Obstacles) -> Drives:
    things = ThingLayer(SurfaceField.of(HOME.map))
    obstacles = kind(things, ROBOT.walk, ROBOT.body, CONFIG.driving)
    return Drives(context(*zones), ROBOT, CONFIG.driving, obstacles)


def test_in_a_zone_it_begins_to_leave_it() -> None:
    inside = drives(ZONE)
    assert inside.begin_to_leave_zone(IN_ZONE)
    assert inside.driver is not None
    end = inside.driver.tracker.rest[-1]
    assert not inside.context.is_in_zone((float(end[0]), float(end[1])))
    outside = drives(ZONE)
    assert not outside.begin_to_leave_zone(AWAY)
    assert outside.driver is None


def test_another_context_counts_from_then_on_and_the_path_is_driven_on() -> None:
    at_work = drives()
    at_work.begin(np.array([[1.0, 0.6], [1.5, 0.6]]), AWAY)
    driver = at_work.driver
    at_work.use_context(context(ZONE))
    assert at_work.driver is driver
    assert at_work.begin_to_leave_zone(IN_ZONE)


def test_it_is_as_far_home_as_the_way_is_long() -> None:
    here = drives()
    way = here.way_home(AWAY)
    length = float(np.hypot(*np.diff(way, axis=0).T).sum())
    assert here.distance_home(AWAY) == pytest.approx(length)
    assert length >= HERE.distance_to(here.context.staging.x, here.context.staging.y)


def test_shut_in_it_is_as_far_home_as_the_map_is_wide() -> None:
    shut_in = drives(kind=Ringed)
    with pytest.raises(NoPathError):
        shut_in.way_home(AWAY)
    assert shut_in.way_out(AWAY) is None
    assert shut_in.distance_home(AWAY) == pytest.approx(3.0 + 2.5 + 0.4)


def test_ticks_that_were_the_trackers_alone_leave_a_trail() -> None:
    at_work = drives()
    at_work.caught_up(AWAY, np.array([[1.0, 0.6]]))
    assert at_work.trail.back_and_on(lambda place: np.array([place]))[0] is None
    at_work.begin(np.array([[1.0, 0.6], [2.4, 0.6]]), AWAY)
    assert at_work.driver is not None
    places = np.column_stack((np.linspace(1.0, 1.59, 60), np.full(60, 0.6)))
    senses = replace(AWAY, now=3.0, pose=Pose(1.6, 0.6, 0.0))
    at_work.caught_up(senses, places)
    back, way = at_work.trail.back_and_on(lambda place: np.array([place]))
    assert back is not None
    assert way > 0.1
    at_work.obstacles.feel(replace(AWAY, bumper_left=True))
    at_work.forget_place()
    assert at_work.trail.back_and_on(lambda place: np.array([place]))[0] is None
    assert at_work.obstacles.standing(0.0) == []
