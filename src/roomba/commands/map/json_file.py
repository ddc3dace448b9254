"""A run as JSON, so that other programs can check what it claims.

Version 1. SI units as the names say, map frame, angles counter-clockwise, shares 0..1. ``error`` is
of the robot's map against the truth, ``by_odometry`` of the one that wheels and gyro alone make of
the same scans; see :class:`~roomba.commands.map.map_error.MapError`. ``trajectory`` has rows t, x,
y, theta, ten a second: true poses; ``believed`` what the robot took them to be. ``unseen`` are
places that were given up, ``open_edges`` the longer edges that the map still has there. ``wall_s``
is what it took on the clock; all else is the same for the same trial, bit for bit.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from roomba.commands.map.runs import Drawn, MapRun
from roomba.commands.output import pose_as_json

VERSION: Final = 1
TIMES: Final = ("wall_s", "times_real_time")
"""What differs between two runs of the same trial."""
_STRIDE: Final = 2
"""Ticks between two rows."""


def run_as_json(run: MapRun) -> dict[str, Any]:
    """Return all of a run."""
    result, frame = run.record.result, run.made.occupancy.frame
    return {
        "version": VERSION,
        "home": run.home.name,
        "map": run.trial.home,
        "seed": run.trial.seed,
        "sensors": run.robot.simulation.sensors,
        "wheels": run.robot.simulation.condition,
        "outcome": result.outcome.name,
        "message": result.message,
        "duration_s": round(result.duration, 3),
        "distance_m": round(result.distance, 3),
        "known_m2": round(result.known, 4),
        "unseen": [[round(x, 3), round(y, 3)] for x, y in result.unseen],
        "open_edges": [
            {
                "length_m": round(edge.length, 3),
                "x": round(edge.x, 3),
                "y": round(edge.y, 3),
                "reason": edge.reason.value,
            }
            for edge in result.open_edges
        ],
        "hits": run.record.hits,
        "wall_s": round(run.record.wall, 3),
        "times_real_time": round(run.times_real_time, 1),
        "error": drawn_as_json(run.made),
        "by_odometry": drawn_as_json(run.by_odometry),
        "station": pose_as_json(run.station),
        "grid": {
            "resolution_m": frame.resolution,
            "origin_m": [round(frame.origin_x, 6), round(frame.origin_y, 6)],
            "rows": frame.rows,
            "columns": frame.columns,
        },
        "trajectory": (np.round(run.record.poses[::_STRIDE], 4) + 0.0).tolist(),
        "believed": (np.round(run.record.believed[::_STRIDE], 4) + 0.0).tolist(),
    }


def drawn_as_json(drawn: Drawn) -> dict[str, Any]:
    """Return the errors of a map."""
    error = drawn.error
    return {
        "walls_within_5_cm": round(error.walls, 6),
        "wall_distance_m": round(error.wall_distance, 6),
        "floor_iou": round(error.floor, 6),
        "doubled_cells": error.doubled,
        "specks": error.specks,
        "shift_m": [round(each, 6) for each in error.shift],
        "rotation_rad": round(error.rotation, 6),
        "extra_m2": round(error.extra, 4),
        "missed_m2": round(error.missed, 4),
        "largest_pose_error_m": round(drawn.largest, 6),
        "last_pose_error_m": round(drawn.last, 6),
    }
