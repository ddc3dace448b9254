"""Parts that wear while the robot works: how long each has worked since it was new or cleaned."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final

from roomba.configuration.household import UpkeepConfig

HOUR: Final = 3600.0
"""s."""
_FORMER: Final = 1.0 * HOUR
"""s of work that all former fillings of the bin weigh beside the present one."""
_LEARNED: Final = 600.0
"""s of work after which a first filling says how fast the bin fills."""
_HELD: Final = 1.0
"""g; a bin that held less does not count as emptied when it holds less: it is weighed no better."""


class Part(Enum):
    """What a person replaces, cleans or empties."""

    BRUSH = "brush"
    SIDE_BRUSH = "side brush"
    FILTER = "filter"
    SENSORS = "sensors"
    """The sensors and the charging contacts: they are wiped."""
    BIN = "bin"


ADVICE: Final[Mapping[Part, str]] = {
    Part.BRUSH: "replace the brush",
    Part.SIDE_BRUSH: "replace the side brush",
    Part.FILTER: "replace the filter",
    Part.SENSORS: "wipe the sensors and the charging contacts",
    Part.BIN: "empty the bin",
}
"""What is to be done with a part that is due."""


@dataclass(frozen=True, slots=True)
class PartState:
    """How a part is: ``life`` and ``left`` in h of work, ``share`` of it that is left, 0..1.

    ``advice`` says what is to be done now, or soon; empty while there is time.
    """

    part: Part
    life: float
    left: float
    share: float
    advice: str

    @property
    def is_due(self) -> bool:
        """Whether nothing of its time is left."""
        return self.left <= 0.0


@dataclass(frozen=True, slots=True)
class Wear:
    """How long each part has worked since its last reset, s, and what is in the bin, g.

    ``dirt_rate`` is how fast the bin filled until it was last emptied, g a second of work; NaN if
    it never was emptied. A value: each change returns a new one.
    """

    worked: Mapping[Part, float] = field(default_factory=dict)
    in_bin: float = 0.0
    dirt_rate: float = math.nan

    def after(self, work: float, in_bin: float) -> Wear:
        """Return the wear after ``work`` more seconds, with ``in_bin`` g in the bin now.

        A bin that holds less than half of what it held, a gram or more, was emptied.
        """
        if work < 0.0 or not math.isfinite(work) or not math.isfinite(in_bin) or in_bin < 0.0:
            raise ValueError(f"expected seconds and grams of at least 0, got {work!r}, {in_bin!r}")
        is_emptied = self.in_bin >= _HELD and in_bin < 0.5 * self.in_bin
        before = self.reset(Part.BIN) if is_emptied else self
        worked = {part: before.hours(part) * HOUR + work for part in Part}
        return replace(before, worked=worked, in_bin=in_bin)

    def reset(self, part: Part) -> Wear:
        """Return the wear once a part was replaced, cleaned or emptied."""
        worked = {**self.worked, part: 0.0}
        if part is Part.BIN:
            return replace(self, worked=worked, in_bin=0.0, dirt_rate=self.rate())
        return replace(self, worked=worked)

    def hours(self, part: Part) -> float:
        """Return how long a part has worked, h."""
        return self.worked.get(part, 0.0) / HOUR

    def rate(self) -> float:
        """Return how fast the bin fills, g a second of work; NaN while it is not known.

        It is the mean of this filling and of former ones, which together weigh as an hour of work.
        """
        seconds, former = self.worked.get(Part.BIN, 0.0), self.dirt_rate
        if math.isnan(former):
            return self.in_bin / seconds if seconds >= _LEARNED and self.in_bin > 0.0 else former
        return (self.in_bin + former * _FORMER) / (seconds + _FORMER)


def states_of(wear: Wear, config: UpkeepConfig, bin_capacity: float) -> tuple[PartState, ...]:
    """Return how all parts are; the bin takes ``bin_capacity`` g."""
    lives = {
        Part.BRUSH: config.brush,
        Part.SIDE_BRUSH: config.side_brush,
        Part.FILTER: config.filter,
        Part.SENSORS: config.sensors,
    }
    states = [_state(part, life, life - wear.hours(part), config) for part, life in lives.items()]
    life, left = _bin_hours(wear, config, bin_capacity)
    return (*states, _state(Part.BIN, life, left, config))


def _bin_hours(wear: Wear, config: UpkeepConfig, capacity: float) -> tuple[float, float]:
    """Return how long the bin lasts, and how long it still does, h."""
    rate = wear.rate() * HOUR
    by_time = config.bin - wear.hours(Part.BIN)
    if not rate > 0.0:
        return config.bin, by_time
    return min(config.bin, capacity / rate), min(by_time, (capacity - wear.in_bin) / rate)


def _state(part: Part, life: float, left: float, config: UpkeepConfig) -> PartState:
    left = max(left, 0.0)
    share = min(left / life, 1.0)
    advice = ""
    if left <= 0.0:
        advice = f"{ADVICE[part]}, then reset it"
    elif share <= config.soon:
        advice = f"{ADVICE[part]} soon"
    return PartState(part, life, left, share, advice)
