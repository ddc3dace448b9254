"""How well the pose is known, and the reason that is given: each circumstance by itself."""

from __future__ import annotations

from typing import Any

import pytest
from fixtures.robots.located import CONFIG

from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.knowledge import Circumstances, Searched, knowledge_in
from roomba.perception.localization.search.relocation import Verdict

CONFIGURED = CONFIG.localization
WELL = Circumstances(
    deviation=0.5 * CONFIGURED.known_deviation,
    has_map=True,
    is_lifted=False,
    is_late=False,
    is_blind=False,
    was_just_told=False,
    is_doubted=False,
    is_awaited=False,
    is_compared=False,
    searched=None,
)
ROUGHLY = 0.5 * (CONFIGURED.known_deviation + CONFIGURED.lost_deviation)
ASTRAY = 2.0 * CONFIGURED.lost_deviation
EARLY, LATE = 0.5 * CONFIGURED.search_timeout, 2.0 * CONFIGURED.search_timeout


def test_where_all_is_well_it_is_known_and_nothing_is_said() -> None:
    assert knowledge_in(WELL, CONFIGURED) == (Knowledge.KNOWN, "")


@pytest.mark.parametrize(
    ("changed", "knowledge", "said"),
    [
        ({"is_lifted": True}, Knowledge.SEARCHING, "set the robot down"),
        ({"is_doubted": True}, Knowledge.ROUGH, "does not fit the map here"),
        ({"is_late": True}, Knowledge.ROUGH, "sends no scans; going by wheels and gyro"),
        ({"is_blind": True}, Knowledge.ROUGH, "sees next to nothing"),
        ({"is_compared": True}, Knowledge.ROUGH, "being compared with all others"),
        ({"deviation": ROUGHLY}, Knowledge.ROUGH, "a bare corridor"),
        ({"deviation": ROUGHLY, "is_awaited": True}, Knowledge.ROUGH, "no scan has confirmed"),
        ({"deviation": ROUGHLY, "has_map": False}, Knowledge.ROUGH, "no map yet"),
        ({"deviation": ASTRAY}, Knowledge.LOST, "for too long; carry it to its station"),
        ({"deviation": ASTRAY, "was_just_told": True}, Knowledge.ROUGH, "a bare corridor"),
    ],
)
def test_what_is_wrong_is_said(changed: dict[str, Any], knowledge: Knowledge, said: str) -> None:
    found, reason = knowledge_in(WELL._replace(**changed), CONFIGURED)
    assert found is knowledge
    assert said in reason


@pytest.mark.parametrize(
    ("searched", "changed", "knowledge", "said"),
    [
        (Searched("carried", EARLY, Verdict.NOWHERE), {}, Knowledge.SEARCHING, "carried"),
        (
            Searched("carried", EARLY, Verdict.SEARCHING),
            {"is_blind": True},
            Knowledge.SEARCHING,
            "carried; the lidar sees next to nothing",
        ),
        (
            Searched("carried", LATE, Verdict.AMBIGUOUS),
            {},
            Knowledge.LOST,
            "carried, and several places fit; carry it",
        ),
        (
            Searched("carried", LATE, Verdict.AMBIGUOUS),
            {"is_late": True},
            Knowledge.LOST,
            "carried, and the lidar sends no scans; carry it",
        ),
        (
            Searched("carried", LATE, Verdict.SEARCHING),
            {},
            Knowledge.LOST,
            "carried, and what is in sight does not tell the place",
        ),
    ],
)
def test_a_search_says_why_it_began_and_after_its_time_what_it_came_to(
    searched: Searched, changed: dict[str, Any], knowledge: Knowledge, said: str
) -> None:
    found, reason = knowledge_in(WELL._replace(searched=searched, **changed), CONFIGURED)
    assert found is knowledge
    assert reason.startswith(said)
