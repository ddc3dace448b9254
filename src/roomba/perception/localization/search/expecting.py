"""Expectations for a comparison of places: near a pose that was reported, or was known."""

from __future__ import annotations

from roomba.configuration.localization import LocalizationConfig
from roomba.geometry import Pose
from roomba.perception.localization.search.relocation import Expectation


def where_told(
    pose: Pose, deviation: tuple[float, float], config: LocalizationConfig
) -> Expectation:
    """Return where to expect a robot that was reported at a pose, with deviations, m and rad."""
    told = config.expecting
    radius = max(told.told_radius, 3.0 * deviation[0])
    turn = max(told.told_turn, 3.0 * deviation[1])
    return Expectation(pose, radius, turn, config.needed_evidence + told.here_evidence)


def where_known(pose: Pose, config: LocalizationConfig, *, is_still: bool) -> Expectation:
    """Return where to expect a robot that was known to be at a pose; ``is_still``: not carried."""
    here = config.expecting
    evidence = config.needed_evidence + (here.still_evidence if is_still else here.here_evidence)
    return Expectation(pose, here.here_radius, here.here_turn, evidence)


def where_found_near(pose: Pose, config: LocalizationConfig) -> Expectation:
    """Return where to expect a robot whose scan fits best at ``pose``, of all places near by.

    The robot may have been carried farther. So the pose has no evidence of its own beyond what is
    needed to tell places apart.
    """
    here = config.expecting
    return Expectation(pose, here.here_radius, here.here_turn, config.needed_evidence)


def searched_for(
    expectation: Expectation, here: Pose, seconds: float, config: LocalizationConfig
) -> Expectation:
    """Return an expectation after ``seconds`` of search, in which dead reckoning led ``here``."""
    return expectation.drifted(here, config.expecting.drift * seconds)
