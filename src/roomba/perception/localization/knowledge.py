"""How well the robot's place is known, and the reason, in words, why not better."""

from __future__ import annotations

from typing import Final, NamedTuple

from roomba.configuration.localization import LocalizationConfig
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.search.relocation import Verdict

_HELP: Final = (
    "carry it to its station, or tell where it is (in RViz: 2D Pose Estimate), "
    "or let it look around (global_localization)"
)


class Searched(NamedTuple):
    """A search of the whole map that is under way."""

    why: str
    seconds: float
    """Time since the search began, or since the robot began to look around."""
    verdict: Verdict
    """Result of the last comparison of all places."""


class Circumstances(NamedTuple):
    """What the knowledge of the place depends on at a moment."""

    deviation: float
    """Standard deviation of the position along its worst direction, m."""
    has_map: bool
    is_lifted: bool
    is_late: bool
    """No scan came for too long."""
    is_blind: bool
    """Nothing is in sight."""
    was_just_told: bool
    is_doubted: bool
    """For a while scans have not fitted the map here."""
    is_awaited: bool
    """A pose that was told was not compared with a scan yet."""
    is_compared: bool
    """A pose fits the scan in part, or was found near by, and is compared with all others."""
    searched: Searched | None


def knowledge_in(now: Circumstances, config: LocalizationConfig) -> tuple[Knowledge, str]:
    """Return how well the place is known, and why not better: in words, with what helps."""
    if now.is_lifted:
        return Knowledge.SEARCHING, "the wheels hang in the air: set the robot down on the floor"
    if now.searched is not None:
        return _searching(now, now.searched, config)
    if now.deviation > config.lost_deviation and not now.was_just_told:
        return Knowledge.LOST, f"{_why_unsure(now)}, for too long; {_HELP}"
    is_sure = now.deviation <= config.known_deviation and not (now.is_compared or now.is_doubted)
    if now.is_late or now.is_blind or not is_sure:
        return Knowledge.ROUGH, f"{_why_unsure(now)}; going by wheels and gyro"
    return Knowledge.KNOWN, ""


def _searching(
    now: Circumstances, searched: Searched, config: LocalizationConfig
) -> tuple[Knowledge, str]:
    why, sees_nothing = searched.why, now.is_late or now.is_blind
    if searched.seconds > config.search_timeout:
        unseen = sees_nothing or searched.verdict is Verdict.SEARCHING
        what = _why_unsure(now) if unseen else searched.verdict.value
        return Knowledge.LOST, f"{why}, and {what}; {_HELP}"
    return Knowledge.SEARCHING, f"{why}; {_why_unsure(now)}" if sees_nothing else why


def _why_unsure(now: Circumstances) -> str:
    if not now.has_map:
        return "there is no map yet"
    if now.is_blind:
        return "the lidar sees next to nothing: it is blocked, or all is out of its reach"
    if now.is_late:
        return "the lidar sends no scans"
    if now.is_awaited:
        return "the pose was told, and no scan has confirmed it yet"
    if now.is_compared:
        return "what is in sight fits the place in part, and it is being compared with all others"
    if now.is_doubted:
        return "what is in sight does not fit the map here: the home changed, or people are about"
    return "what is in sight does not tell the place: a bare corridor, or next to nothing"
