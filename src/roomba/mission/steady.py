"""Steady ticks: those of which it is known what they do, as long as nothing comes up.

A program that lets time pass may do them in compiled code, with the same result: the mission's own
tick has its turn at the first one at which a bound given here does not hold any more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from roomba.mission.driving.path_driver import PathDriver


@dataclass(frozen=True, slots=True)
class Steady:
    """What ends steady ticks, looked at before each of them.

    ``driver`` is tracked along its path, at up to ``limit`` m/s; None: it stands and charges.
    ``until``
        s of the robot's clock; from then on it looks at something.
    ``least_level``, ``most_energy``
        0..1 and Wh; with less, or with as much, in the battery.
    ``most_in_bin``, ``most_silent``
        g in the dust bin, and m2 of floor that became clean without a grain that came in.
    ``goal``, ``near``
        m; where it wants to get, and so near it is there.
    """

    driver: PathDriver | None
    limit: float = 0.0
    until: float = math.inf
    least_level: float = 0.0
    most_energy: float = math.inf
    most_in_bin: float = math.inf
    most_silent: float = math.inf
    goal: tuple[float, float] = (0.0, 0.0)
    near: float = -1.0
