"""Where the time of a clean went, as missions count it, and programs and people are told it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final


@dataclass(frozen=True, slots=True)
class TimeSpent:
    """The parts of a clean's time, s of robot time; all but ``least`` add up to its duration.

    ``least`` is the time that no robot of this tool width and speed can undercut: the area that
    became clean, times the passes asked for, divided by tool width and top speed while cleaning.
    """

    least: float = 0.0
    straight: float = 0.0
    """First rounds: the time that their way takes at top speed."""
    slowed: float = 0.0
    """First rounds: the time lost by going slower, before and after corners."""
    turning: float = 0.0
    """First rounds: turning on the spot."""
    again: float = 0.0
    """Later rounds, for floor that was missed, or is so dirty that it is cleaned once more."""
    station: float = 0.0
    """Driving to the station, onto it, and off it."""
    charging: float = 0.0
    waiting: float = 0.0
    """Standing: paused, held, in need of help, or until a way opens."""

    @property
    def beside(self) -> float:
        """First rounds: ways over floor that is clean already, s at top speed."""
        return max(self.straight - self.least, 0.0)

    @property
    def under_way(self) -> float:
        """All time but charging and waiting, s."""
        return self.straight + self.slowed + self.turning + self.again + self.station

    @property
    def times_least(self) -> float | None:
        """The time under way divided by ``least``; None if either is 0 or not known."""
        is_known = self.least > 0.0 and self.under_way > 0.0
        return self.under_way / self.least if is_known else None

    @property
    def parts(self) -> tuple[tuple[str, float], ...]:
        """What the time went into: words and s of each; first comes sweeping at full speed."""
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
"""The value of a clean whose time is not known."""
NAMES: Final = tuple(each.name for each in fields(TimeSpent))
"""The names of the fields, in their order."""


def square_metres_a_minute(covered: float, duration: float) -> float | None:
    """Return m2 per minute of ``covered`` m2 in ``duration`` s; None where no time passed."""
    return 60.0 * covered / duration if duration > 0.0 and covered >= 0.0 else None
