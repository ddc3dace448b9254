"""How a clean by a robot's own brain ended: the robot does not tell, but can be seen at rest."""

from __future__ import annotations

import math
from typing import Final

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.robot.remote import RemoteState
from roomba.vocabulary import AT_REST, Phase

_ON_THE_FLOOR: Final = "it stands on the floor: it was stopped there, or a spot is clean"


class ErrandEnd:
    """Follows one robot from look to look; ``last`` is how its last clean ended, None before."""

    def __init__(self) -> None:
        """Begin before the first look."""
        self.last: CleanReport | None = None
        self._began: float | None = None
        self._is_first = True

    def look(self, state: RemoteState, now: float) -> None:
        """Take a look at ``now``, s.

        A robot that only goes to its station cleans nothing. One that is not at rest at the first
        look counts as cleaning since then.
        """
        is_first, self._is_first = self._is_first, False
        if state.phase not in AT_REST:
            if self._began is None and (is_first or state.phase is Phase.CLEANING):
                self._began = now
        elif self._began is not None:
            self.last, self._began = _report(state, now - self._began), None


def _report(state: RemoteState, took: float) -> CleanReport:
    """Return how a clean of ``took`` s ended with a robot that rests now."""
    unknown = math.nan
    if state.trouble:
        outcome, message = ErrandOutcome.FAULT, state.trouble
    elif state.phase is Phase.DOCKED:
        outcome, message = ErrandOutcome.COMPLETED, ""
    else:
        outcome, message = ErrandOutcome.STOPPED, _ON_THE_FLOOR
    return CleanReport(outcome, message, unknown, unknown, unknown, unknown, took, unknown)
