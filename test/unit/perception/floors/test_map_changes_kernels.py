"""What scans say of a map's cells, against loops over beams and cells."""

from __future__ import annotations

import math

import numpy as np
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.configuration.mapping import MapChangesConfig
from roomba.perception.floors.map_changes_kernels import (
    MOST,
    NO_BOUNDS,
    count_scan,
    score_look,
)
from roomba.perception.slam.drawing.drawing_kernels import CountArrays

SIZE, CELL = 40, 0.1
COUNTS = arrays(np.uint16, (6, 7), elements=st.integers(0, 12))


def bounds_of(counted: NDArray[np.bool_]) -> NDArray[np.int64]:
    """First and last row and column with counts."""
    rows, columns = (np.flatnonzero(counted.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return NO_BOUNDS.copy()
    return np.array([rows[0], rows[-1], columns[0], columns[-1]])


@given(COUNTS, COUNTS, arrays(np.int8, (6, 7), elements=st.integers(-MOST, MOST)))
@settings(max_examples=examples(40))
def test_a_look_moves_scores_by_one_for_what_most_of_its_beams_say(
    hits: NDArray[np.uint16], passes: NDArray[np.uint16], scores: NDArray[np.int8]
) -> None:
    expected = scores.copy()
    for at in np.ndindex(6, 7):
        ended, through, score = int(hits[at]), int(passes[at]), int(scores[at])
        if ended >= 2 and 3 * ended >= through:
            expected[at] = min(score + 1, MOST)
        elif ended + through >= 2 and 9 * ended < through:
            expected[at] = max(score - 1, -MOST)
    bounds = bounds_of((hits > 0) | (passes > 0))
    cells = CountArrays(hits.copy(), passes.copy(), np.array([0.0, 0.0, CELL]), bounds)
    changes = MapChangesConfig()
    score_look(cells, scores, changes.least_beams, changes.solid_share, changes.open_share)
    assert np.array_equal(scores, expected)
    assert not cells.hits.any()
    assert not cells.passes.any()
    assert np.array_equal(cells.bounds, NO_BOUNDS)


@st.composite
def scans(draw: st.DrawFn) -> tuple[NDArray[np.float32], list[float], list[float]]:
    """Ranges of six beams all around, where the lidar is mounted, and where the robot is."""
    reach = st.floats(0.2, 1.5)
    none = st.sampled_from([0.0, 0.05, 9.0, math.inf, math.nan])
    ranges = draw(st.lists(st.one_of(reach, none), min_size=6, max_size=6))
    mount = draw(st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-3.0, 3.0)))
    pose = draw(st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2), st.floats(-3.0, 3.0)))
    return np.array(ranges, np.float32), list(mount), list(pose)


@given(scans())
@settings(max_examples=examples(40))
def test_beams_within_their_range_end_in_a_cell_and_pass_those_before_it(
    scan: tuple[NDArray[np.float32], list[float], list[float]],
) -> None:
    ranges, mount, pose = scan
    angles = 0.3 + np.arange(6) * math.pi / 3
    directions = np.column_stack((np.cos(angles), np.sin(angles)))
    counts = np.zeros((2, SIZE, SIZE), np.uint16)
    corner = -0.5 * SIZE * CELL
    place = np.array([corner, corner, CELL])
    cells = CountArrays(counts[0], counts[1], place, NO_BOUNDS.copy())
    points = np.empty((6, 4), np.float32)
    count_scan(cells, ranges, directions, np.array(mount), 0.1, 3.0, np.array(pose), points)
    # The lidar's place and heading in the map's frame, then along each beam.
    x = pose[0] + math.cos(pose[2]) * mount[0] - math.sin(pose[2]) * mount[1]
    y = pose[1] + math.sin(pose[2]) * mount[0] + math.cos(pose[2]) * mount[1]
    wanted = []
    for length, angle in zip(ranges.tolist(), angles.tolist(), strict=True):
        if not 0.1 <= length <= 3.0:
            continue
        heading = pose[2] + mount[2] + angle
        wanted.append((length, heading))
    assert counts[0].sum() == len(wanted)
    ends = np.zeros((SIZE, SIZE), np.bool_)
    for length, heading in wanted:
        # Less than a cell behind what it met, for rounding of the way that surfaces face.
        along = [length + share * CELL for share in np.linspace(-0.01, 1.0, 60).tolist()]
        places = [(x + way * math.cos(heading), y + way * math.sin(heading)) for way in along]
        near = {
            (math.floor((v - corner) / CELL), math.floor((u - corner) / CELL)) for u, v in places
        }
        assert any(counts[0][at] for at in near)
        for at in near:
            ends[at] = True
        way = 0.0
        while way < length - 2.0 * CELL:
            u, v = x + way * math.cos(heading), y + way * math.sin(heading)
            at = math.floor((v - corner) / CELL), math.floor((u - corner) / CELL)
            assert counts[1][at] or counts[0][at]
            way += 0.01
    assert not (counts[0] > 0)[~ends].any()
    first_row, last_row, first_column, last_column = cells.bounds.tolist()
    inside = np.zeros((SIZE, SIZE), np.bool_)
    inside[first_row : last_row + 1, first_column : last_column + 1] = True
    assert not counts[:, ~inside].any()
