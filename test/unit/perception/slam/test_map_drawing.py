"""A map that is being made is drawn once a period, if it grew."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from roomba.configuration.robot import TimingConfig
from roomba.grid import UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.slam.map_drawing import MapDrawing

TIMING = TimingConfig(map_period=1.0)
MAP = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 2, 2), np.full((2, 2), UNKNOWN, np.int8))


@dataclass
class Source:
    version: int = 0

    def occupancy(self) -> OccupancyMap:
        return MAP


def test_without_a_map_there_is_nothing_to_draw() -> None:
    drawing = MapDrawing(Source(), TIMING)
    assert drawing.draw(0.0) is None
    assert drawing.due_at == math.inf


def test_the_first_map_is_drawn_at_once_and_the_next_a_period_later() -> None:
    source = Source(1)
    drawing = MapDrawing(source, TIMING)
    assert drawing.draw(3.0) is MAP
    source.version = 2
    drawn = [drawing.draw(3.0 + tick * TIMING.tick) is not None for tick in range(1, 21)]
    assert drawn == [False] * 19 + [True]


@pytest.mark.parametrize("start", [0.0, 0.1, 1000.3, 1.7e9])
def test_the_clock_it_goes_by_changes_nothing(start: float) -> None:
    source = Source()
    drawing = MapDrawing(source, TIMING)
    drawn = []
    for tick in range(100):
        source.version += 1
        if drawing.draw(start + tick * TIMING.tick) is not None:
            drawn.append(tick)
    assert drawn == [0, 20, 40, 60, 80]


def test_a_map_that_did_not_grow_is_not_drawn_again() -> None:
    source = Source(1)
    drawing = MapDrawing(source, TIMING)
    drawing.draw(0.0)
    assert drawing.draw(50.0) is None
    assert drawing.due_at == math.inf
    source.version = 2
    assert drawing.due_at == pytest.approx(1.0, abs=TIMING.tick)


def test_a_clock_that_is_set_back_does_not_end_the_drawing() -> None:
    source = Source(1)
    drawing = MapDrawing(source, TIMING)
    drawing.draw(100.0)
    source.version = 2
    assert drawing.draw(5.0) is MAP
