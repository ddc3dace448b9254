"""Frames of a growing map are aligned: a place of the home is at the same pixels in all."""

from __future__ import annotations

import json
import math

import numpy as np
from fixtures.households.written_robot import HOME

from roomba.client.floor_map import FloorMap, valetudo_of
from roomba.client.view import GridLayer
from roomba.commands.demonstration.film import frames_of, placed
from roomba.commands.demonstration.listener import HeardMessage
from roomba.ui.smart_home.map_picture import picture_of

WALL = (112, 104, 94)
"""RGB of what is occupied."""


def message(time: float, columns: slice, rows: slice = slice(10, 50)) -> HeardMessage:
    """A map of which these cells are known; one cell in the middle is occupied."""
    cells = np.zeros((60, 80), np.uint8)
    cells[rows, columns] = 1
    cells[30, 40] = 2
    floor = FloorMap(
        GridLayer(1, 0.05, -1.0, -2.0, cells), None, HOME, (0.0, 0.0, math.pi / 2), ((0.0, 0.0),)
    )
    return HeardMessage(time, "map", picture_of(floor, json.dumps(valetudo_of(floor))))


def test_the_origin_of_the_map_is_found_in_a_picture() -> None:
    found = placed(message(0.0, slice(20, 60)).payload)
    # Known from x = 0 and up to y = 0.5 m, with 0.2 m around, 100 px/m.
    assert found.corner == (20, 70)


def test_what_grows_to_all_sides_lies_alike_in_each_frame() -> None:
    frames = frames_of(
        [message(0.0, slice(30, 50)), message(9.0, slice(10, 70), slice(5, 58))], 5.0
    )
    assert len(frames) == 2
    assert frames[0].shape == frames[1].shape
    places = [np.argwhere((frame == WALL).all(axis=2)).mean(axis=0) for frame in frames]
    assert np.abs(places[0] - places[1]).max() < 0.5


def test_a_frame_is_due_each_so_many_seconds_and_at_the_end() -> None:
    messages = [message(time, slice(30, 50)) for time in (0.0, 4.0, 9.0, 13.0, 14.0)]
    assert len(frames_of(messages, 10.0)) == 3
