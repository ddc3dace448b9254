"""Stores a run of ``sim`` in the history."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32
from roomba.client.protocol import MissedFloor
from roomba.client.view import known_cells
from roomba.commands.sim.state_samples import StateSamples
from roomba.commands.trials.figures import Figures
from roomba.commands.trials.runs import TRAJECTORY_STEP, Run
from roomba.grid import GridFrame
from roomba.history.database import History
from roomba.history.folder import history_folder
from roomba.history.run import (
    TRACE,
    TRACE_STEP,
    CellLayer,
    RunFigures,
    RunRecording,
    RunSource,
)
from roomba.mission.cleaning.checkpoint import request_values
from roomba.mission.cleaning.result import CleanOutcome
from roomba.perception.swept.visits import Visits

_COLUMNS: Final = TRACE[4:]
"""The columns of the robot's state; its poses are in the trajectory."""
_COVERAGE_STRIDE: Final = 2
"""Every so many poses of the trajectory are used to draw the swept floor."""


def keep_run(run: Run, samples: StateSamples, repeat: str) -> int:
    """Keep a run in the history; return its number. Raises RoombaError."""
    trial = run.trial
    configuration = {"request": request_values(trial.request), "battery": trial.battery}
    source = RunSource("sim", run.home.name, trial.seed, repeat, configuration)
    return History(history_folder()).add(
        figures_of(run.figures, source), recording_of(run, samples)
    )


def figures_of(figures: Figures, source: RunSource) -> RunFigures:
    """Return the figures; covered and wanted areas are true ones, of floor that can be covered."""
    return RunFigures(
        source,
        "clean",
        time.time() - figures.wall_s,
        CleanOutcome[figures.outcome].value,
        figures.message,
        figures.duration_s,
        figures.covered_m2,
        figures.coverable_m2,
        figures.distance_m,
        figures.turning_rad,
        figures.dirt_g,
        figures.energy_wh,
        tuple(
            MissedFloor(each.area_m2, each.x, each.y, each.room, each.reason, each.code)
            for each in figures.missed
        ),
        figures.times,
    )


def recording_of(run: Run, samples: StateSamples) -> RunRecording:
    """Return the recording: true poses, and each time the state of the last look."""
    began = float(run.trajectory[0, 0])
    words = tuple(replace(word, time=max(word.time - began, 0.0)) for word in samples.words)
    visits = Visits(run.home.map.frame, run.figures.tool_width_m)
    visits.sweep_all(run.trajectory[::_COVERAGE_STRIDE, :3])
    layers = {
        "map": _layer(run.home.map.frame, known_cells(run.home.map)),
        "coverage": _layer(visits.frame, visits.counts),
    }
    return RunRecording(_trace(run, samples), words, samples.home, layers)


def _trace(run: Run, samples: StateSamples) -> Floats32:
    stride = round(TRACE_STEP / TRAJECTORY_STEP)
    poses = run.trajectory[::stride]
    trace = np.zeros((len(poses), len(TRACE)))
    trace[:, :4] = poses - [run.trajectory[0, 0], 0.0, 0.0, 0.0]
    states = np.array(samples.rows).reshape(-1, 1 + len(_COLUMNS))
    # The state before a pose, not at it: at the very end no clean is under way any more.
    latest = np.maximum(np.searchsorted(states[:, 0], poses[:, 0], side="left") - 1, 0)
    trace[:, 4:] = states[latest, 1:]
    result: Floats32 = trace.astype(np.float32)
    return result


def _layer(frame: GridFrame, cells: NDArray[np.uint8]) -> CellLayer:
    return CellLayer(frame.resolution, frame.origin_x, frame.origin_y, cells)
