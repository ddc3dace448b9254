"""What a clean cannot reach: shut doors, stairs, things, and being shut in."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.driven_cleans import FENCE, HERE, ahead, cleaning, context, drive, finish
from fixtures.robots.missions import DEN, TWO_ROOMS, WALL_X

from roomba.geometry import Pose, RoundObstacle
from roomba.mission.cleaning.result import MissReason
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.planning.path.planner import NoPathError
from roomba.planning.path.polyline import Path


def test_what_is_behind_a_shut_door_is_told_and_looked_for_once_more() -> None:
    clean = cleaning(place=context(TWO_ROOMS))
    finish(clean, FENCE)
    behind = clean.missed(FENCE, True)[0]
    assert behind.reason is MissReason.SHUT
    assert behind.room == DEN
    assert behind.area > 2.0
    assert clean.wants_another_look([])
    # Opened by now, it is cleaned, too.
    assert finish(clean, []) >= 1
    assert clean.ledger.coverage.fraction > 0.99
    assert not clean.wants_another_look([])


def test_a_door_that_stays_shut_is_looked_for_only_once() -> None:
    clean = cleaning(place=context(TWO_ROOMS))
    finish(clean, FENCE)
    assert clean.wants_another_look([])
    finish(clean, FENCE)
    clean.cut_off()
    assert not clean.wants_another_look([])


def test_with_all_reached_nothing_is_looked_for_again() -> None:
    clean = cleaning()
    assert not clean.wants_another_look([])
    finish(clean, [])
    assert not clean.wants_another_look([])


def test_behind_stairs_it_is_not_looked_for_again() -> None:
    clean = cleaning(place=context(TWO_ROOMS))
    finish(clean, FENCE)
    assert not clean.wants_another_look(FENCE)


def test_cut_off_what_is_left_is_looked_for_again() -> None:
    clean = cleaning()
    for _ in range(40):
        if clean.next_path(HERE, []) is None:
            break
        clean.cut_off()
    assert clean.ledger.stage is None
    assert clean.wants_another_look([])
    assert finish(clean, []) >= 1
    assert clean.ledger.coverage.fraction > 0.99


def test_below_a_thing_it_is_told_as_missed_for_that_thing() -> None:
    thing = (1.2, 0.6, 0.1)
    clean = cleaning()
    finish(clean, [thing])
    (missed,) = clean.missed([thing], True)
    assert missed.reason is MissReason.THING
    assert np.hypot(missed.x - 1.2, missed.y - 0.6) < 0.12
    assert missed.area < 0.15


LARGE: list[RoundObstacle] = [
    (1.2 + 0.35 * float(np.cos(a)), 0.6 + 0.35 * float(np.sin(a)), 0.02)
    for a in np.arange(0.0, 6.3, 0.1)
]
"""A large round thing, as the lidar sees it."""


def test_below_a_large_thing_it_is_not_looked_for_again() -> None:
    clean = cleaning()
    finish(clean, LARGE, Pose(0.6, 1.2, 0.0))
    missed = clean.missed(LARGE, True)[0]
    assert missed.area > 0.5
    assert missed.reason is MissReason.THING
    assert not clean.wants_another_look([])


def test_a_path_on_which_something_stands_is_planned_anew_now_and_then() -> None:
    clean = cleaning()
    points = clean.next_path(HERE, [])
    assert points is not None
    here = drive(clean, points, 0.4)
    assert not clean.plans_anew(100.0, ahead(3.0)), "so near to the end that is not worth it"
    assert clean.plans_anew(100.0, ahead(20.0))
    missed = clean.ledger.left
    again = clean.next_path(here, [(1.2, 0.6, 0.1)])
    assert again is not None
    assert again[0] == pytest.approx((here.x, here.y))
    length = [float(np.hypot(*np.diff(way, axis=0).T).sum()) for way in (points, again)]
    assert length[1] < 0.9 * length[0]
    drive(clean, again)
    assert clean.ledger.left < 0.1 * missed
    assert not clean.plans_anew(105.0, ahead(20.0)), "it was planned only just"
    assert clean.plans_anew(200.0, ahead(20.0))


@pytest.mark.parametrize("share", [0.3, 0.4])
def test_planned_anew_it_takes_no_swaths_more_for_slivers(share: float) -> None:
    lengths = []
    for is_told in (True, False):
        clean = cleaning()
        points = clean.next_path(HERE, [])
        assert points is not None
        here = drive(clean, points, share)
        rest = points[round(share * len(points)) - 1 :]
        assert clean.plans_anew(100.0, rest if is_told else ahead(20.0))
        again = clean.next_path(here, [])
        assert again is not None
        lengths.append(Path(again).length / Path(rest).length)
    # The plan leaves some cells on purpose; these it would go back for.
    assert lengths[0] < 1.01
    assert lengths[1] > 1.1


def test_a_small_patch_far_away_is_worth_no_round() -> None:
    for size, is_worth in ((20, False), (60, True)):
        clean = cleaning()
        points = clean.next_path(HERE, [])
        assert points is not None
        drive(clean, points)
        frame = clean.ledger.coverage.frame
        row, column = frame.cell_of(2.4, 1.9)
        patch = np.zeros(frame.shape, np.bool_)
        patch[row - 5 : row + 5, column - size // 2 : column + size // 2] = True
        clean.ledger.coverage.cells[patch] &= np.uint8(~SWEPT & 0xFF)
        clean.ledger.coverage.count_again()
        assert (clean.next_path(HERE, []) is not None) is is_worth


def test_planned_anew_at_the_end_it_comes_to_an_end() -> None:
    clean = cleaning()
    here, now = HERE, 0.0
    for _ in range(60):
        points = clean.next_path(here, [])
        if points is None:
            break
        here = drive(clean, points)
        now += 100.0
        clean.plans_anew(now, ahead(20.0))
    assert clean.ledger.stage is None
    assert clean.ledger.coverage.fraction > 0.995


def test_with_no_way_home_it_cleans_where_it_is() -> None:
    clean = cleaning(place=context(TWO_ROOMS))
    # The door shut behind it.
    here = Pose(2.8, 1.2, 0.0)
    points = clean.next_path(here, FENCE)
    assert points is not None
    assert points[:, 0].min() > WALL_X
    drive(clean, points)
    den = clean.ledger.coverage.wanted & context(TWO_ROOMS).in_room(DEN)
    assert np.count_nonzero(clean.ledger.clean & den) > 0.9 * np.count_nonzero(den)


def test_shut_in_it_says_so_a_few_times_before_it_gives_up() -> None:
    clean = cleaning()
    cage = [
        (2.5 + 0.3 * float(np.cos(a)), 0.5 + 0.3 * float(np.sin(a)), 0.05)
        for a in np.arange(0.0, 6.2, 0.2)
    ]
    refused = 0
    while refused < 50:
        try:
            assert clean.next_path(Pose(2.5, 0.5, 0.0), cage) is None
            break
        except NoPathError:
            refused += 1
    assert 2 <= refused < 50
    # Let out by then, it goes on; what was left out is looked for again.
    assert clean.wants_another_look([])
    assert finish(clean, []) >= 1
    assert clean.ledger.coverage.fraction > 0.99


def test_let_out_again_it_goes_on_where_it_was() -> None:
    clean = cleaning(place=context(TWO_ROOMS))
    points = clean.next_path(HERE, [])
    assert points is not None
    drive(clean, points, 0.3)
    assert clean.plans_anew(100.0, ahead(20.0))
    # In the den, which is clean, when the door shuts behind it.
    den = clean.ledger.coverage.wanted & context(TWO_ROOMS).in_room(DEN)
    clean.ledger.coverage.cells[den] |= np.uint8(SWEPT)
    clean.ledger.coverage.count_again()
    here = Pose(2.8, 1.2, 0.0)
    for _ in range(3):
        with pytest.raises(NoPathError):
            clean.next_path(here, FENCE)
    assert finish(clean, [], here) >= 1
    assert clean.ledger.coverage.fraction > 0.99
