"""What a page shows of a robot that cleans by its own brain: what that tells, and no place."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import VacuumSnapshot
from roomba.client.view import NO_POINTS, HomeView, RobotView, battery_fills
from roomba.configuration.robot import RobotConfig
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.robot.remote import RemoteState
from roomba.vocabulary import Phase

BY_ITSELF: Final = "it cleans by its own brain, and tells neither its map nor where it is"
TAKEN: Final = "another program drives it by hand"


def remote_view(
    time: float,
    state: RemoteState,
    scan: NDArray[np.float32] = NO_POINTS,
    held: str = "",
    lost: str = "",
) -> RobotView:
    """Return a robot as it told at ``time``, s: it is shown where it began, with what it sees.

    ``held`` is why the emergency stop holds, ``lost`` why it is not reached now.
    """
    trouble = lost or state.trouble or (TAKEN if state.is_taken else "")
    phase = Phase.ERROR if lost or state.trouble else state.phase
    if held:
        phase = Phase.EMERGENCY
    return RobotView(
        time=time,
        pose=(0.0, 0.0, 0.0),
        doubt=lost or BY_ITSELF,
        speed=0.0,
        dirt=math.nan,
        held=held,
        vacuum=VacuumSnapshot(
            VACUUM_STATES[phase], phase.value, trouble, "", 0.0, 0.0, 0.0, 0.0, state.level
        ),
        scan=scan,
        path=NO_POINTS,
        last=None,
        charges=battery_fills(state.level, is_docked=state.has_power),
    )


def remote_home(name: str, config: RobotConfig) -> HomeView:
    """Return what seldom changes: no rooms, no zones, and no place of the station."""
    body = config.body
    return HomeView(1, name, (0.0, 0.0, 0.0), (), (), (), body.radius, config.brush.width)
