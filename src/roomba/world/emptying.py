"""A charging station that empties the robot's bin into a bag: how long, how loud, how much."""

from __future__ import annotations

import math

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.simulation import SimulatedStation


class EmptyingStation:
    """``in_bag`` is what its bag holds, g; it works while a docked robot wants it to.

    With a full bag the station does not begin. What the bag has no room for stays in the bin.
    """

    def __init__(self, config: SimulatedStation) -> None:
        """Begin with an empty bag."""
        self._config = config
        self.in_bag = 0.0
        self.is_wanted = False
        self._left: float | None = None
        self._is_done = False

    @property
    def is_at_work(self) -> bool:
        """Whether it takes dirt out now, which is loud."""
        return self._left is not None

    @property
    def bag(self) -> float:
        """How full its bag is, 0..1."""
        return min(self.in_bag / self._config.bag, 1.0)

    def replace_bag(self) -> None:
        """Put an empty bag in."""
        self.in_bag = 0.0

    def save(self) -> Floats:
        """Return all that can change, float64 [4], as :meth:`restore` takes it."""
        left = math.nan if self._left is None else self._left
        return np.array([self.in_bag, self.is_wanted, left, self._is_done], np.float64)

    def restore(self, saved: Floats) -> None:
        """Bring back what :meth:`save` returned."""
        self.in_bag, is_wanted, left, is_done = saved.tolist()
        self.is_wanted, self._is_done = is_wanted > 0.0, is_done > 0.0
        self._left = None if math.isnan(left) else left

    def pass_time(self, seconds: float, in_bin: float, *, is_docked: bool) -> float:
        """Let time pass; return what was taken out of the bin, in which is ``in_bin`` g.

        The dirt is taken out at the end; a robot that leaves before then keeps it.
        """
        if not (self.is_wanted and is_docked):
            self._left, self._is_done = None, False
            return 0.0
        if self._is_done or (self._left is None and self.bag >= 1.0):
            return 0.0
        left = self._config.emptying_time if self._left is None else self._left
        self._left = left - seconds
        if self._left > 0.0:
            return 0.0
        self._left, self._is_done = None, True
        taken = min(in_bin, max(self._config.bag - self.in_bag, 0.0))
        self.in_bag += taken
        return taken
