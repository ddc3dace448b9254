"""A scan tells nothing about the position along bare walls, however these lie in their cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from fixtures.drives.made_lidars import Floats, Lidar, outlines
from fixtures.robots.located import FURNISHED, LIDAR, Eye
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.localization.belief.behind_kernels import BEHIND_LANES
from roomba.perception.localization.belief.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.correct_kernels import _NARROW, _STILL, match_ends
from roomba.perception.localization.belief.weak_kernels import leave_out
from roomba.perception.matching.match_kernels import match
from roomba.perception.matching.surface_field import SurfaceField

CONFIG = RobotConfig()
NUMBERS = numbers_of(CONFIG.localization, CONFIG.gyro)
NOISY = Lidar(farthest=8.0, noise=0.03, turns=False)
LONG, WIDE, CELL, ROUGH = 40.0, 6.0, 0.05, 0.3
"""m; a corridor along x, and cells of its map: at this share of columns a side is one deeper."""
UNSURE, UNSURE_TURN = 0.03, 0.01
"""m, rad; deviations of what is known before each scan."""
SCANS = 60
"""Of which the first third only shows what they are like."""


@dataclass(frozen=True)
class Corridor:
    """``walls`` [n, 4], m, and what is matched to: the map whose cells they touch."""

    walls: Floats
    field: SurfaceField

    @staticmethod
    def of(*things: tuple[float, float, float, float]) -> Corridor:
        generator = np.random.default_rng(2)
        sides = np.array([(0.0, 0.0, LONG, 0.0), (0.0, WIDE, LONG, WIDE)])
        walls = np.concatenate((sides, outlines(*things))) if things else sides
        columns, rows = round(LONG / CELL), round((WIDE + 2.0) / CELL)
        x, y = CELL * (np.arange(columns) + 0.5), CELL * (np.arange(rows)[:, None] + 0.5) - 1.0
        low, high = CELL * (generator.random((2, columns)) < ROUGH)
        is_solid = (y < -low) | (y > WIDE + high)
        for left, lowest, right, highest in things:
            is_solid |= (x > left) & (x < right) & (y > lowest) & (y < highest)
        frame = GridFrame(CELL, 0.0, -1.0, rows, columns)
        values = np.where(is_solid, 100, 0).astype(np.int8)
        return Corridor(walls, SurfaceField.of(OccupancyMap(frame, values)))

    def seen(self, *, off: float) -> tuple[Floats, Floats, Rows]:
        """See it from places in its middle, taken for ``off``, m, farther along each time.

        Returns by how much scans moved the pose along, m, and the deviations of that afterwards.
        """
        generator, beliefs, model = np.random.default_rng(4), unknown_belief(), NOISY.model()
        belief, moved, deviations = beliefs[0], [], []
        for scan in range(SCANS):
            true = Pose(generator.uniform(14.0, 26.0), generator.uniform(2.0, 4.0), 0.0)
            view = model.view(seen_at(true, self.walls, generator))
            belief["pose"][:] = true.x + off, true.y, 0.0
            belief["covariance"][:] = np.diag([UNSURE**2, UNSURE**2, UNSURE_TURN**2])
            lanes = np.empty((BEHIND_LANES, len(view)))
            field = self.field
            match_ends(beliefs, NUMBERS, field.values, field.place, view.ends, len(view), lanes)
            if scan >= SCANS // 3:
                moved.append(belief["pose"][0] - true.x - off)
                deviations.append(float(np.sqrt(belief["covariance"][0, 0])))
        return np.array(moved), np.array(deviations), beliefs


def seen_at(pose: Pose, walls: Floats, generator: np.random.Generator) -> NDArray[np.float32]:
    return NOISY.scan(lambda _: pose, 0.0, walls, generator)


def test_steps_of_cells_tell_next_to_nothing_of_the_way_along_bare_walls() -> None:
    moved, deviations, _ = Corridor.of().seen(off=0.03)
    assert np.median(deviations) > 0.8 * UNSURE
    assert np.std(moved) < 0.003


def test_pillars_tell_of_the_way_along_a_corridor() -> None:
    pillars = [(x, 5.7, x + 0.3, 6.0) for x in np.arange(1.0, 39.0, 3.0).tolist()]
    moved, deviations, _ = Corridor.of(*pillars).seen(off=0.03)
    assert np.median(deviations) < 0.7 * UNSURE
    assert np.mean(moved) < -0.004


def test_errors_of_bare_walls_make_the_way_along_them_no_more_unsure() -> None:
    _, _, beliefs = Corridor.of().seen(off=0.0)
    assert np.sqrt(beliefs[0]["map_spread"][0, 0]) < 0.001


def test_of_a_furnished_room_all_is_believed() -> None:
    """The pose and how unsure it is are those of the match, to the last bit."""
    pose, field = Pose(3.0, 1.3, 0.4), SurfaceField.of(FURNISHED.map)
    view = LIDAR.view(Eye(FURNISHED).scan(pose))
    beliefs = unknown_belief()
    place, covariance = beliefs[0]["pose"], beliefs[0]["covariance"]
    place[:] = pose.x + 0.02, pose.y, pose.theta
    covariance[:] = np.diag([UNSURE**2, UNSURE**2, UNSURE_TURN**2])
    prior, told, at = place.copy(), covariance + np.diag(_STILL), place.copy()
    match_ends(
        beliefs,
        NUMBERS,
        field.values,
        field.place,
        view.ends,
        len(view),
        np.empty((BEHIND_LANES, len(view))),
    )
    variance = CONFIG.localization.beam_deviation**2 + (0.5 * FURNISHED.map.frame.resolution) ** 2
    match(
        field.values, field.place, view.ends, len(view), prior, told, _NARROW, variance, at
    )  # fmt: skip
    assert place.tolist() == at.tolist()
    assert covariance.tolist() == told.tolist()


def test_a_share_of_a_deviation_is_left_along_a_direction_and_all_of_it_across() -> None:
    turned = np.linalg.qr(np.array([[1.0, 0.2, 0.3], [0.4, 1.0, 0.1], [0.2, 0.5, 1.0]]))[0]
    weak = np.ascontiguousarray(turned[:, 0])
    spread = turned @ np.diag([4.0, 2.0, 1.0]) @ turned.T
    leave_out(weak, 0.5, spread)
    assert turned.T @ spread @ turned == pytest.approx(np.diag([1.0, 2.0, 1.0]), abs=1e-12)
