"""Cleaning while the map is being made: what is known is cleaned, and the rest is looked for."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from fixtures.missions.exploring import (
    AWAY,
    CONFIG,
    DOCKED,
    HALL,
    HERE,
    ROBOT,
    WHOLE,
    Rig,
    known_to,
)
from fixtures.missions.told_mission import TICK
from fixtures.robots.missions import TWO_ROOMS, WALL_X

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.geometry import Pose, Twist
from roomba.grid import OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome, CleanResult
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.phases.machine import Event
from roomba.mission.ticks import MissionStep
from roomba.perception.swept.coverage_bits import SWEPT, TRIED
from roomba.vocabulary import CleanMode, Phase

CORNER = CleanRequest(CleanMode.ZONES, zones=((0.6, 0.2, 1.4, 0.9),))


def cleaning(request: CleanRequest | None = None, known: OccupancyMap = HALL) -> Rig:
    rig = Rig(known=known)
    rig.mission.clean(request or CleanRequest(), rig.senses)
    rig.tick(4)
    return rig


def swept(rig: Rig) -> None:
    """All that is wanted is clean, and the path over it driven to its end."""
    assert rig.mission.cleaning is not None
    coverage = rig.mission.cleaning.ledger.coverage
    coverage.cells[coverage.wanted] |= np.uint8(SWEPT)
    coverage.count_again()
    rig.mission.driver = None


def result(rig: Rig) -> CleanResult:
    """Let it be home on its way there; return how its clean ended."""
    assert rig.phase is Phase.RETURNING
    rig.tick(2, pose=TWO_ROOMS.station, battery=DOCKED.battery)
    assert rig.phase is Phase.DOCKED
    found = rig.mission.take_result()
    assert found is not None
    assert rig.mission.take_exploration() is None
    return found


def give_up_the_door(exploration: Exploration) -> None:
    for y in np.arange(0.7, 1.8, 0.1).tolist():
        exploration.give_up((WALL_X + 0.1, y))


def test_it_looks_first_at_what_is_near_and_sweeps_on_the_way() -> None:
    rig = cleaning()
    assert rig.phase is Phase.CLEANING
    assert rig.mission.exploration is not None
    assert rig.mission.exploration.is_under_way
    assert rig.mission.sweeps
    assert not rig.mission.wants_map(HALL)
    assert rig.mission.wants_map(WHOLE)


def test_with_nothing_near_to_look_at_it_cleans_what_is_known() -> None:
    rig = cleaning()
    assert rig.mission.exploration is not None
    rig.mission.exploration.cut_off()
    give_up_the_door(rig.mission.exploration)
    rig.mission.driver = None
    rig.tick(4)
    assert not rig.mission.exploration.is_under_way
    assert rig.mission.driver is not None
    # All of the hall.
    assert rig.mission.driver.left > 8.0
    assert not rig.mission.wants_map(WHOLE)


def test_while_the_map_grows_it_keeps_farther_from_walls_and_leaves_the_edges() -> None:
    rig = cleaning()
    mission = rig.mission
    assert mission.exploration is not None
    mission.exploration.cut_off()
    give_up_the_door(mission.exploration)
    mission.driver = None
    rig.tick(4)
    assert mission.driver is not None
    assert mission.cleaning is not None
    points = mission.driver.tracker.course.points
    frame, solid = HALL.frame, np.argwhere(HALL.solid)
    x, y = frame.centres(solid[:, 0], solid[:, 1])
    half = 0.5 * frame.resolution
    gaps = [
        np.hypot(np.maximum(abs(x - at[0]) - half, 0), np.maximum(abs(y - at[1]) - half, 0)).min()
        for at in points
    ]
    assert min(gaps) > ROBOT.body.radius + CONFIG.exploring.cleaning_clearance - 0.001
    coverage, width = mission.cleaning.ledger.coverage, ROBOT.brush.width
    tried = (coverage.cells & TRIED) > 0
    rows, columns = np.nonzero(tried)
    inside_x, inside_y = coverage.frame.centres(rows, columns)
    assert tried.any()
    off_walls = [
        np.hypot(x - at[0], y - at[1]).min() for at in zip(inside_x, inside_y, strict=True)
    ]
    assert min(off_walls) > width


def test_with_all_seen_and_clean_it_waits_for_the_whole_map_and_ends_on_it() -> None:
    rig = cleaning(known=WHOLE)
    swept(rig)
    steps = [rig.tick() for _ in range(6)]
    assert steps[-1] == MissionStep(wants_whole_map=True)
    assert "waits for the map" in rig.mission.message
    assert rig.phase is Phase.CLEANING
    rig.grow(WHOLE, is_growing=False)
    assert rig.mission.exploration is None
    rig.tick(4)
    end = result(rig)
    assert (end.outcome, end.fraction) == (CleanOutcome.COMPLETED, 1.0)


def test_what_the_whole_map_shows_besides_is_cleaned_as_well() -> None:
    rig = cleaning(known=known_to(WALL_X + 0.6))
    swept(rig)
    rig.grow(WHOLE, is_growing=False)
    rig.tick(4)
    assert rig.phase is Phase.CLEANING
    assert rig.mission.driver is not None
    assert rig.mission.driver.tracker.rest[:, 0].max() > WALL_X + 0.9
    assert rig.tick().twist != Twist()


def test_a_part_is_cleaned_without_looking_for_more() -> None:
    rig = cleaning(CORNER)
    assert rig.mission.exploration is None
    assert rig.mission.driver is not None
    swept(rig)
    rig.tick(3)
    assert result(rig).outcome is CleanOutcome.COMPLETED


def test_a_part_of_which_nothing_is_known_is_refused() -> None:
    rig = Rig()
    there = CleanRequest(CleanMode.ZONES, zones=((2.6, 0.4, 3.2, 1.0),))
    with pytest.raises(CleanRefusedError, match="outside of the map"):
        rig.mission.clean(there, rig.senses)
    assert rig.phase is Phase.IDLE


def test_where_next_to_nothing_is_known_yet_it_looks_around_first() -> None:
    rig = cleaning(known=known_to(HERE.x + 0.1))
    assert rig.mission.cleaning is not None
    assert rig.phase is Phase.CLEANING
    assert rig.mission.driver is not None


@pytest.mark.parametrize("later", [HALL, WHOLE])
def test_killed_it_goes_on_with_what_the_map_shows_by_then(later: OccupancyMap) -> None:
    rig = cleaning()
    rig.tick(pose=Pose(1.2, 1.0, 0.0))
    values = json.loads(json.dumps(rig.mission.checkpoint(rig.senses)))
    assert rig.mission.cleaning is not None
    clean = rig.mission.cleaning.ledger.clean_area
    assert clean > 0.02
    again = Rig(AWAY, later)
    again.mission.restore(values, again.senses)
    assert again.mission.cleaning is not None
    assert again.mission.exploration is not None
    assert again.mission.cleaning.ledger.clean_area == pytest.approx(clean)
    again.tick(5)
    assert again.phase is Phase.CLEANING


def test_a_look_that_is_cut_short_is_no_round_that_was_broken_off() -> None:
    rig = cleaning()
    assert rig.mission.cleaning is not None
    coverage = rig.mission.cleaning.ledger.coverage
    coverage.cells[coverage.wanted] |= np.uint8(TRIED)
    rig.grow(known_to(WALL_X + 0.3))
    rig.grow(WHOLE)
    assert rig.mission.driver is None
    context = rig.mission.context
    coverage = rig.mission.cleaning.ledger.coverage
    columns = np.nonzero(coverage.wanted & (coverage.cells & TRIED == 0))[1]
    # The hall was planned once.
    assert context.frame.centre_of(0, int(columns.min()))[0] > WALL_X - 0.3


def test_shut_in_it_waits_and_does_not_take_the_map_for_whole() -> None:
    rig = cleaning(known=WHOLE)
    swept(rig)
    around = [
        (HERE.x + 0.3 * np.cos(turn), HERE.y + 0.3 * np.sin(turn), 0.05)
        for turn in np.arange(0.0, 2.0 * np.pi, 0.2).tolist()
    ]
    rig.mission.obstacles.standing = lambda now: around  # type: ignore[method-assign]
    rig.mission.obstacles.at_least = lambda now: around  # type: ignore[method-assign]
    steps = [rig.tick() for _ in range(20)]
    # It turns to see more, but here it is held.
    assert steps[-1].twist == Twist(0.0, CONFIG.exploring.seeing_speed)
    assert rig.mission.message == ""
    longest = 3.0 * math.tau / CONFIG.exploring.seeing_speed
    steps += [rig.tick() for _ in range(round(longest / TICK) + 20)]
    assert not any(step.wants_whole_map for step in steps)
    assert "no way leads out of where it is; it waits" in rig.mission.message
    assert rig.phase is Phase.CLEANING


def test_a_map_that_is_not_finished_is_an_error_that_says_what_to_do() -> None:
    rig = cleaning(known=WHOLE)
    swept(rig)
    rig.tick(6)
    assert "waits for the map to be finished" in rig.mission.message
    rig.tick(round(121.0 / TICK))
    assert rig.phase is Phase.ERROR
    assert "map/finish" in rig.mission.message
    rig.command(Event.RESUME)
    assert rig.tick(3).wants_whole_map


def test_another_clean_waits_for_the_whole_map_as_long_as_the_first_one() -> None:
    rig = cleaning(known=WHOLE)
    swept(rig)
    rig.tick(round(100.0 / TICK))
    rig.mission.clean(CleanRequest(), rig.senses)
    rig.tick(4)
    assert rig.mission.driver is not None
    swept(rig)
    rig.tick(round(100.0 / TICK))
    assert "waits for the map to be finished" in rig.mission.message
    rig.tick(round(21.0 / TICK))
    assert rig.phase is Phase.ERROR


def test_dirt_that_is_met_on_a_newer_map_is_cleaned_once_more() -> None:
    rig = cleaning(known=WHOLE)
    rig.grow(WHOLE, is_growing=False)
    assert rig.mission.cleaning is not None
    swept(rig)
    dirt = rig.mission.dirt
    for x in np.arange(0.5, 1.9, 0.2).tolist():
        for y in (0.7, 0.9, 1.1, 1.3):
            dirt.note(x, y, 200.0 if x < 0.8 and y > 0.8 else 2.0, 0.2)
    rig.tick(3)
    assert rig.phase is Phase.CLEANING
    assert rig.mission.driver is not None
    assert rig.mission.cleaning.ledger.coverage.fraction < 1.0


def test_dirt_beside_the_path_is_cleaned_once_more_before_it_goes_on() -> None:
    rig = cleaning(known=WHOLE)
    rig.grow(WHOLE, is_growing=False)
    rig.tick(3)
    driver, clean = rig.mission.driver, rig.mission.cleaning
    assert driver is not None
    assert clean is not None
    end = driver.tracker.course.points[-1]
    swept(rig)
    rig.mission.driver = driver
    dirt, (x, y) = rig.mission.dirt, (rig.senses.pose.x, rig.senses.pose.y)
    for row in np.arange(0.1, 2.4, 0.2).tolist():
        for column in np.arange(0.1, 2.9, 0.2).tolist():
            is_dirty = abs(column - x) < 0.3 and abs(row - y) < 0.3
            dirt.note(column, row, 4000.0 if is_dirty else 20.0, 0.2)
    # In another pass it looks at once.
    clean.dirty.begin_pass()
    rig.tick(2)
    assert rig.mission.driver is not None
    assert rig.mission.driver is not driver
    points = rig.mission.driver.tracker.course.points
    assert points[-1] == pytest.approx(end)
    assert clean.ledger.coverage.fraction < 1.0


def test_killed_while_the_map_became_whole_it_looks_for_no_more() -> None:
    rig = cleaning()
    values = json.loads(json.dumps(rig.mission.checkpoint(rig.senses)))
    again = Rig(AWAY, WHOLE, is_growing=False)
    again.mission.restore(values, again.senses)
    assert again.mission.cleaning is not None
    assert again.mission.exploration is None
    again.tick(5)
    assert again.phase is Phase.CLEANING
