"""Beams into a mirror, or through a wall of the map, do not drag the pose away."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.drives.made_lidars import Floats
from fixtures.robots.located import FURNISHED, LIDAR, Eye

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.localization.belief.behind_kernels import BEHIND_LANES, leave_out_behind
from roomba.perception.localization.belief.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief.correct_kernels import match_ends
from roomba.perception.matching.field_kernels import OFF_MAP
from roomba.perception.matching.surface_field import SurfaceField

CONFIG = RobotConfig()
NUMBERS = numbers_of(CONFIG.localization, CONFIG.gyro)
LENGTH, WIDTH, WALL, CELL = 8.0, 2.0, 0.3, 0.05
"""m; a passage along x that begins behind a mirror at x = 0, its walls, and cells of its map."""
BODY = 0.16
"""m; radius of the robot, as it sees itself in the mirror."""
REACH = 3.0
"""m; of the lidar: it does not see the other end."""
BEAMS = 360
STEP, RECKONED = 0.012, 0.003
"""m; the way from scan to scan, and how unsure dead reckoning makes the pose meanwhile."""
IN_CELL = CELL**2 / 12.0
"""m2; variance of where in its cell a wall is."""


def passage() -> SurfaceField:
    columns, rows = round((LENGTH + 2 * WALL) / CELL), round((WIDTH + 2 * WALL) / CELL)
    x = CELL * (np.arange(columns) + 0.5) - WALL
    y = CELL * (np.arange(rows)[:, None] + 0.5) - WALL
    is_free = (x > 0.0) & (x < LENGTH) & (y > 0.0) & (y < WIDTH)
    frame = GridFrame(CELL, -WALL, -WALL, rows, columns)
    return SurfaceField.of(OccupancyMap(frame, np.where(is_free, 0, 100).astype(np.int8)))


FIELD = passage()


def seen_beside_the_mirror(x: float, y: float) -> Floats:
    """Return ends of beams, [n, 4], of a robot at x, y, m, that faces along x.

    The mirror shows the passage, and the robot in it, at the other side of x = 0.
    """
    ends = []
    for angle in np.arange(BEAMS) * 2.0 * math.pi / BEAMS:
        along, across = math.cos(angle), math.sin(angle)
        wall = ((WIDTH if across > 0.0 else 0.0) - y) / across if across else math.inf
        # How far the beam is from the middle of the image, and where it is nearest to that.
        nearest, aside = -2.0 * x * along, abs(2.0 * x * across)
        image = nearest - math.sqrt(BODY**2 - aside**2) if aside < BODY else math.inf
        length = min(wall, image if nearest > 0.0 else math.inf)
        if length < REACH:
            ends.append((length * along, length * across, along, across))
    return np.array(ends)


def match(beliefs: Rows, field: SurfaceField, ends: Floats) -> None:
    lanes = np.empty((BEHIND_LANES, len(ends)))
    match_ends(beliefs, NUMBERS, field.values, field.place, ends, len(ends), lanes)


def unsure(beliefs: Rows, deviation: float) -> None:
    beliefs[0]["covariance"][:] += np.diag([deviation**2, deviation**2, (0.5 * deviation) ** 2])


def test_its_own_image_in_a_mirror_does_not_take_the_place_along() -> None:
    beliefs = unknown_belief()
    true = BODY + 0.01
    beliefs[0]["pose"][:] = true, 0.5 * WIDTH, 0.0
    unsure(beliefs, 0.005)
    for _ in range(25):
        match(beliefs, FIELD, seen_beside_the_mirror(true, 0.5 * WIDTH))
        true += STEP
        beliefs[0]["pose"][0] += STEP
        unsure(beliefs, RECKONED)
    assert beliefs[0]["pose"].tolist() == pytest.approx([true, 0.5 * WIDTH, 0.0], abs=0.03)


@pytest.mark.parametrize("heading", np.arange(0.0, 2.0 * math.pi, 0.25 * math.pi).tolist())
def test_all_of_a_scan_corrects_a_place_that_is_off_by_the_wheels(heading: float) -> None:
    """Though by the place that it has before that, beams seem to end behind walls."""
    pose, field = Pose(1.0, 1.0, 2.0), SurfaceField.of(FURNISHED.map)
    beliefs = unknown_belief()
    beliefs[0]["pose"][:] = pose.x, pose.y, pose.theta
    beliefs[0]["pose"][:2] += 0.1 * math.cos(heading), 0.1 * math.sin(heading)
    unsure(beliefs, 0.02)
    match(beliefs, field, LIDAR.view(Eye(FURNISHED).scan(pose)).ends)
    assert beliefs[0]["pose"][:2].tolist() == pytest.approx([pose.x, pose.y], abs=0.01)


def middle_of_passage(angles: Floats) -> tuple[Floats, Floats]:
    """Return ends, [n, 4], and lanes of beams of a robot 1 m before the mirror.

    The passage goes on ahead of it, where beams end 1 m off as well: nothing is behind.
    """
    along, across = np.cos(angles), np.sin(angles)
    lengths = 1.0 / np.maximum(np.abs(along), np.abs(across))
    ends = np.column_stack((lengths * along, lengths * across, along, across))
    return ends, np.vstack((ends[:, :2].T, np.zeros(len(angles))))


AT = np.array([1.0, 0.5 * WIDTH, 0.0])
"""The pose of :func:`middle_of_passage`."""
ALL_AROUND = np.arange(BEAMS) * 2.0 * math.pi / BEAMS
MIRROR = np.arange(170, 191)
"""Beams of these to the end of the passage."""


def left_of(lanes: Floats) -> int:
    return leave_out_behind(FIELD.values, FIELD.place, lanes.shape[1], AT, IN_CELL, lanes)


def test_beams_that_end_behind_a_surface_are_left_out_with_those_beside_them() -> None:
    _, lanes = middle_of_passage(ALL_AROUND)
    lanes[0, MIRROR] -= np.where(MIRROR % 2, 0.2, 0.0)
    kept = lanes.copy()
    left = left_of(lanes)
    is_out = lanes[0] == OFF_MAP
    assert left == np.sum(~is_out)
    assert is_out[MIRROR].all()
    assert not is_out[np.r_[:150, 211:360]].any()
    assert lanes[:2, ~is_out].tolist() == kept[:2, ~is_out].tolist()


def test_what_is_left_out_gets_a_margin_when_it_is_looked_at_again() -> None:
    _, lanes = middle_of_passage(ALL_AROUND)
    lanes[0, MIRROR] -= 0.2
    left_of(lanes)
    first = np.flatnonzero(lanes[0] == OFF_MAP)
    assert left_of(lanes) == BEAMS - len(first) - 16
    again = np.flatnonzero(lanes[0] == OFF_MAP)
    assert again.tolist() == list(range(first[0] - 8, first[-1] + 9))


def test_a_scan_of_which_few_beams_are_left_tells_as_much_as_these_few() -> None:
    few = np.linspace(0.3 * math.pi, 0.7 * math.pi, 20)
    # Four beams to either side of those behind the mirror are left out with them.
    aside = np.linspace(0.26 * math.pi, 0.29 * math.pi, 4)
    many = np.r_[few, math.pi - aside, np.linspace(0.9 * math.pi, 1.1 * math.pi, 80), aside]
    covariances = []
    for angles in (few, many):
        beliefs = unknown_belief()
        beliefs[0]["pose"][:] = AT
        unsure(beliefs, 0.02)
        ends, _ = middle_of_passage(angles)
        ends[24:104, 0] -= 0.2
        match(beliefs, FIELD, ends)
        covariances.append(beliefs[0]["covariance"].ravel().tolist())
    assert covariances[1] == pytest.approx(covariances[0], rel=1e-6, abs=1e-12)


def test_walls_that_are_off_by_less_than_is_usual_are_kept() -> None:
    _, lanes = middle_of_passage(np.linspace(2.5, 3.8, 60))
    lanes[:2] *= 1.03
    assert left_of(lanes) == 60


def test_what_ends_off_the_map_is_behind_its_edge() -> None:
    _, lanes = middle_of_passage(np.linspace(2.5, 3.8, 60))
    lanes[0] = -1.0 - 2.0 * WALL
    assert left_of(lanes) == 0
    assert (lanes[0] == OFF_MAP).all()
