"""A robot as a recorder of runs sees it, made up: a pose that goes on by 0.1 m and rad a second."""

from __future__ import annotations

import math

import numpy as np

from roomba.client.protocol import CleanReport, ErrandOutcome, MissedFloor, VacuumSnapshot
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.history.run import RunSource

HOME = HomeView(1, "box", (0.0, 0.0, 0.0), (), (), (), 0.16, 0.18)
SOURCE = RunSource("play", "box", 3)
REPORT = CleanReport(
    ErrandOutcome.COMPLETED,
    "",
    9.0,
    10.0,
    2.0,
    30.0,
    40.0,
    5.0,
    (MissedFloor(1.0, 2.0, 3.0, "", "x"),),
)
NO_POINTS = np.empty((0, 2), np.float32)


def layer(name: LayerName) -> GridLayer | None:
    """Return a floor of which all is known and clean."""
    return (
        None if name is LayerName.DIRT else GridLayer(1, 0.05, 0.0, 0.0, np.ones((4, 5), np.uint8))
    )


def view(time: float, phase: str, last: CleanReport | None = None) -> RobotView:
    """Return how it looks at a time, s."""
    state = "cleaning" if phase == "cleaning" else "docked"
    vacuum = VacuumSnapshot(state, phase, "", "", 0.0, 0.0, 0.0, 0.0, math.nan)
    pose = (time / 10.0, 0.0, 0.1 * time)
    return RobotView(time, pose, "", 0.2, 0.0, "", vacuum, NO_POINTS, NO_POINTS, last)
