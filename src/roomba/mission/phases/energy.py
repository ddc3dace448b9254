"""Energy, distance and dirt of an errand, when it is time to go home, and what charges bring."""

from __future__ import annotations

import math
from collections.abc import Callable

from roomba.clock import is_recent
from roomba.configuration.mission import EnergyConfig
from roomba.mission.inputs.senses import Battery, Senses
from roomba.perception.swept.coverage_kernels import LONGEST_STEP


class ChargeGains:
    """What each charge of the battery brought a job."""

    def __init__(self, config: EnergyConfig) -> None:
        """Begin before the first charge."""
        self._config = config
        self._reached: tuple[float, ...] = ()
        self._in_vain = 0

    def note_charge(self, *reached: float) -> bool:
        """Note what a job reached before it charges, m2; by progress one of the values grows.

        Return whether too many charges in a row brought nothing.
        """
        gains = [now - before for now, before in zip(reached, self._reached, strict=False)]
        is_vain = bool(gains) and max(gains) < self._config.least_gain
        self._in_vain = self._in_vain + 1 if is_vain else 0
        self._reached = reached
        return self._in_vain >= self._config.most_in_vain


class EnergyLedger:
    """Ticked with what is sensed; ``distance`` m, ``energy`` Wh and ``dirt`` g since the begin.

    ``driven`` m and ``used`` Wh are the parts of distance and energy while the robot drove: it uses
    energy while it stands as well, which says nothing of what a metre takes. No way home is longer
    than ``longest_way_home``, m.
    """

    def __init__(self, config: EnergyConfig, senses: Senses) -> None:
        """Begin to count."""
        self._config = config
        self.longest_way_home = 0.0
        self.begin(senses)

    def begin(self, senses: Senses) -> None:
        """Count anew."""
        self.distance = self.energy = self.dirt = self.driven = self.used = 0.0
        self._last, self._checked = senses, senses.now

    def note(self, senses: Senses, way: float | None = None, *, drives: bool = True) -> None:
        """Take what was sensed; ``way``, m, if it was more than the straight one.

        ``drives``: since the last time it was on its way, and did not just stand.
        """
        last, self._last = self._last, senses
        if way is None:
            straight = senses.pose.distance_to(last.pose.x, last.pose.y)
            way = straight if straight < LONGEST_STEP else 0.0
        energy = max(0.0, last.battery.energy - senses.battery.energy)
        self.distance += way
        self.energy += energy
        self.dirt += max(0.0, senses.in_bin - last.in_bin)
        if drives:
            self.driven += way
            self.used += energy

    @property
    def per_metre(self) -> float:
        """What a metre of way takes, Wh, as seen on this errand while it drove."""
        if self.driven < self._config.measured_after:
            return self._config.per_metre
        return max(self.used / self.driven, 0.2 * self._config.per_metre)

    def next_check(self, senses: Senses) -> float:
        """Return when the way home is checked again, s; infinite while the charge is ample.

        It is ample down to :meth:`least_ample`.
        """
        return self._checked + self._config.check_period if self._is_low(senses) else math.inf

    def least_ample(self, senses: Senses) -> float:
        """Return the level, 0..1, down to which the charge needs no decision.

        While the charge is ample, that is where it stops being so; later it is where the battery
        counts as empty.
        """
        if self._is_low(senses):
            return self.empty
        return self._ample(senses.battery) / senses.battery.capacity

    @property
    def empty(self) -> float:
        """The level, 0..1, below which the battery counts as empty."""
        return self._config.empty

    def _is_low(self, senses: Senses) -> bool:
        """Whether the way home may take what is left."""
        return senses.battery.energy <= self._ample(senses.battery)

    def _ample(self, battery: Battery) -> float:
        """Return an energy, Wh, that is enough for any way home, by what a metre takes so far."""
        per_metre = max(self._config.per_metre, self.per_metre)
        longest = self._config.margin * per_metre * self.longest_way_home
        reserve = self._config.reserve * battery.capacity
        return reserve + max(self._config.ample * battery.capacity, longest)

    def must_go_home(self, senses: Senses, way_home: Callable[[Senses], float]) -> bool:
        """Whether what is left just suffices for the way home; ``way_home`` tells that way, m."""
        # The way home is planned only when the charge may be too low for it.
        if not self._is_low(senses):
            return False
        if is_recent(senses.now, self._checked, self._config.check_period):
            return False
        self._checked = senses.now
        battery = senses.battery
        spare = battery.energy - self._config.reserve * battery.capacity
        return spare < self._config.margin * self.per_metre * way_home(senses)

    def is_empty(self, senses: Senses) -> bool:
        """Whether the battery is empty."""
        return senses.battery.level < self._config.empty

    def is_charged(self, senses: Senses, needed: float) -> bool:
        """Whether it is charged enough to go on, with ``needed`` Wh still to be used."""
        battery = senses.battery
        if battery.level >= self._config.full_enough:
            return True
        return battery.energy > self._enough(battery, needed)

    def charged_at(self, senses: Senses, needed: float) -> float:
        """Return with which energy, Wh, :meth:`is_charged` becomes true."""
        full = self._config.full_enough * senses.battery.capacity
        return min(full, self._enough(senses.battery, needed))

    def _enough(self, battery: Battery, needed: float) -> float:
        return self._config.margin * needed + 2.0 * self._config.reserve * battery.capacity
