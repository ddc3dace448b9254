"""Whether a robot has a run under way, goes on with it, or is done, by what the robot tells."""

from __future__ import annotations

from typing import Final

from roomba.client.protocol import VacuumSnapshot
from roomba.vocabulary import AT_REST, Phase

_AMID_IT: Final = (
    Phase.UNDOCKING,
    Phase.CLEANING,
    Phase.EXPLORING,
    Phase.CHARGING,
    Phase.BIN_FULL,
)
_HOMEWARD: Final = (Phase.RETURNING, Phase.DOCKING)


def is_running(vacuum: VacuumSnapshot, *, before: bool | None) -> bool | None:
    """Return whether a run is under way; a charge in its middle belongs to it.

    ``before`` is what the look before returned, None if there was none. It is returned again where
    the phase does not tell: a run that met an error may go on, and a bin is emptied amid a run and
    after it.
    """
    if vacuum.state == "error" or vacuum.phase == Phase.EMPTYING:
        return before
    return vacuum.phase not in AT_REST


def goes_on(vacuum: VacuumSnapshot) -> bool:
    """Whether it is amid an errand with which it goes on by itself."""
    if vacuum.phase in (*_HOMEWARD, Phase.EMPTYING):
        return vacuum.seconds_to_go > 0.0
    return vacuum.phase in _AMID_IT


def is_done(vacuum: VacuumSnapshot) -> bool:
    """Whether it is on its way home, and the floor is done."""
    return vacuum.phase in _HOMEWARD and not goes_on(vacuum)
