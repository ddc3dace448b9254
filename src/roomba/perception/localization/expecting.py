"""Expectations for a comparison of places: near a pose that was told, or was known."""

from __future__ import annotations

from typing import Final

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.relocation import Expectation

_TOLD_RADIUS: Final = 0.5
_TOLD_TURN: Final = 0.5
_HERE_RADIUS: Final = 0.04
_HERE_TURN: Final = 0.04
"""m, rad; so far around a pose that was told, and one that was known, the robot is expected."""
_HERE_DRIFT: Final = 0.01
"""m and rad, per s of a search: the error of dead reckoning while it looks around."""
_HERE_EVIDENCE: Final = 14.0
"""Evidence, more than believing a place needs: the robot stays unless another place is likelier."""
_STILL_EVIDENCE: Final = 60.0
"""The same of a robot that sees what it saw before: it was not carried."""


def where_told(
    pose: Pose, deviation: tuple[float, float], config: LocalizationConfig
) -> Expectation:
    """Return where to expect a robot that is near a pose, unsure by so much, m and rad."""
    radius = max(_TOLD_RADIUS, 3.0 * deviation[0])
    turn = max(_TOLD_TURN, 3.0 * deviation[1])
    return Expectation(pose, radius, turn, config.needed_evidence + _HERE_EVIDENCE)


def where_known(pose: Pose, config: LocalizationConfig, *, is_still: bool) -> Expectation:
    """Return where to expect a robot that was there; ``is_still``: it was not carried."""
    evidence = _STILL_EVIDENCE if is_still else _HERE_EVIDENCE
    return Expectation(pose, _HERE_RADIUS, _HERE_TURN, config.needed_evidence + evidence)


def searched_for(expectation: Expectation, here: Pose, seconds: float) -> Expectation:
    """Return the same after a search of so many s, in which dead reckoning led to a pose."""
    return expectation.drifted(here, _HERE_DRIFT * seconds)
