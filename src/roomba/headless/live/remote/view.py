"""What a page shows of a robot that cleans by its own brain: what it tells, and no pose."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import CleanReport, VacuumSnapshot
from roomba.client.view import NO_POINTS, HomeView, RobotView
from roomba.configuration.robot import RobotConfig
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.robot.remote import RemoteState
from roomba.vocabulary import Phase

BY_ITSELF: Final = "it cleans by its own brain, and tells neither its map nor where it is"
TAKEN: Final = "another program drives it by hand"


@dataclass(frozen=True, slots=True)
class Failures:
    """What does not work now with such a robot: a reason each, empty where all is well.

    ``lost`` is why it is not reached, ``stop`` why it was not stopped though it is held, ``scan``
    why its scan is not shown.
    """

    lost: str = ""
    stop: str = ""
    scan: str = ""


def remote_view(
    time: float,
    state: RemoteState,
    scan: NDArray[np.float32] = NO_POINTS,
    held: str = "",
    failures: Failures = Failures(),
    last: CleanReport | None = None,
) -> RobotView:
    """Return the view of a robot as it told at ``time``, s: at its start, with what it sees.

    ``held`` is why the emergency stop holds, ``last`` how its last clean ended.
    """
    lost = failures.lost
    not_stopped = f"it did not obey the stop: {failures.stop}"
    trouble = lost or state.trouble or (TAKEN if state.is_taken else "")
    phase = Phase.ERROR if lost or state.trouble else state.phase
    if held:
        phase = Phase.EMERGENCY
        if failures.stop:
            trouble, held = trouble or not_stopped, f"{held}; but {not_stopped}"
    unseen = f"its scan is not shown: {failures.scan}" if failures.scan else ""
    return RobotView(
        time=time,
        pose=(0.0, 0.0, 0.0),
        doubt=lost or unseen or BY_ITSELF,
        speed=0.0,
        dirt=math.nan,
        held=held,
        vacuum=VacuumSnapshot(
            VACUUM_STATES[phase], phase.value, trouble, "", 0.0, 0.0, 0.0, 0.0, state.level
        ),
        scan=scan,
        path=NO_POINTS,
        last=last,
        charges=state.is_charging,
    )


def remote_home(name: str, config: RobotConfig) -> HomeView:
    """Return what seldom changes: no rooms, no zones, and no place of the station."""
    body = config.body
    return HomeView(1, name, (0.0, 0.0, 0.0), (), (), (), body.radius, config.brush.width)
