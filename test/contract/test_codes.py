"""The numbers in messages mean what the library's enums do, one for each member."""

from __future__ import annotations

from enum import Enum

import pytest
from roomba_robot.msg import (
    CleanGoal,
    CleanResult,
    Localization,
    MissedArea,
    OpenEdge,
    VacuumState,
    Zone,
)

from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.rooms.zones import ZoneKind
from roomba.vocabulary import (
    CarpetWay,
    CleanMode,
    EdgeOrder,
    EdgeReason,
    FanLevel,
    Hindrance,
    Phase,
)
from roomba_ros.convert.clean_action import (
    CARPETS,
    EDGE_REASONS,
    EDGES,
    FANS,
    HINDRANCES,
    MODES,
    OUTCOMES,
    REASONS,
)
from roomba_ros.convert.localization import STATES
from roomba_ros.convert.rooms import KINDS


def constants(message: type, names: set[str]) -> dict[str, int]:
    """Return a message's constants; ``names`` are those of the enum that they should be."""
    found = {
        name: value
        for name, value in vars(message).items()
        if name.isupper() and isinstance(value, int)
    }
    return {name: value for name, value in found.items() if name in names}


@pytest.mark.parametrize(
    ("message", "members", "used"),
    [
        (CleanGoal, CleanMode, {mode.name: code for code, mode in MODES.items()}),
        (CleanGoal, FanLevel, {level.name: code for code, level in FANS.items()}),
        (CleanResult, CleanOutcome, {outcome.name: code for outcome, code in OUTCOMES.items()}),
        (MissedArea, MissReason, {reason.name: code for reason, code in REASONS.items()}),
        (OpenEdge, EdgeReason, {reason.name: code for code, reason in EDGE_REASONS.items()}),
        (
            VacuumState,
            Hindrance,
            {hindrance.name: code for code, hindrance in HINDRANCES.items()},
        ),
        (Zone, ZoneKind, {kind.name: code for code, kind in KINDS.items()}),
        (Localization, Knowledge, {knowledge.name: code for knowledge, code in STATES.items()}),
    ],
)
def test_every_member_has_its_code(
    message: type, members: type[Enum], used: dict[str, int]
) -> None:
    names = {member.name for member in members}
    assert used == constants(message, names)
    assert set(used) == names
    assert sorted(used.values()) == list(range(len(names)))


@pytest.mark.parametrize(
    ("what", "members", "codes"), [("CARPETS_", CarpetWay, CARPETS), ("EDGES_", EdgeOrder, EDGES)]
)
def test_every_way_of_carpets_and_edges_has_its_code(
    what: str, members: type[Enum], codes: dict[int, Enum]
) -> None:
    assert set(codes.values()) == set(members)
    assert {what + way.name: code for code, way in codes.items()} == constants(
        CleanGoal, {what + way.name for way in members}
    )


def test_the_constants_are_those_of_the_enums_and_no_others() -> None:
    of_goal = {member.name for members in (CleanMode, FanLevel) for member in members}
    of_goal |= {f"CARPETS_{way.name}" for way in CarpetWay}
    of_goal |= {f"EDGES_{order.name}" for order in EdgeOrder}
    for message, names in (
        (CleanGoal, of_goal),
        (CleanResult, {outcome.name for outcome in CleanOutcome}),
        (MissedArea, {reason.name for reason in MissReason}),
        (OpenEdge, {reason.name for reason in EdgeReason}),
        (VacuumState, {hindrance.name for hindrance in Hindrance}),
        (Zone, {kind.name for kind in ZoneKind}),
    ):
        known = {name for name, value in vars(message).items() if name.isupper()}
        assert known == names, message


def test_every_phase_has_a_word_that_smart_homes_know() -> None:
    words = {"cleaning", "docked", "paused", "idle", "returning", "error"}
    assert set(VACUUM_STATES) == set(Phase)
    assert set(VACUUM_STATES.values()) == words
