"""When the station is to empty the robot's bin, as the household wants it."""

from __future__ import annotations

import math

from roomba.client.view import RobotView
from roomba.configuration.household import EmptyingConfig
from roomba.plans.plan import Emptying
from roomba.vocabulary import Phase


def is_to_be_emptied(
    view: RobotView,
    wanted: Emptying,
    capacity: float,
    config: EmptyingConfig,
    *,
    is_quiet: bool,
) -> bool:
    """Whether its station is to empty the bin now, which takes ``capacity`` g.

    A station with a full bag is not asked: it cannot.
    """
    can = math.isfinite(view.bag) and view.bag < 1.0
    if not can or is_quiet or wanted is Emptying.NEVER:
        return False
    phase, dirt = view.vacuum.phase, view.dirt if math.isfinite(view.dirt) else 0.0
    if phase == Phase.BIN_FULL:
        return True
    least = config.least if wanted is Emptying.EACH_RUN else config.level * capacity
    return phase == Phase.DOCKED and dirt >= least
