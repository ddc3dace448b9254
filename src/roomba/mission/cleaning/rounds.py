"""The rounds of a stage: whether what was missed is worth another one."""

from __future__ import annotations

import math

from roomba.configuration.mission import CleaningConfig


class Rounds:
    """How often the present stage was planned, and what the last plan left, m2.

    A first round plans the whole stage, each later one what was missed. A plan that is made anew,
    since something stands on the path or the path was left early, is no round.
    """

    def __init__(self, config: CleaningConfig) -> None:
        """Begin before the first round."""
        self._config = config
        self._count, self._last_missed = 0, math.inf
        self._is_anew = False
        self._replans, self._replanned_at = 0, -math.inf
        self._cut_offs = self._ways_out = 0

    @property
    def is_first(self) -> bool:
        """Whether the stage was not planned yet."""
        return self._count == 0

    def begin_stage(self, *, is_driven: bool = False) -> None:
        """Begin with another stage, or with the rest of one whose first way through is driven."""
        self._count, self._last_missed = int(is_driven), math.inf

    def begin(self, missed: float) -> None:
        """Count a round, which plans ``missed`` m2."""
        self._count += 1
        self._last_missed = missed

    def take_back(self) -> None:
        """Do not count the round that was begun."""
        self._count, self._last_missed = self._count - 1, math.inf

    def is_over(self, missed: float) -> bool:
        """Whether the last round gained too little for another one, or there were enough."""
        config = self._config
        is_little = self._last_missed - missed < config.little_gain * self._last_missed
        return self._count > config.most_rounds or is_little

    def cut_off(self) -> None:
        """Do not count what was left because no way led there, unless that came too often."""
        self._last_missed = math.inf
        self._cut_offs += 1
        if self._cut_offs <= self._config.most_cut_offs:
            self._count = min(self._count, 1)

    def begin_anew(self) -> None:
        """Do not count the last plan as a round: the next one is made anew."""
        self._count, self._last_missed, self._is_anew = 1, math.inf, True

    def take_anew(self) -> bool:
        """Return whether this plan is made anew; the next one then is not."""
        is_anew, self._is_anew = self._is_anew, False
        return is_anew

    def begin_replan(self, now: float, left: float) -> bool:
        """Count a plan made anew at ``now``, s, of a path with ``left`` m of way to go.

        Returns whether it may be made; if not, it is not counted.
        """
        config = self._config
        if left < config.least_way_to_replan or self._replans >= config.most_replans:
            return False
        if 0.0 <= now - self._replanned_at < config.replan_period:
            return False
        self._replans, self._replanned_at = self._replans + 1, now
        return True

    def count_way_out(self) -> bool:
        """Count a try of a robot that is shut in to get out; return whether it is to be made."""
        self._ways_out += 1
        return self._ways_out <= self._config.most_ways_out
