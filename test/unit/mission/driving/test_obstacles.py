"""Obstacles felt or seen beside the map: how long they are remembered, which are in the way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.located import FURNISHED, LIDAR, Eye

from roomba.configuration.mission import DrivingConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Pose
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.senses import Senses
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.perception.things.layer import ThingLayer

CONFIG = RobotConfig()
DRIVING = DrivingConfig()
HERE = Pose(1.0, 1.0, 0.0)
BODY = CONFIG.body.radius


def obstacles() -> tuple[Obstacles, ThingLayer]:
    seen = ThingLayer(SurfaceField.of(FURNISHED.map))
    return Obstacles(seen, CONFIG.walk, CONFIG.body, DRIVING), seen


def see_a_thing(layer: ThingLayer, x: float = 2.0, y: float = 1.0) -> None:
    """Show it scans, from HERE, in which something stands at a point."""
    ranges = Eye(FURNISHED).scan(HERE)
    angles = np.arange(len(ranges)) * 2.0 * math.pi / len(ranges)
    away = math.dist((x, y), (HERE.x, HERE.y))
    off = np.abs(np.angle(np.exp(1j * (angles - math.atan2(y - HERE.y, x - HERE.x)))))
    ranges[off < 0.04] = away
    for _ in range(8):
        layer.see(ranges, LIDAR.arrays(), HERE)


def bumped(now: float = 0.0, pose: Pose = HERE) -> Senses:
    return Senses(now, pose, bumper_left=True, bumper_right=True)


def cliff(now: float = 0.0, pose: Pose = HERE) -> Senses:
    return Senses(now, pose, cliff_left=True)


def test_nothing_is_in_the_way_at_first() -> None:
    known, _ = obstacles()
    assert known.standing(0.0) == known.at_least(0.0) == []


def test_what_was_felt_stands_before_it() -> None:
    known, _ = obstacles()
    version = known.version
    known.feel(bumped())
    assert known.version != version
    felt = known.standing(0.0)
    assert felt
    for x, y, radius in felt:
        assert math.hypot(x - HERE.x, y - HERE.y) - radius == pytest.approx(BODY)
        assert x > HERE.x
    assert min(abs(y - HERE.y) for _, y, _ in felt) < 0.01


@pytest.mark.parametrize(("left", "right", "side"), [(True, False, 1.0), (False, True, -1.0)])
def test_what_was_felt_aside_stands_on_that_side(left: bool, right: bool, side: float) -> None:
    known, _ = obstacles()
    known.feel(Senses(0.0, HERE, bumper_left=left, bumper_right=right))
    assert all(side * (y - HERE.y) > 0.02 for _, y, _ in known.standing(0.0))


def test_what_was_felt_is_forgotten_after_a_while_and_an_edge_is_not() -> None:
    """Something is seen where it was felt, as a chair is that a person draws back."""
    known, layer = obstacles()
    see_a_thing(layer, HERE.x + BODY, HERE.y)
    known.feel(bumped())
    felt = len(known.felt(0.0))
    known.feel(cliff(0.0, Pose(3.0, 3.0, 0.0)))
    edges = len(known.felt(0.0)) - felt
    assert felt > 0
    assert edges > 0
    assert len(known.felt(DRIVING.felt_memory - 1.0)) == felt + edges
    assert len(known.felt(DRIVING.felt_memory + 1.0)) == edges
    assert len(known.felt(1e9)) == edges
    known.forget()
    assert known.felt(1e9) == known.edges()
    assert len(known.edges()) == edges


def test_where_the_floor_ends_is_felt_anew_in_each_errand_until_it_was_in_two() -> None:
    """A speck of dirt on a cliff sensor closes no doorway for ever, and stairs stay."""
    known, _ = obstacles()
    speck, stairs = Pose(3.0, 3.0, 0.0), Pose(1.0, 3.0, 0.0)
    known.feel(cliff(0.0, speck))
    known.feel(cliff(0.0, stairs))
    known.forget()
    felt = known.edges()
    assert felt
    version = known.version
    known.begin_errand()
    assert known.version != version
    assert known.edges() == known.standing(1.0) == []
    known.feel(cliff(2.0, Pose(1.03, 3.0, 0.0)))
    again = known.edges()
    assert 0 < len(again) < len(felt)
    assert known.standing(2.0) == known.at_least(2.0) == again
    for _ in range(2):
        known.begin_errand()
        assert known.edges() == again


def test_where_the_floor_ended_in_an_errand_before_moves_with_the_map() -> None:
    known, layer = obstacles()
    known.feel(cliff())
    known.begin_errand()
    moved = Pose(1.0, 2.0, 0.5)
    known.use(layer, moved)
    known.feel(cliff(1.0, moved.compose(HERE)))
    known.begin_errand()
    assert known.edges()


def test_what_was_felt_where_nothing_is_seen_is_remembered_for_longer() -> None:
    """Glass, mirrors, cables and sills stay; what may have gone can be forgotten without them."""
    known, layer = obstacles()
    known.feel(bumped())
    unseen = known.felt(0.0)
    assert unseen
    elsewhere = Pose(3.0, 3.0, 0.0)
    see_a_thing(layer, elsewhere.x + BODY, elsewhere.y)
    known.feel(bumped(0.0, elsewhere))
    assert len(known.felt(0.0)) > len(unseen)
    known.forget_what_goes()
    assert known.standing(0.0) == unseen
    assert known.felt(DRIVING.felt_memory + 1.0) == unseen
    assert known.felt(DRIVING.lasting_memory + 1.0) == []


def test_where_the_place_is_not_known_what_was_felt_may_be_a_wall_of_the_map() -> None:
    known, _ = obstacles()
    known.feel(replace(bumped(), knowledge=Knowledge.ROUGH))
    assert known.felt(DRIVING.felt_memory - 1.0)
    assert known.felt(DRIVING.felt_memory + 1.0) == []


def test_what_was_felt_where_nothing_is_seen_begins_where_the_body_touched_it() -> None:
    known, _ = obstacles()
    known.feel(bumped())
    least = known.at_least(0.0)
    assert least
    for x, y, radius in least:
        assert math.dist((x, y), (HERE.x, HERE.y)) == pytest.approx(BODY + radius)


def test_all_that_was_felt_and_seen_can_be_forgotten() -> None:
    known, layer = obstacles()
    see_a_thing(layer)
    known.feel(bumped())
    version = known.version
    known.forget()
    assert known.version != version
    assert known.standing(0.0) == []


def test_where_the_robot_stands_there_is_nothing() -> None:
    known, _ = obstacles()
    known.feel(bumped(0.0, Pose(3.0, 3.0, 0.0)))
    far = known.standing(0.0)
    known.feel(bumped())
    version = known.version
    known.forget_felt_at(Senses(1.0, Pose(1.05, 1.0, 2.0)))
    assert known.version != version
    assert known.standing(0.0) == far


def test_what_is_seen_stands_where_it_is() -> None:
    known, layer = obstacles()
    version = known.version
    see_a_thing(layer)
    assert known.version != version
    things = np.array(known.standing(0.0))
    assert np.hypot(things[:, 0] - 2.0, things[:, 1] - 1.0).max() < 0.15


def test_at_least_they_are_small_but_edges_are_as_large_as_ever() -> None:
    known, layer = obstacles()
    see_a_thing(layer)
    known.feel(bumped())
    small = known.at_least(0.0)
    assert len(small) == len(known.standing(0.0))
    assert max(radius for _, _, radius in small) < 0.5 * CONFIG.walk.bump_radius
    known.feel(cliff(0.0, Pose(3.0, 3.0, 0.0)))
    edges = [thing for thing in known.at_least(0.0) if thing not in small]
    assert edges
    assert all(thing in known.standing(0.0) for thing in edges)


def test_where_something_is_first_in_the_way_of_a_path_is_told() -> None:
    known, layer = obstacles()
    points = np.array([(0.6, 1.0), (1.6, 1.0), (2.6, 1.0)])
    tracker = PathTracker(points, CONFIG.tracking, CONFIG.body, 0.05)
    assert known.first_in_way(tracker.course, 0.0, 2.0) is None
    see_a_thing(layer)
    first = known.first_in_way(tracker.course, 0.0, 2.0)
    assert first is not None
    # The thing is 1.4 m along the path; the body touches it about its radius earlier.
    assert 1.4 - BODY - 0.15 < first < 1.4
    assert known.first_in_way(tracker.course, 0.0, first - 0.1) is None
    assert known.first_in_way(tracker.course, 1.4 + BODY + 0.15, 2.0) is None
    aside = PathTracker(points + np.array((0.0, 0.5)), CONFIG.tracking, CONFIG.body, 0.05)
    assert known.first_in_way(aside.course, 0.0, 2.0) is None


def test_what_is_felt_next_to_a_wall_counts_when_it_is_felt_again() -> None:
    known, _ = obstacles()
    # Before the wall x = 0: the first touch may be of that.
    beside_wall = Pose(0.17, 3.0, math.pi)
    known.feel(bumped(0.0, beside_wall))
    assert known.standing(0.0) == []
    known.feel(bumped(5.0, Pose(0.19, 3.01, math.pi)))
    felt = known.standing(5.0)
    assert felt
    assert all(math.hypot(x - 0.17, y - 3.0) < 0.3 for x, y, _ in felt)
    # It is no guess any more, and remembered for longer.
    assert known.standing(DRIVING.felt_memory + 10.0) == felt
    assert all(radius < 0.02 for _, _, radius in known.at_least(5.0))
    known.forget()
    assert known.standing(5.0) == []


def test_the_least_of_what_is_felt_again_begins_where_the_body_touched_it() -> None:
    known, _ = obstacles()

    def felt(now: float, pose: Pose) -> None:
        known.feel(replace(bumped(now, pose), knowledge=Knowledge.ROUGH))

    felt(0.0, Pose(3.0, 3.0, 0.0))
    once = known.at_least(0.0)
    # As it may have been late, a way may lead by the same place once more.
    assert all(math.dist((x, y), (3.0, 3.0)) > BODY + 0.04 for x, y, _ in once)
    again = Pose(3.01, 3.0, 0.0)
    felt(5.0, again)
    lasting = [thing for thing in known.at_least(5.0) if thing not in once]
    assert lasting
    for x, y, radius in lasting:
        assert math.dist((x, y), (again.x, again.y)) == pytest.approx(BODY + radius)


def test_a_wall_that_was_met_aside_leaves_the_way_ahead_open() -> None:
    known, _ = obstacles()
    # Along the wall x = 0, which is on its left.
    along = Pose(BODY + 0.012, 3.0, math.pi / 2.0)
    touched = Senses(0.0, along, bumper_left=True, knowledge=Knowledge.KNOWN)
    for _ in range(2):
        known.feel(touched)
        felt = known.standing(0.0)
        assert felt, "it keeps away from the wall by as much as its place may be off"
        assert all(x < 0.06 for x, _, _ in felt)
        assert known.low.all == ()
    # Another touch elsewhere changes nothing of that.
    known.feel(bumped(0.0, Pose(3.0, 3.0, 0.0)))
    assert set(felt) <= set(known.standing(0.0))
    known.forget()
    assert known.standing(0.0) == []


def test_what_is_felt_beside_a_wall_for_the_third_time_stands_ahead() -> None:
    known, _ = obstacles()
    along = Pose(BODY + 0.012, 3.0, math.pi / 2.0)
    for _ in range(3):
        known.feel(Senses(0.0, along, bumper_left=True, knowledge=Knowledge.KNOWN))
    assert any(y > 3.0 + BODY and x > 0.06 for x, y, _ in known.standing(0.0))
    assert len(known.low.all) == 1


def test_another_place_beside_a_wall_is_another_thing() -> None:
    known, _ = obstacles()
    known.feel(bumped(0.0, Pose(0.17, 3.0, math.pi)))
    known.feel(bumped(5.0, Pose(0.17, 2.8, math.pi)))
    assert known.standing(5.0) == []


def test_what_is_only_a_little_nearer_than_planned_is_not_in_the_way() -> None:
    known, layer = obstacles()
    see_a_thing(layer)
    things = known.standing(0.0)
    top = max(y + radius for _, y, radius in things)
    blocked = []
    for off in (0.005, 0.03):
        aside = top + BODY - off
        points = np.array([(1.0, aside), (3.0, aside)])
        tracker = PathTracker(points, CONFIG.tracking, CONFIG.body, 0.05)
        blocked.append(known.first_in_way(tracker.course, 0.0, 2.0) is not None)
    assert blocked == [False, True]


def test_what_is_felt_where_nothing_is_seen_is_counted_as_low() -> None:
    known, _ = obstacles()
    for _ in range(2):
        known.feel(bumped())
    (thing,) = known.low.all
    assert thing.times == 2
    assert (thing.x0, thing.y0) == pytest.approx((HERE.x + 0.93 * BODY, HERE.y), abs=0.02)
    known.forget()
    assert known.low.all == (thing,)


def test_what_the_lidar_sees_there_or_the_map_shows_is_not_low() -> None:
    known, seen = obstacles()
    see_a_thing(seen, HERE.x + BODY, HERE.y)
    known.feel(bumped())
    known.feel(cliff(pose=Pose(1.0, 2.0, 0.0)))
    known.feel(replace(bumped(pose=Pose(1.0, 2.0, 0.0)), knowledge=Knowledge.LOST))
    wall = Pose(FURNISHED.map.frame.origin_x + 0.05 + BODY, 1.0, math.pi)
    for _ in range(3):
        known.feel(bumped(pose=wall))
    assert known.low.all == ()


def test_zones_are_offered_of_what_was_felt_often() -> None:
    known, _ = obstacles()
    for _ in range(DRIVING.low_things.offered):
        assert known.offered_zones(Zones()) == ()
        known.feel(bumped())
    (offer,) = known.offered_zones(Zones())
    assert offer.times == DRIVING.low_things.offered
    zone = Zone("cable", ZoneKind.NO_GO, offer.corners)
    assert known.offered_zones(Zones((zone,))) == ()


def test_what_was_felt_stays_where_it_was_when_the_map_is_turned() -> None:
    known, seen = obstacles()
    moved = Pose(0.3, -0.2, 0.07)
    there = moved.compose(HERE)
    for senses in (bumped(), bumped(), cliff()):
        known.feel(senses)
    known.use(seen, moved)
    turned, _ = obstacles()
    for senses in (bumped(pose=there), bumped(pose=there), cliff(pose=there)):
        turned.feel(senses)
    assert np.array(known.standing(0.0)) == pytest.approx(np.array(turned.standing(0.0)))
    assert np.array(known.edges()) == pytest.approx(np.array(turned.edges()))
    low, asked = known.low.all[0], turned.low.all[0]
    assert (low.x0, low.y1) == pytest.approx((asked.x0, asked.y1))
    # What is felt there again is felt again.
    known.feel(bumped(pose=there))
    turned.feel(bumped(pose=there))
    assert np.array(known.standing(600.0)) == pytest.approx(np.array(turned.standing(600.0)))
