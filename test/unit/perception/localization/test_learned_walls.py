"""Walls that a map draws elsewhere in its cells: learned from many beams, or found by one scan."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.corridors import coarse_and_thick
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, TWO_ROOMS, Eye

from roomba.geometry import Pose
from roomba.perception.localization.belief.belief import Rows, unknown_belief
from roomba.perception.localization.learned_walls import LearnedWalls
from roomba.perception.matching.surface_field import SurfaceField

CELL = TWO_ROOMS.map.frame.resolution
HERE = Pose(1.4, 2.6, 0.7)


def belief_with(off: float, beams: float) -> Rows:
    """Return a belief in which so many beams ended so far, m, off the walls."""
    belief = unknown_belief()
    belief["wall_offset"] = off * beams, beams
    return belief


def raised(off: float, beams: float) -> float:
    """Return by how much the surfaces are moved, m, as learned from such beams."""
    field, belief = SurfaceField.of(TWO_ROOMS.map), unknown_belief()
    before = field.values.copy()
    walls = LearnedWalls(field, belief)
    belief["wall_offset"] = off * beams, beams
    walls.learn()
    moved = np.unique(np.round(field.values - before, 4))
    assert len(moved) == 1
    return float(moved[0])


@pytest.mark.parametrize(
    ("off", "beams", "moved"),
    [
        (-0.5 * CELL, 200.0, 0.5 * CELL),
        (0.3 * CELL, 200.0, -0.3 * CELL),
        (-0.1 * CELL, 200.0, 0.0),
        (-0.5 * CELL, 90.0, 0.0),
        (-5.0 * CELL, 200.0, 2.0 * CELL),
        (5.0 * CELL, 200.0, -0.5 * CELL),
    ],
    ids=["further in", "further out", "too little", "too few", "most", "most outwards"],
)
def test_walls_move_by_what_many_beams_say(off: float, beams: float, moved: float) -> None:
    assert raised(off, beams) == pytest.approx(moved, abs=2e-4)


def test_what_was_learned_counts_from_where_the_walls_are_by_then() -> None:
    field, belief = SurfaceField.of(TWO_ROOMS.map), unknown_belief()
    before = field.values.copy()
    walls = LearnedWalls(field, belief)
    for _ in range(2):
        belief["wall_offset"] = -0.5 * CELL * 200.0, 200.0
        walls.learn()
        assert belief[0]["wall_offset"][0] == 0.0
    assert np.allclose(field.values - before, CELL, atol=1e-5)


def test_of_another_map_nothing_is_kept() -> None:
    belief = belief_with(-0.5 * CELL, 200.0)
    field = SurfaceField.of(TWO_ROOMS.map)
    before = field.values.copy()
    LearnedWalls(field, belief).learn()
    assert np.array_equal(field.values, before)


def test_one_scan_finds_walls_that_are_drawn_too_thick() -> None:
    field = SurfaceField.of(coarse_and_thick(FURNISHED))
    view = LIDAR.view(Eye(FURNISHED).scan(HERE))
    here = np.array([HERE.x, HERE.y, HERE.theta])
    before = view.fit(field, here).evidence
    walls = LearnedWalls(field, unknown_belief())
    there = walls.find(view, HERE, CONFIG.localization.beam_deviation)
    assert there.distance_to(HERE.x, HERE.y) < 0.05
    assert view.fit(field, here).evidence > before + 10.0
