"""What a page shows of a robot without a lidar: all by its wheels."""

from __future__ import annotations

import itertools
import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.bumping.brain import BumpingState
from roomba.bumping.felt_floor import FeltFloor
from roomba.client.protocol import CleanReport, VacuumSnapshot
from roomba.client.view import NO_POINTS, GridLayer, HomeView, LayerName, RobotView, battery_fills
from roomba.geometry import Pose
from roomba.headless.live.bumping.robot import BumpingRobot
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.vocabulary import Phase

BY_WHEELS: Final = "it has no lidar: where it is, and what it swept, is by wheels and walls"
_MARGIN: Final = 20
"""Cells shown around what is known; the grid that is shown grows in steps of so many."""
_PHASES: Final = {
    BumpingState.DOCKED: Phase.DOCKED,
    BumpingState.LEAVING: Phase.UNDOCKING,
    BumpingState.SWEEPING: Phase.CLEANING,
    BumpingState.HOMING: Phase.RETURNING,
    BumpingState.DOCKING: Phase.DOCKING,
    BumpingState.STANDING: Phase.IDLE,
    BumpingState.PAUSED: Phase.PAUSED,
    BumpingState.HELD: Phase.ERROR,
    BumpingState.EMERGENCY: Phase.EMERGENCY,
}


def phase_of(state: BumpingState) -> Phase:
    """Return the word of a state that pages know."""
    return _PHASES[state]


def view_of(
    robot: BumpingRobot, last: CleanReport | None, top_speed: float, held: str = ""
) -> RobotView:
    """Return the robot as it is now; ``held`` is why the emergency stop holds the drive."""
    now, brain = robot.now, robot.brain
    pose, phase, trouble = brain.compass.pose, phase_of(brain.state), robot.body.trouble
    swept = brain.floor.coverage.swept_area
    return RobotView(
        time=now.time,
        pose=(pose.x, pose.y, pose.theta),
        doubt=trouble.text or BY_WHEELS,
        speed=abs(now.twist.linear),
        dirt=math.nan,
        held=held,
        vacuum=VacuumSnapshot(
            VACUUM_STATES[phase],
            phase.value,
            trouble.text or (brain.state.value if phase is Phase.ERROR else ""),
            "",
            swept,
            0.0,
            0.0,
            0.0,
            now.battery.level,
            hindrance=trouble.hindrance,
        ),
        scan=NO_POINTS,
        path=NO_POINTS,
        last=last,
        top_speed=top_speed,
        charges=battery_fills(now.battery.level, is_docked=now.battery.is_docked),
    )


def home_of_bumping(version: int, name: str, robot: BumpingRobot) -> HomeView:
    """Return what seldom changes: there are no rooms and no zones."""
    station = robot.brain.station or Pose()
    body, tool = robot.robot_config.body, robot.robot_config.brush.width
    place = (station.x, station.y, station.theta)
    return HomeView(version, name, place, (), (), (), body.radius, tool)


class FeltLayers:
    """The grids of a felt floor as a page draws them, cut to what is known."""

    def __init__(self) -> None:
        """Begin with none."""
        self._shapes = itertools.count(1)
        self._shape, self._window = 0, (0, 0, 0, 0)

    def layer(self, floor: FeltFloor, name: LayerName) -> GridLayer | None:
        """Return a layer as it is now; None of what such a robot does not know."""
        if name not in (LayerName.MAP, LayerName.COVERAGE):
            return None
        swept, felt = floor.coverage.swept, floor.felt
        first_row, end_row, first, end = self._look_for(swept | felt)
        cells = swept.astype(np.uint8)
        if name is LayerName.MAP:
            cells[felt] = 2
        frame = floor.coverage.frame
        x, y = (
            frame.origin_x + first * frame.resolution,
            frame.origin_y + first_row * frame.resolution,
        )
        return GridLayer(
            self._shape, frame.resolution, x, y, cells[first_row:end_row, first:end].copy()
        )

    def _look_for(self, known: NDArray[np.bool_]) -> tuple[int, int, int, int]:
        """Return the rows and columns to be shown, of bool [rows, columns]."""
        ends = []
        for axis in (1, 0):
            at = np.flatnonzero(known.any(axis=axis))
            most = known.shape[1 - axis]
            low, high = (int(at[0]), int(at[-1]) + 1) if len(at) else (most // 2, most // 2)
            ends += [
                max(low // _MARGIN * _MARGIN - _MARGIN, 0),
                min(-(-high // _MARGIN) * _MARGIN + _MARGIN, most),
            ]
        window = (ends[0], ends[1], ends[2], ends[3])
        if window != self._window:
            self._window, self._shape = window, next(self._shapes)
        return window
