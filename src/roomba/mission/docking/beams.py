"""The charging station's infrared light, as the robot receives it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class StationBeams:
    """What the robot's receiver sees of the station's light.

    ``red`` is the beam to the station's left as it looks out, so to the right of a robot that looks
    at it; ``green`` is the other one. In the middle both are seen.
    """

    halo: bool = False
    green: bool = False
    red: bool = False

    @property
    def leads(self) -> bool:
        """Whether they tell a way to the station: the halo alone does not."""
        return self.green or self.red


NO_BEAMS: Final = StationBeams()
"""None of the station's light is in sight."""
