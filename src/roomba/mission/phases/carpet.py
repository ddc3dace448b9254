"""Whether the robot is on carpet, by the current of its brush: there the motor works harder."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.configuration.body import BrushConfig
from roomba.mission.phases.carpet_kernels import CARPET_SENSE, note_current

_RESTS: Final = 0.5
"""Share of the current below which the robot is off carpet; with less the brush rests."""


class CarpetSense:
    """Ticked all the time; a body that does not tell the current is never on carpet."""

    def __init__(self, config: BrushConfig) -> None:
        """Begin off carpet."""
        self.rows = np.zeros(1, CARPET_SENSE)
        self.rows["carpet_from"] = config.carpet_current
        self.rows["floor_below"] = config.floor_current
        self.rows["rests_below"] = _RESTS * config.floor_current
        self.rows["share"] = config.current_share
        self.rows["mean"] = np.nan

    def note(self, current: float) -> None:
        """Take the current of a tick, A."""
        note_current(self.rows, current)

    @property
    def is_on(self) -> bool:
        """Whether it is on carpet."""
        return bool(self.rows[0]["is_on"])
