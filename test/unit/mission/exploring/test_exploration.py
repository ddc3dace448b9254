"""Which frontier comes next, which are given up, and when there is none left."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from fixtures.robots.missions import DOOR, TWO_ROOMS, WALL_X

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.planner import NoPathError, NoPathReason, PathPlanner

HERE = Pose(0.8, 1.0, 0.0)
ROBOT, CONFIG = RobotConfig(), MissionConfig().exploring
DOORWAY = (WALL_X + 0.05, 0.5 * (DOOR[0] + DOOR[1]))


def known_to(x: float, *patches: tuple[float, float]) -> OccupancyMap:
    """The two rooms as far as a place; nothing is known beyond, nor of patches of 0.3 m."""
    whole = TWO_ROOMS.map
    values = whole.values.copy()
    values[:, whole.frame.cell_of(x, 0.0)[1] :] = UNKNOWN
    for patch in patches:
        row, column = whole.frame.cell_of(*patch)
        values[row - 3 : row + 3, column - 3 : column + 3] = UNKNOWN
    return OccupancyMap(whole.frame, values)


def context_of(occupancy: OccupancyMap) -> PlanningContext:
    return PlanningContext(
        occupancy, TWO_ROOMS.station, ROBOT, MissionConfig(), DockingConfig(), is_growing=True
    )


HALL = known_to(DOORWAY[0] + 0.06)
HALL_SITE = context_of(HALL)
ALL_SITE = context_of(TWO_ROOMS.map)


def begun() -> Exploration:
    """On its way to the doorway."""
    exploration = Exploration(CONFIG)
    assert exploration.next_path(HERE, HALL_SITE, []) is not None
    return exploration


def at_goal(exploration: Exploration, aside: float = 0.0) -> Pose:
    assert exploration.goal is not None
    x, y = exploration.goal.viewpoint
    return Pose(x - aside, y, 0.0)


def test_it_goes_to_where_it_sees_into_the_next_room() -> None:
    exploration = Exploration(CONFIG)
    path = exploration.next_path(HERE, HALL_SITE, [])
    assert path is not None
    assert exploration.goal is not None
    assert math.dist(exploration.goal.middle, DOORWAY) < 0.2
    assert path[0] == pytest.approx((HERE.x, HERE.y))
    assert path[-1] == pytest.approx(exploration.goal.viewpoint)
    assert HALL_SITE.paths.is_free(path)
    assert exploration.unseen == []


def test_it_looks_from_where_it_has_room_and_goes_there_with_care() -> None:
    """Beside a thing whose round side the map has two centimetres behind where it stands."""
    exploration, things = Exploration(CONFIG), [(1.2, 1.5, 0.12)]
    path = exploration.next_path(HERE, HALL_SITE, things)
    assert path is not None
    assert exploration.goal is not None
    fit = FitMap.build(HALL, ROBOT.body.radius, CONFIG.clearance, things)
    assert fit.fits_at(*exploration.goal.viewpoint)
    assert fit.room_along(*path[-2:].tolist()) >= ROBOT.body.radius + CONFIG.careful_clearance


def test_where_all_is_known_there_is_no_next() -> None:
    exploration = Exploration(CONFIG)
    assert exploration.next_path(HERE, ALL_SITE, []) is None
    assert exploration.goal is None
    assert exploration.unseen == []


def test_walled_in_there_is_no_next() -> None:
    around = [(HERE.x + 0.2 * x, HERE.y + 0.2 * y, 0.1) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    assert Exploration(CONFIG).next_path(HERE, HALL_SITE, around) is None
    beside = [(DOORWAY[0] - 0.1, y, 0.06) for y in np.arange(0.7, 1.8, 0.1).tolist()]
    # Something stands in the doorway: what is to be seen from this side is looked at from there.
    exploration = Exploration(CONFIG)
    path = exploration.next_path(HERE, HALL_SITE, beside)
    assert path is None or path[:, 0].max() < DOORWAY[0] - 0.1 - 0.2


def test_when_the_map_shows_what_is_there_it_wants_another() -> None:
    exploration = begun()
    assert not exploration.wants_another(HALL)
    assert exploration.wants_another(TWO_ROOMS.map)
    # Some of it is left.
    assert not exploration.wants_another(known_to(DOORWAY[0] + 0.15))
    assert not Exploration(CONFIG).wants_another(TWO_ROOMS.map)


def test_what_was_looked_at_and_is_still_unknown_is_given_up() -> None:
    exploration = begun()
    goal = exploration.goal
    assert goal is not None
    there = at_goal(exploration)
    exploration.next_path(there, HALL_SITE, [])
    assert exploration.unseen == [goal.middle]
    # The doorway is wide: it is looked at from elsewhere too, but not for ever.
    for _ in range(5):
        if exploration.goal is None:
            break
        assert math.dist(exploration.goal.middle, goal.middle) >= 0.3
        exploration.next_path(at_goal(exploration), HALL_SITE, [])
    assert exploration.goal is None
    assert len(exploration.unseen) == len(set(exploration.unseen)) <= 4


def test_what_was_looked_at_from_afar_is_looked_at_from_nearer_when_it_can() -> None:
    """What is black, or met at a flat angle, is seen from near alone."""
    across = [(DOORWAY[0] - 0.6, y, 0.06) for y in np.arange(0.0, 2.5, 0.1).tolist()]
    exploration, here, looks = Exploration(CONFIG), HERE, 0
    while exploration.next_path(here, HALL_SITE, across) is not None:
        here, looks = at_goal(exploration), looks + 1
        assert looks < 20
    assert looks > 0
    given_up = exploration.times_given_up
    for _ in range(20):
        if exploration.next_path(here, HALL_SITE, []) is None:
            break
        assert exploration.goal is not None
        assert exploration.goal.viewpoint[0] > DOORWAY[0] - 0.6
        here = at_goal(exploration)
    else:
        pytest.fail("it looks for ever")
    assert exploration.times_given_up > given_up


def test_what_it_cannot_come_nearer_to_is_given_up_for_good() -> None:
    """It was looked at from afar; on the way to a nearer place no way leads on."""
    across = [(DOORWAY[0] - 0.6, y, 0.06) for y in np.arange(0.0, 2.5, 0.1).tolist()]
    exploration, here = Exploration(CONFIG), HERE
    while exploration.next_path(here, HALL_SITE, across) is not None:
        here = at_goal(exploration)
    again = Exploration.of(json.loads(json.dumps(exploration.values())), CONFIG)
    for looks in (exploration, again):
        tries = 0
        while looks.next_path(here, HALL_SITE, []) is not None:
            looks.cut_off()
            tries += 1
            assert tries < 20
        assert tries > 0


def test_what_a_newer_map_shows_is_not_told_as_unseen() -> None:
    exploration = begun()
    assert exploration.goal is not None
    edge = exploration.goal.middle
    for point in (edge, (HERE.x, HERE.y)):
        exploration.give_up(point)
    assert exploration.still_unseen(HALL) == (edge,)
    assert exploration.still_unseen(TWO_ROOMS.map) == ()


def test_what_it_gave_up_and_where_it_goes_turn_with_the_map() -> None:
    exploration = begun()
    exploration.give_up((1.0, 2.0), 0.5)
    goal = exploration.goal
    assert goal is not None
    turn = Pose(0.1, -0.2, 0.05)
    exploration.move(turn)

    def there(point: tuple[float, float]) -> tuple[float, float]:
        place = turn.compose(Pose(*point))
        return place.x, place.y

    assert exploration.unseen == [there((1.0, 2.0))]
    (given_up,) = exploration.given_up.values()
    assert (given_up.place, given_up.seen_from) == (there((1.0, 2.0)), 0.5)
    assert exploration.goal is not None
    assert exploration.goal.middle == there(goal.middle)
    assert exploration.goal.viewpoint == there(goal.viewpoint)
    assert exploration.goal.way == goal.way


def test_what_was_not_yet_reached_is_not() -> None:
    exploration = begun()
    assert exploration.next_path(at_goal(exploration, 0.3), HALL_SITE, []) is not None
    assert exploration.unseen == []
    # Nor is one of which nothing is left.
    exploration = begun()
    assert exploration.next_path(at_goal(exploration), ALL_SITE, []) is None
    assert exploration.unseen == []


def test_touching_something_by_its_viewpoint_it_is_as_near_as_it_gets() -> None:
    exploration = begun()
    exploration.note_touch(at_goal(exploration, 0.3))
    assert not exploration.is_as_near_as_it_gets
    exploration.note_touch(at_goal(exploration, 0.1))
    # That stays while it backs off.
    exploration.note_touch(at_goal(exploration, 0.3))
    assert exploration.is_as_near_as_it_gets
    exploration.cut_off()
    assert not exploration.is_as_near_as_it_gets


@pytest.mark.parametrize("is_stuck", [False, True])
def test_cut_off_it_gives_up_where_it_was_going(is_stuck: bool) -> None:
    exploration = begun()
    goal = exploration.goal
    assert goal is not None
    exploration.cut_off(is_stuck=is_stuck)
    assert exploration.goal is None
    assert exploration.unseen == [goal.middle]
    assert exploration.times_stuck == int(is_stuck)
    # On its way to nothing there is nothing to give up.
    exploration.cut_off()
    assert exploration.unseen == [goal.middle]
    exploration.next_path(HERE, HALL_SITE, [])
    assert exploration.goal is None or math.dist(exploration.goal.middle, goal.middle) >= 0.3


def test_one_to_which_no_way_leads_is_given_up_for_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    context = context_of(known_to(DOORWAY[0] + 0.06, (1.0, 2.0)))
    near = Exploration(CONFIG)
    near.next_path(Pose(0.8, 1.4, 0.0), context, [])
    assert near.goal is not None
    shut, plan = near.goal, PathPlanner.plan

    def refuse(planner: PathPlanner, start: Any, goal: Any, obstacles: Any = ()) -> Any:
        if math.dist(goal, shut.viewpoint) < 0.01:
            raise NoPathError(goal, NoPathReason.GOAL_UNREACHABLE, None)
        return plan(planner, start, goal, obstacles)

    monkeypatch.setattr(PathPlanner, "plan", refuse)
    exploration = Exploration(CONFIG)
    path = exploration.next_path(Pose(0.8, 1.4, 0.0), context, [])
    assert path is not None
    assert exploration.unseen == [shut.middle]
    assert exploration.goal is not None
    assert exploration.goal.middle != shut.middle
    assert path[-1] == pytest.approx(exploration.goal.viewpoint)


def test_how_much_is_known_is_told() -> None:
    area = (TWO_ROOMS.map.values == FREE).sum() * 0.05**2
    assert ALL_SITE.occupancy.free_area == pytest.approx(area)
    assert HALL_SITE.occupancy.free_area == pytest.approx(2.0 * 2.4 + 0.1 * 0.8, abs=0.01)


def test_it_comes_back_from_plain_values() -> None:
    exploration = begun()
    exploration.cut_off()
    back = Exploration.of(json.loads(json.dumps(exploration.values())), CONFIG)
    assert back.unseen == exploration.unseen
    assert back.goal is None
    paths = [each.next_path(HERE, HALL_SITE, []) for each in (back, exploration)]
    assert back.goal == exploration.goal
    assert (paths[0] is None) == (paths[1] is None)


@pytest.mark.parametrize(
    "junk", [[[1.0]], [["a", 2.0]], 5, [[1.0, 2.0, 3.0, 0.0, 5.0]], [[1.0, 2.0, "a"]], [None]]
)
def test_junk_is_refused(junk: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        Exploration.of(junk, CONFIG)


def gap_of(low: float, high: float) -> PlanningContext:
    """The two rooms as far as the doorway, which is a gap from ``low`` to ``high`` in y, m."""
    values = HALL.values.copy()
    frame = HALL.frame
    (first, column), (last, after) = frame.cell_of(WALL_X, low), frame.cell_of(WALL_X + 0.1, high)
    values[:first, column:after] = OCCUPIED
    values[last:, column:after] = OCCUPIED
    values[first:last, column:after] = FREE
    return context_of(OccupancyMap(frame, values))


@pytest.mark.parametrize("width", [0.35, 0.40])
def test_a_gap_that_a_clean_passes_is_looked_through(width: float) -> None:
    context = gap_of(1.0, 1.0 + width + 1e-9)
    exploration = Exploration(CONFIG)
    points = exploration.next_path(HERE, context, [])
    assert points is not None
    assert math.dist(points[-1], (WALL_X + 0.05, 1.0 + 0.5 * width)) < 1.3


def test_a_gap_between_the_cells_of_the_map_is_passed_where_a_clean_passes_it() -> None:
    """From no middle of a cell both sides are far enough; on the fine grid of a clean they are."""
    context, here = context_of(known_to(WALL_X + 1.4)), (HERE.x, HERE.y)
    middle, half = 1.2, ROBOT.body.radius + 0.0125
    away = np.arange(half + 0.05, 0.5, 0.06)
    fence = [(WALL_X + 0.05, middle + side, 0.05) for side in (*away.tolist(), *(-away).tolist())]
    beyond = context.known.frame.cell_of(WALL_X + 0.5, middle)
    assert not context.paths.reachable(here, fence)[beyond]
    assert context.narrow_floor(here, fence).places[beyond]
    points = Exploration(CONFIG).next_path(HERE, context, fence)
    assert points is not None
    assert points[-1][0] > WALL_X + 0.1
    floor = context.floor.with_obstacles(fence)
    for x, y in points[1:].tolist():
        assert floor.fits[floor.frame.cell_of(x, y)]
    # Where it cleans meanwhile it first cleans what is near.
    assert Exploration(CONFIG).next_path(HERE, context, fence, farthest=10.0) is None


def test_what_vanishes_and_comes_back_has_an_end() -> None:
    """As frontiers do that glass and mirrors show: seen and gone in turns."""
    exploration = Exploration(CONFIG)
    looks = 0
    while exploration.next_path(HERE, HALL_SITE, []) is not None:
        looks += 1
        assert looks < 10 * CONFIG.most_returns
        given_up = len(exploration.unseen)
        assert exploration.next_path(HERE, ALL_SITE, []) is None
        if looks <= CONFIG.most_returns:
            assert given_up == len(exploration.unseen) == 0
    assert looks > CONFIG.most_returns
    assert min(math.dist(place, DOORWAY) for place in exploration.unseen) < 0.2


def test_a_frontier_that_it_never_comes_to_is_given_up() -> None:
    exploration = begun()
    assert exploration.goal is not None
    middle = exploration.goal.middle
    allowed = CONFIG.patience + 2.0 * exploration.goal.way / CONFIG.speed
    assert not exploration.is_too_long(100.0)
    assert not exploration.is_too_long(150.0)
    # Chosen anew on a map that has grown it is the same frontier.
    assert exploration.next_path(HERE, HALL_SITE, []) is not None
    assert not exploration.is_too_long(150.0)
    assert not exploration.is_too_long(100.0 + allowed - 1.0)
    assert exploration.is_too_long(100.0 + allowed + 1.0)
    exploration.cut_off()
    assert exploration.unseen == [middle]
    assert not exploration.is_too_long(1e6)


def test_time_between_two_ways_to_a_frontier_is_no_time_on_its_way() -> None:
    """It was paused, or charged."""
    exploration = begun()
    assert exploration.goal is not None
    allowed = CONFIG.patience + 2.0 * exploration.goal.way / CONFIG.speed
    assert not exploration.is_too_long(100.0)
    assert not exploration.is_too_long(110.0)
    assert exploration.next_path(HERE, HALL_SITE, []) is not None
    assert not exploration.is_too_long(5000.0)
    # A clock that is set back brings nothing back.
    assert not exploration.is_too_long(4000.0)
    assert not exploration.is_too_long(4000.0 + allowed - 10.0 - 1.0)
    assert exploration.is_too_long(4000.0 + allowed - 10.0 + 1.0)
