"""Tracks of what moves: in order, repeatable, without overlaps, and continuous."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.files.home_layer import DAY
from roomba.geometry import Pose, wrap_angle
from roomba.world.home.home import Box, Move, MovingKind, MovingThing, Script
from roomba.world.home.moving import PRESENT, TIME, Track, pose_at, tracks_of

HERE = Pose(1.0, 2.0, 0.5)
ROUNDING = 1e-6
"""s; sums of times up to a day are exact to this."""

poses = st.builds(
    Pose, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-math.pi, math.pi, exclude_min=True)
)
seeds = st.integers(0, 2**32 - 1)


@st.composite
def scripts(draw: st.DrawFn, least_takes: float = 0.0, always_present: bool = False) -> Script:
    """Return a script of a few moves, once or in a period that may be filled to the brim."""
    time = 0.0
    moves = []
    for _ in range(draw(st.integers(1, 4))):
        begins = time + draw(st.floats(0.0, 600.0))
        takes = draw(st.floats(least_takes, 60.0))
        moves.append(Move(begins, takes, draw(poses), always_present or draw(st.booleans())))
        time = moves[-1].ends
    period = draw(st.just(0.0) | st.floats(max(time, 600.0), 20_000.0) | st.just(max(time, 10.0)))
    return Script(tuple(moves), period, draw(st.floats(0.0, 2000.0)))


def thing(script: Script, is_present: bool = True) -> MovingThing:
    box = Box(0.0, 0.0, 0.0, 0.4, 0.4, 0.0, 0.8, "wood")
    return MovingThing("thing", MovingKind.FURNITURE, (box,), HERE, is_present, script)


def track_of(script: Script, seed: int = 0, is_present: bool = True) -> Track:
    (track,) = tracks_of([thing(script, is_present)], np.random.default_rng(seed))
    return track


def shut_between(start: float, end: float, period: float, jitter: float) -> Script:
    moves = (Move(start, 0.0, HERE, True), Move(end, 0.0, HERE, False))
    return Script(moves, period, jitter)


def test_a_piece_slides_stays_and_slides_back() -> None:
    there = Pose(3.0, 2.0, -0.5)
    track = track_of(Script((Move(600.0, 4.0, there), Move(900.0, 2.0, HERE))))
    assert track.dtype == np.float64
    assert track.tolist() == [
        [0.0, 1.0, 2.0, 0.5, 1.0],
        [600.0, 1.0, 2.0, 0.5, 1.0],
        [604.0, 3.0, 2.0, -0.5, 1.0],
        [900.0, 3.0, 2.0, -0.5, 1.0],
        [902.0, 1.0, 2.0, 0.5, 1.0],
    ]
    assert pose_at(track, 599.0) == (1.0, 2.0, 0.5, True)
    assert pose_at(track, 601.0) == pytest.approx((1.5, 2.0, 0.25, True))
    assert pose_at(track, 700.0) == (3.0, 2.0, -0.5, True)
    assert pose_at(track, 1e9) == (1.0, 2.0, 0.5, True)


def test_moves_without_a_rest_between_share_a_row() -> None:
    corner, end = Pose(2.0, 2.0, 0.5), Pose(2.0, 3.0, 0.5)
    moves = (Move(5.0, 1.0, corner), Move(6.0, 1.0, end), Move(7.0, 0.0, end, False))
    track = track_of(Script(moves))
    assert track[:, TIME].tolist() == [0.0, 5.0, 6.0, 7.0, 7.0]
    assert track[:, PRESENT].tolist() == [1.0, 1.0, 1.0, 1.0, 0.0]


def test_the_next_period_begins_where_the_last_one_ended() -> None:
    there = Pose(3.0, 2.0, 0.5)
    track = track_of(Script((Move(10.0, 2.0, there),), period=43200.0))
    assert pose_at(track, 11.0)[0] == pytest.approx(2.0)
    assert pose_at(track, 43211.0)[0] == pytest.approx(3.0)


def test_a_leaf_is_there_while_its_door_is_shut() -> None:
    track = track_of(shut_between(600.0, 900.0, 3600.0, 0.0), is_present=False)
    assert len(track) == 1 + 2 * 24
    for time, is_shut in ((0, False), (599, False), (600, True), (899, True), (900, False)):
        for hour in (0, 1, 23):
            assert pose_at(track, 3600.0 * hour + time)[3] is is_shut, (hour, time)


def test_what_never_moves_has_one_row() -> None:
    assert track_of(Script(()), is_present=False).tolist() == [[0.0, 1.0, 2.0, 0.5, 0.0]]


def test_what_would_end_after_the_day_does_not_begin() -> None:
    track = track_of(shut_between(0.0, 40_000.0, 50_000.0, 0.0), is_present=False)
    assert track[:, TIME].tolist() == [0.0, 0.0, 40_000.0]
    assert len(track_of(shut_between(0.0, DAY + 1.0, 0.0, 0.0), is_present=False)) == 1


@given(scripts(), seeds, st.booleans())
def test_tracks_begin_at_zero_are_in_order_and_end_with_the_day(
    script: Script, seed: int, is_present: bool
) -> None:
    track = track_of(script, seed, is_present)
    assert track.shape == (len(track), 5)
    assert track[0].tolist() == [0.0, HERE.x, HERE.y, HERE.theta, float(is_present)]
    assert (np.diff(track[:, TIME]) >= 0.0).all()
    assert track[-1, TIME] <= DAY + ROUNDING
    assert set(track[:, PRESENT]) <= {0.0, 1.0}
    last = script.moves[-1]
    assert track[-1, 1:].tolist() == [
        last.pose.x,
        last.pose.y,
        last.pose.theta,
        float(last.is_present),
    ]


@given(
    st.floats(0.0, 1000.0),
    st.floats(1.0, 3000.0),
    st.floats(0.0, 3000.0),
    st.floats(0.0, 20_000.0),
    seeds,
)
def test_occurrences_are_put_off_a_little_and_never_overlap(
    start: float, lasts: float, rest: float, jitter: float, seed: int
) -> None:
    period = start + lasts + rest
    script = shut_between(start, start + lasts, period, jitter)
    track = track_of(script, seed, is_present=False)
    begins, ends = track[1::2, TIME], track[2::2, TIME]
    assert len(begins) == len(ends) >= (DAY - period) // period
    assert ends - begins == pytest.approx(lasts, abs=ROUNDING)
    put_off = begins - start - period * np.arange(len(begins))
    assert (put_off >= -ROUNDING).all()
    assert (put_off <= jitter + ROUNDING).all()
    assert (begins[1:] >= ends[:-1]).all()


def test_jitter_uses_the_room_that_it_has() -> None:
    track = track_of(shut_between(0.0, 10.0, 600.0, 100.0), seed=3, is_present=False)
    put_off = track[1::2, TIME] - 600.0 * np.arange(144)
    assert put_off.min() < 10.0
    assert put_off.max() > 90.0
    assert put_off.mean() == pytest.approx(50.0, abs=10.0)


@given(st.lists(scripts(), min_size=1, max_size=3), seeds)
def test_same_seed_same_tracks(several: list[Script], seed: int) -> None:
    things = [thing(script) for script in several]
    once = tracks_of(things, np.random.default_rng(seed))
    again = tracks_of(things, np.random.default_rng(seed))
    assert len(once) == len(things)
    for one, other in zip(once, again, strict=True):
        assert np.array_equal(one, other)


@given(seeds, seeds)
def test_other_seed_other_track(one: int, other: int) -> None:
    script = shut_between(600.0, 900.0, 3600.0, 300.0)
    assert (one == other) == np.array_equal(track_of(script, one), track_of(script, other))


def test_things_do_not_share_their_luck() -> None:
    script = shut_between(600.0, 900.0, 3600.0, 300.0)
    one, other = tracks_of([thing(script), thing(script)], np.random.default_rng(0))
    assert not np.array_equal(one, other)


@given(poses, poses, st.floats(0.0, 1.0), st.booleans())
def test_between_rows_it_goes_evenly_and_turns_the_shorter_way(
    start: Pose, end: Pose, share: float, is_present: bool
) -> None:
    rows = [
        [100.0, start.x, start.y, start.theta, float(is_present)],
        [104.0, end.x, end.y, end.theta, float(not is_present)],
    ]
    x, y, theta, present = pose_at(np.array(rows), 100.0 + 4.0 * share)
    assert x == pytest.approx(start.x + share * (end.x - start.x), abs=1e-9)
    assert y == pytest.approx(start.y + share * (end.y - start.y), abs=1e-9)
    assert -math.pi < theta <= math.pi
    turn = abs(wrap_angle(end.theta - start.theta))
    assert turn <= math.pi
    assert abs(wrap_angle(theta - start.theta)) == pytest.approx(share * turn, abs=1e-6)
    assert abs(wrap_angle(end.theta - theta)) == pytest.approx((1.0 - share) * turn, abs=1e-6)
    assert present is (is_present if share < 1.0 else not is_present)


def test_of_rows_at_one_time_the_last_counts() -> None:
    track = np.array([[0.0, 1, 1, 0, 1], [5.0, 2, 1, 0, 1], [5.0, 3, 1, 0, 0], [6.0, 4, 1, 0, 1]])
    assert pose_at(track, 5.0) == (3.0, 1.0, 0.0, False)
    assert pose_at(track, 4.5)[0] == pytest.approx(1.9)
    assert pose_at(track, -1.0) == (1.0, 1.0, 0.0, True)


@settings(max_examples=examples(50))
@given(scripts(least_takes=1.0, always_present=True), seeds, st.floats(0.0, 1.0))
def test_what_is_present_jumps_nowhere(script: Script, seed: int, phase: float) -> None:
    track = track_of(script, seed)
    stations = [HERE, *(move.pose for move in script.moves), script.moves[0].pose]
    takes = [*(move.takes for move in script.moves), script.moves[0].takes]
    fastest = max(
        before.distance_to(after.x, after.y) / seconds
        for before, after, seconds in zip(stations, stations[1:], takes, strict=False)
    )
    step = 1e-3
    for time in track[:40, TIME]:
        near = float(time) - step * phase
        x, y, _, present = pose_at(track, near)
        next_x, next_y, _, _ = pose_at(track, near + step)
        assert present
        assert math.hypot(next_x - x, next_y - y) <= fastest * step + 1e-6
