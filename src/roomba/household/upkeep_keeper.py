"""The upkeep of one robot: its work is counted from look to look, and kept."""

from __future__ import annotations

import math
import threading
from typing import Final

from pydantic import Field

from roomba.client.observed import ObservedRobot
from roomba.client.view import RobotView
from roomba.configuration.frozen import Frozen, NotNegative
from roomba.configuration.household import UpkeepConfig
from roomba.household.folder import KeptValues
from roomba.upkeep.parts import Part, PartState, Wear, states_of
from roomba.vocabulary import Phase

WORKS: Final = (Phase.CLEANING,)
"""Phases in which brush and fan are on."""
_LONGEST_LOOK: Final = 600.0
"""s of the robot's clock; two looks farther apart than this are not one stretch of work."""
_WRITE_EVERY: Final = 120.0
"""s of work that a program that is killed forgets at most."""


class KeptWear(Frozen):
    """The wear as it is kept: s, g, g/s."""

    worked: dict[Part, NotNegative] = Field(default={})
    in_bin: NotNegative = 0.0
    dirt_rate: NotNegative | None = None

    def wear(self) -> Wear:
        """Return the values as a :class:`roomba.upkeep.parts.Wear`."""
        return Wear(
            self.worked, self.in_bin, math.nan if self.dirt_rate is None else self.dirt_rate
        )

    @staticmethod
    def of(wear: Wear) -> KeptWear:
        """Return a wear to keep."""
        rate = None if math.isnan(wear.dirt_rate) else wear.dirt_rate
        return KeptWear(worked=dict(wear.worked), in_bin=wear.in_bin, dirt_rate=rate)


class UpkeepKeeper:
    """Counts how long parts work; may be used from any thread."""

    def __init__(
        self, robot: ObservedRobot, kept: KeptValues, config: UpkeepConfig, bin_capacity: float
    ) -> None:
        """Read what was kept; ``bin_capacity`` in g."""
        self._robot, self._kept, self._config = robot, kept, config
        self._capacity = bin_capacity
        self._lock = threading.Lock()
        self._wear = kept.read(KeptWear()).wear()
        self._before: RobotView | None = None
        self._unwritten = 0.0

    def look(self, view: RobotView) -> None:
        """Count the work since the last look; raises OSError when the disk refuses."""
        with self._lock:
            work = 0.0 if self._before is None else work_between(self._before, view)
            ends = work == 0.0 and self._unwritten > 0.0
            in_bin = max(view.dirt, 0.0) if math.isfinite(view.dirt) else self._wear.in_bin
            self._before = view
            self._wear = self._wear.after(work, in_bin)
            self._unwritten += work
            if ends or self._unwritten >= _WRITE_EVERY:
                self._write()

    def states(self) -> tuple[PartState, ...]:
        """Return how the parts are, at once: a writer is not waited for."""
        return states_of(self._wear, self._config, self._capacity)

    def reset(self, part: Part) -> None:
        """Let a part count as new; raises RequestRefusedError, OSError."""
        if part is Part.BIN:
            self._robot.empty_bin()
        with self._lock:
            self._wear = self._wear.reset(part)
            self._write()

    def end(self) -> None:
        """Write what is not written yet; raises OSError when the disk refuses."""
        with self._lock:
            if self._unwritten > 0.0:
                self._write()

    def _write(self) -> None:
        self._kept.write(KeptWear.of(self._wear))
        self._unwritten = 0.0


def work_between(before: RobotView, after: RobotView) -> float:
    """Return for how long the robot worked between two looks, s of its clock."""
    passed = after.time - before.time
    is_work = before.vacuum.phase in WORKS and after.vacuum.phase in WORKS
    return passed if is_work and 0.0 < passed <= _LONGEST_LOOK else 0.0
