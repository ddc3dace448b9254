"""A run, made up: a robot that drives along the x axis of a room of 4 m by 3 m."""

from __future__ import annotations

import numpy as np

from roomba.client.protocol import MissedFloor
from roomba.history.run import (
    TRACE,
    CellLayer,
    RunFigures,
    RunRecording,
    RunSource,
    Word,
)
from roomba.time_spent import TimeSpent
from roomba.vocabulary import EdgeReason, OpenEdge


def made_figures() -> RunFigures:
    """Twelve m2, of which one is left."""
    return RunFigures(
        RunSource("sim", "box", 7, "./roomba sim --home box --seed 7", {"battery": 0.5}),
        "clean",
        1_700_000_000.0,
        "completed",
        "",
        60.0,
        11.0,
        12.0,
        24.0,
        6.5,
        3.25,
        float("nan"),
        (MissedFloor(1.0, 3.5, 2.5, "hall", "a thing <stood> in the way", "thing"),),
        TimeSpent(least=18.5, straight=20.0, turning=12.0, station=20.0, waiting=8.0),
        (OpenEdge(1.5, 4.0, 1.0, EdgeReason.NO_ECHO),),
    )


def made_recording() -> RunRecording:
    """Sixty seconds: docked, cleaning, docked."""
    times = np.arange(0.0, 60.5, 0.5)
    trace = np.zeros((len(times), len(TRACE)), np.float32)
    trace[:, TRACE.index("time")] = times
    trace[:, TRACE.index("x")] = 0.5 + times / 20.0
    trace[:, TRACE.index("y")] = 1.5
    trace[:, TRACE.index("battery")] = 1.0 - times / 120.0
    trace[:, TRACE.index("dirt")] = 3.25 * times / 60.0
    trace[:, TRACE.index("sweeps")] = (times > 10.0) & (times < 50.0)
    words = (
        Word(0.0, "docked", "docked"),
        Word(10.0, "cleaning", "cleaning", room="hall"),
        Word(50.0, "docked", "docked"),
    )
    cells = np.ones((60, 80), np.uint8)
    cells[[0, -1]] = cells[:, [0, -1]] = 2
    swept = np.zeros((60, 80), np.uint8)
    swept[20:40, 10:70] = 1
    home = {
        "type": "home",
        "version": 1,
        "name": "box",
        "station": [0.5, 1.5, 0.0],
        "radius": 0.16,
        "tool": 0.18,
        "rooms": [
            {
                "name": "hall",
                "area": 12.0,
                "anchor": [2.0, 1.5],
                "rings": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]],
            }
        ],
        "zones": [],
        "furniture": [],
    }
    layers = {"map": CellLayer(0.05, 0.0, 0.0, cells), "coverage": CellLayer(0.05, 0.0, 0.0, swept)}
    return RunRecording(trace, words, home, layers)
