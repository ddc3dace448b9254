"""Compiled bookkeeping of a map's cells: counts of beams in a look, and scores over looks."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, entry
from roomba.perception.slam.drawing.drawing_kernels import CountArrays, draw
from roomba.perception.slam.scan_matching.surface_kernels import NORMAL_X, NORMAL_Y, X, Y

MOST: Final = 5
"""The limit of a cell's score, so that a change is noticed soon after any time without change."""
NO_BOUNDS: Final = np.array([2**40, -1, 2**40, -1])
"""First and last row and column with counts, while there are none."""


@entry
def count_scan(
    cells: CountArrays,
    ranges: NDArray[np.float32],
    directions: Floats,
    mount: Floats,
    nearest: float,
    farthest: float,
    pose: Floats,
    points: NDArray[np.float32],
) -> None:
    """Count the cells where beams of a scan from ``pose`` [3] ended, and those that they passed.

    ``ranges`` is float32 [beams], m, of which those from ``nearest`` to ``farthest`` count;
    ``directions`` [beams, 2], cosine and sine in the lidar's frame; ``mount`` [3] the lidar's place
    in the robot's frame. ``points`` [beams, 4] is a work array.
    """
    turn_cosine, turn_sine = math.cos(mount[2]), math.sin(mount[2])
    count = 0
    for beam in range(ranges.size):
        length = ranges[beam]
        if not nearest <= length <= farthest:
            continue
        cosine, sine = directions[beam, 0], directions[beam, 1]
        points[count, X] = mount[0] + length * (turn_cosine * cosine - turn_sine * sine)
        points[count, Y] = mount[1] + length * (turn_sine * cosine + turn_cosine * sine)
        # Surface normals would place the points better by half a cell, but double the time.
        points[count, NORMAL_X], points[count, NORMAL_Y] = 0.0, 0.0
        count += 1
    draw(cells, points[:count], mount[:2], pose)


@allocating_entry
def score_look(
    cells: CountArrays, scores: NDArray[np.int8], least: int, solid_share: float, open_share: float
) -> None:
    """Add the counts of a look to the scores, int8 [rows, columns], and begin a new one.

    Cells that fewer than ``least`` beams met are left as they are. A cell in which ``least`` beams
    ended, and a share ``solid_share`` of its beams, gets 1 more; one in which a smaller share than
    ``open_share`` ended gets 1 less.
    """
    for row in range(cells.bounds[0], cells.bounds[1] + 1):
        for column in range(cells.bounds[2], cells.bounds[3] + 1):
            ended, through = int(cells.hits[row, column]), int(cells.passes[row, column])
            cells.hits[row, column] = cells.passes[row, column] = 0
            if ended + through < least:
                continue
            if ended >= least and ended >= solid_share * (ended + through):
                scores[row, column] = min(scores[row, column] + 1, MOST)
            elif ended < open_share * (ended + through):
                scores[row, column] = max(scores[row, column] - 1, -MOST)
    for side in range(4):
        cells.bounds[side] = NO_BOUNDS[side]
