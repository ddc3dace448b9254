"""Moving things: they keep to their tracks, and wait for robots."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, EXACT, block_that_moves, drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.body import BodyConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.world.home.home import Home, Move, MovingThing
from roomba.world.home.moving import Track, pose_at
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

RADIUS = BodyConfig().radius
ASIDE = Pose(0.5, 0.5, 0.0)


def track_in(world: Simulator, number: int) -> Track:
    saved = world.save()
    thing = saved["things"][number]
    return np.asarray(saved["tracks"][thing["row"] : thing["last_row"] + 1], np.float64)


def assert_is_at(
    found: list[float], expected: tuple[float, float, float, bool], tolerance: float = 1e-9
) -> None:
    assert found[:2] == pytest.approx(expected[:2], abs=tolerance)
    assert abs(wrap_angle(found[2] - expected[2])) < tolerance
    assert found[3] == expected[3]


poses = st.builds(Pose, st.floats(2.0, 4.5), st.floats(1.5, 3.5), st.floats(-3.1, 3.1))


@settings(max_examples=examples(40))
@given(
    st.lists(st.tuples(st.floats(0.0, 3.0), st.floats(0.0, 3.0), poses, st.booleans()), max_size=5),
    st.booleans(),
    st.sampled_from((0.01, 0.025, 0.1, 0.7)),
)
def test_a_thing_is_where_its_track_says_while_no_robot_is_in_its_way(
    parts: list[tuple[float, float, Pose, bool]], is_present: bool, dt: float
) -> None:
    moves, time = [], 0.0
    for rest, takes, pose, there in parts:
        moves.append(Move(time + rest, takes, pose, there))
        time = moves[-1].ends
    thing = block_that_moves(*moves, pose=Pose(3.0, 2.0, 0.4), is_present=is_present)
    world = Simulator(room_home(moving=[thing, thing]), start=ASIDE)
    tracks = [track_in(world, 0), track_in(world, 1)]
    for _ in range(int((time + 2.0) / dt)):
        world.step(Twist(), dt)
        for found, track in zip(world.things.tolist(), tracks, strict=True):
            assert_is_at(found, pose_at(track, world.time))


@pytest.mark.parametrize("seed", [0, 7])
def test_the_familys_things_keep_to_their_day(seed: int) -> None:
    home = load_home("family", HOMES)
    world = Simulator(home, EXACT, seed=seed)
    tracks = [track_in(world, number) for number in range(len(home.moving))]
    moved = np.zeros(len(tracks))
    for _ in range(1500):
        before = world.things
        world.advance(Twist(), 0.5, 8)
        moved += (world.things != before).any(axis=1)
        for found, track in zip(world.things.tolist(), tracks, strict=True):
            assert_is_at(found, pose_at(track, world.time))
    assert (moved > 0).all()


def slider(speed: float, until: float = 4.5) -> MovingThing:
    """A block 0.4 m wide that slides from x = 1 along y = 2."""
    takes = (until - 1.0) / speed
    return block_that_moves(Move(0.0, takes, Pose(until, 2.0, 0.0)), pose=Pose(1.0, 2.0, 0.0))


@pytest.mark.parametrize("speed", [0.02, 0.3, 2.0])
def test_a_thing_waits_for_a_robot_and_goes_on_later(speed: float) -> None:
    world = Simulator(room_home(moving=[slider(speed)]), start=Pose(3.0, 2.0, math.pi / 2.0))
    track = track_in(world, 0)
    drive(world, 0.0, 0.0, 3.5 / speed)
    x = world.things[0, 0]
    assert 3.0 - RADIUS - 0.2 - 2e-3 - speed * DT <= x <= 3.0 - RADIUS - 0.2 - 2e-3
    waited = drive(world, 0.0, 0.0, 3.0)
    assert world.things[0, 0] == x
    assert world.gap > 0.0
    assert not waited.bumper.pressed
    drive(world, 0.5, 0.0, 2.0)
    assert world.things[0, 0] > x
    thing = world.save()["things"][0]
    assert thing["time"] < world.time - 3.0
    assert_is_at(world.things[0].tolist(), pose_at(track, float(thing["time"])))
    drive(world, 0.0, 0.0, 3.5 / speed)
    assert_is_at(world.things[0].tolist(), (4.5, 2.0, 0.0, True))


def test_a_thing_goes_away_however_slowly_from_a_robot_that_leans_on_it() -> None:
    thing = block_that_moves(Move(5.0, 100.0, Pose(4.5, 2.0, 0.0)), pose=Pose(2.5, 2.0, 0.0))
    world = Simulator(room_home(moving=[thing]), start=Pose(1.5, 2.0, 0.0))
    assert drive(world, 0.3, 0.0, 4.9).bumper.pressed
    drive(world, 0.0, 0.0, 50.1)
    assert_is_at(world.things[0].tolist(), (3.5, 2.0, 0.0, True))


@pytest.mark.parametrize("turn", [0.0, 0.3, -1.2])
def test_a_robot_bumps_into_a_moving_thing(turn: float) -> None:
    thing = block_that_moves(pose=Pose(3.0, 2.0, turn), size=(1.0, 0.3))
    world = Simulator(room_home(moving=[thing]), start=Pose(1.5, 2.0, 0.0))
    seen = drive(world, 0.5, 0.0, 4.0)
    assert seen.bumper.pressed
    assert world.numbers["hits"] == 1.0
    assert world.gap == pytest.approx(0.0, abs=1e-6)
    gone = block_that_moves(pose=Pose(3.0, 2.0, turn), size=(1.0, 0.3), is_present=False)
    world = Simulator(room_home(moving=[gone]), start=Pose(1.5, 2.0, 0.0))
    assert drive(world, 0.5, 0.0, 4.0).pose.x > 3.0


def home_with_door() -> Home:
    """Two rooms; the door between them, at x = 2.5, closes at 5 s and opens at 20 s."""
    walls = ((2.4, 0.0, 2.6, 1.5), (2.4, 2.5, 2.6, 4.0))
    here = Pose(2.5, 2.0, math.pi / 2.0)
    moves = (Move(5.0, 0.0, here, True), Move(20.0, 0.0, here, False))
    leaf = block_that_moves(*moves, pose=here, size=(1.0, 0.05), is_present=False)
    return room_home(blocks=walls, moving=[leaf])


def test_a_door_that_closes_stops_the_robot_until_it_opens() -> None:
    world = Simulator(home_with_door(), start=Pose(1.0, 2.0, 0.0))
    drive(world, 0.0, 0.0, 5.5)
    stopped = drive(world, 0.3, 0.0, 10.0)
    assert stopped.bumper.pressed
    assert stopped.pose.x == pytest.approx(2.475 - RADIUS, abs=1e-6)
    assert drive(world, 0.3, 0.0, 8.0).pose.x > 2.6


def test_a_door_does_not_close_on_a_robot_in_it() -> None:
    world = Simulator(home_with_door(), start=Pose(2.5, 2.0, 0.0))
    drive(world, 0.0, 0.0, 8.0)
    assert world.things[0, 3] == 0.0
    drive(world, 0.3, 0.0, 3.0)
    assert world.things[0, 3] == 1.0
    # It was held up for as long as the robot stood there, and opens so much later.
    drive(world, 0.0, 0.0, 10.0)
    assert world.things[0, 3] == 1.0
    drive(world, 0.0, 0.0, 10.0)
    assert world.things[0, 3] == 0.0
