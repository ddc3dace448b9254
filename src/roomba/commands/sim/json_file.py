"""A run as JSON, so that other programs can check what it claims.

Version 1. SI units as the names say, map frame, angles counter-clockwise. ``coverable_m2`` is the
floor that the tool, a disc of ``robot.tool_width_m``, passes over when the robot's middle goes to
every place that it can reach from its station, keeping ``robot.reach_m`` from all that is solid in
the true home; ``covered_m2`` what of it the tool passed over, by true poses. Both are counted on a
grid of about 1 cm. ``path_ratio`` is ``distance_m * tool_width_m / coverable_m2``.
``rate_m2_a_minute`` is ``covered_m2`` by ``duration_s``, and ``times_s`` where that time went: its
``least`` is what no robot of that width can undercut at that speed, and ``times_least`` what it was
under way, without charging and waiting, by that. ``missed`` is what the robot itself says that it
left; ``unreached`` is floor that its map shows, but to which no way leads from its station:
``area_m2`` of all pieces, 0 below 1 m2, and the ``rooms`` of which it is as much. ``trajectory``
has rows t, x, y, theta: true poses, ten a second, the first and the last one included. ``wall_s``
is what the clean took on the clock, and ``planning_s`` what of it went into ``plans`` of the
coverage planner, ways through gaps included; all else is the same for the same trial, bit for bit.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from roomba.commands.output import pose_as_json
from roomba.commands.trials.figures import Figures
from roomba.commands.trials.runs import Run
from roomba.commands.trials.trial import Trial
from roomba.commands.trials.unreached import NOTHING, Unreached
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.mission.cleaning.checkpoint import request_values

VERSION: Final = 1
TIMES: Final = ("wall_s", "planning_s", "times_real_time")
"""The values that differ between two runs of the same trial."""


def run_as_json(run: Run, unreached: Unreached = NOTHING) -> dict[str, Any]:
    """Return all of a run."""
    return {
        **_about(run.trial, run.home.name),
        **run.figures.as_json(),
        "unreached": unreached.as_json(),
        "sensors": run.robot.simulation.sensors,
        "wheels": run.robot.simulation.condition,
        "robot": {
            "body_diameter_m": run.robot.body.diameter,
            "reach_m": round(run.reach, 6),
            "tool_width_m": run.figures.tool_width_m,
        },
        "station": pose_as_json(run.home.station),
        "things": [[round(value, 4) for value in thing] for thing in run.things],
        "trajectory": (np.round(run.trajectory, 4) + 0.0).tolist(),
    }


def runs_as_json(
    figures: dict[int, Figures],
    failures: dict[int, str],
    percentiles: dict[str, dict[str, float]],
    config: SimulatedRobotConfig,
    wall: float,
) -> dict[str, Any]:
    """Return many runs, by their seeds, without their trajectories."""
    return {
        "version": VERSION,
        "homes": len(figures) + len(failures),
        "completed": sum(each.is_completed for each in figures.values()),
        "sensors": config.simulation.sensors,
        "wheels": config.simulation.condition,
        "all_wall_s": round(wall, 3),
        "percentiles": percentiles,
        "runs": [{"seed": seed, **each.as_json()} for seed, each in sorted(figures.items())],
        "failures": [{"seed": seed, "reason": why} for seed, why in sorted(failures.items())],
    }


def _about(trial: Trial, home: str) -> dict[str, Any]:
    return {
        "version": VERSION,
        "home": home,
        "map": trial.home,
        "seed": trial.seed,
        "request": request_values(trial.request),
        "no_go": [list(zone) for zone in trial.no_go],
        "shut_doors": trial.shut_doors,
        "turned_degrees": trial.turned,
        "battery": trial.battery,
    }
