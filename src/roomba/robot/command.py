"""The command of a brain to its body."""

from __future__ import annotations

from dataclasses import dataclass

from roomba.geometry import STANDSTILL, Twist


@dataclass(frozen=True, slots=True)
class Command:
    """The twist wanted of the drive, and the duty of fan and brush, 0..1; None: their usual one.

    ``empties``: the station is to take the dirt out of the bin.
    """

    twist: Twist = STANDSTILL
    fan: float | None = None
    brush: float | None = None
    empties: bool = False
