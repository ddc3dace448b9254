"""Where the time of a clean went, as missions count it, and programs and people are told it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final


@dataclass(frozen=True, slots=True)
class TimeSpent:
    """s of the robot's clock; all but ``least`` add up to the time that the clean took.

    ``least`` is what no robot of this width can undercut at this speed: the area that became clean,
    as often as it was asked for, by tool width and top speed while it cleans.
    """

    least: float = 0.0
    straight: float = 0.0
    """First rounds: what their way takes at top speed."""
    slowed: float = 0.0
    """First rounds: what is lost by going slower, before and after corners."""
    turning: float = 0.0
    """First rounds: turning on the spot."""
    again: float = 0.0
    """Later rounds, for what was missed, and for floor that is so dirty that it gets another."""
    station: float = 0.0
    """To the station, onto it, and off it."""
    charging: float = 0.0
    waiting: float = 0.0
    """Standing: paused, held, in need of help, or until a way opens."""

    @property
    def beside(self) -> float:
        """Ways of first rounds over floor that is clean already, s at top speed."""
        return max(self.straight - self.least, 0.0)

    @property
    def under_way(self) -> float:
        """All but charging and waiting, s."""
        return self.straight + self.slowed + self.turning + self.again + self.station

    @property
    def times_least(self) -> float | None:
        """The time under way by the least; None where nothing became clean, or it is not known."""
        is_known = self.least > 0.0 and self.under_way > 0.0
        return self.under_way / self.least if is_known else None

    @property
    def parts(self) -> tuple[tuple[str, float], ...]:
        """What it went into, in words, with s; the first one is the least, if that is known."""
        return (
            ("sweeping at full speed", min(self.least, self.straight)),
            ("ways, and floor passed twice", self.beside),
            ("slower for corners", self.slowed),
            ("turning on the spot", self.turning),
            ("second rounds", self.again),
            ("to and from the station", self.station),
            ("charging", self.charging),
            ("waiting", self.waiting),
        )


NOT_COUNTED: Final = TimeSpent()
"""Of what no time is known."""
NAMES: Final = tuple(each.name for each in fields(TimeSpent))
"""Of the numbers, in their order."""


def square_metres_a_minute(covered: float, duration: float) -> float | None:
    """Return how much floor became clean in a minute, of m2 and s; None where no time passed."""
    return 60.0 * covered / duration if duration > 0.0 and covered >= 0.0 else None
