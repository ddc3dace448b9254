"""The arrays of homes: how much room is around cells, what the ground is, what stands where."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import block_that_moves
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.world.engine.layout import layout_of, room_around
from roomba.world.engine.state.arrays import CARPET, DROP, FLOOR

SIZE = 0.05

FARTHEST = 10
"""Cells; so far room must be told at least."""


@settings(max_examples=examples(40))
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.2))
def test_room_is_a_bound_and_a_close_one(seed: int, density: float) -> None:
    solid = np.random.default_rng(seed).random((24, 30)) < density
    room = room_around(solid, SIZE)
    assert room.dtype == np.float32
    rows, columns = np.nonzero(np.pad(solid, FARTHEST + 3, constant_values=True))
    rows, columns = rows - FARTHEST - 3, columns - FARTHEST - 3
    for row, column in np.argwhere(~solid)[::7].tolist():
        dy = np.maximum(np.abs(rows - row) - 0.5, 0.0)
        dx = np.maximum(np.abs(columns - column) - 0.5, 0.0)
        true = float(np.hypot(dx, dy).min()) * SIZE
        assert room[row, column] <= true + 1e-7
        # Half a cell are lost on the diagonal, where cells touch all, and beyond the farthest all.
        assert room[row, column] >= min(true - 0.75 * SIZE, (FARTHEST - 1) * SIZE)
    assert not room[solid].any()


def test_the_ground_is_floor_carpet_or_a_drop() -> None:
    home = room_home(carpets=((1.0, 1.0, 2.0, 2.0),), stairs=((1.5, 1.5, 3.0, 3.0),))
    ground = layout_of([home], SimulatedRobotConfig()).cells["ground"].reshape(home.frame.shape)
    for (x, y), expected in {
        (0.5, 0.5): FLOOR,
        (1.2, 1.2): CARPET,
        (1.7, 1.7): DROP,
        (2.5, 2.5): DROP,
    }.items():
        assert ground[home.frame.cell_of(x, y)] == expected
    assert (ground == DROP).sum() == 30 * 30


def test_homes_lie_one_after_the_other() -> None:
    homes = [room_home(), room_home(2.0, 3.0), room_home(3.0, 2.0, stairs=((1.0, 1.0, 2.0, 2.0),))]
    layout = layout_of(homes, SimulatedRobotConfig())
    assert layout.homes["has_drops"].tolist() == [0.0, 0.0, 1.0]
    for row, home in zip(layout.homes, homes, strict=True):
        cells = layout.cells[row["cells_at"] : row["cells_at"] + home.solid.size]
        assert (cells["solid"] == home.solid.ravel()).all()
        assert (row["left"], row["bottom"]) == (home.frame.origin_x, home.frame.origin_y)
        assert (row["rows"], row["columns"]) == home.frame.shape


def test_only_boxes_that_stand_in_the_bodys_way_are_there() -> None:
    body = SimulatedRobotConfig().body
    low = block_that_moves(pose=Pose(1.0, 1.0, 0.0), heights=(body.height - 0.01, 0.5))
    high = block_that_moves(pose=Pose(2.0, 1.0, 0.0), heights=(body.height, 0.5))
    layout = layout_of([room_home(moving=[low, high, low])], SimulatedRobotConfig())
    assert layout.boxes_at == [[0, 1, 1, 2]]
    assert layout.boxes["half_length"] == pytest.approx([0.2, 0.2])
    assert layout.boxes["top"].tolist() == [0.5, 0.5]
