"""The command line of a Neato, as people and programs type it."""

from __future__ import annotations

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.grammars import GRAMMARS as OF_MODELS
from roomba.emulators.neato.words import CommandError, understood

GRAMMARS = OF_MODELS[Model.BOTVAC]


@pytest.mark.parametrize(
    "line",
    [
        "SetMotor LWheelDist 100 RWheelDist -50 Speed 200",
        "setmotor lwheeldist 100 rwheeldist -50 speed 200",
        "SetMotor 100 -50 200",
        "SetMotor Speed 200 RWheelDist -50 LWheelDist 100",
        "SetMotor LWheelDist 100 RWheelDist -50 Sp 200",
    ],
)
def test_values_have_names_or_an_order(line: str) -> None:
    words = understood(line, GRAMMARS)
    assert words.name == "SetMotor"
    assert words.values == {"LWheelDist": 100, "RWheelDist": -50, "Speed": 200}


@pytest.mark.parametrize(
    ("line", "name"),
    [("getmot", "GetMotors"), ("GETLDS", "GetLDSScan"), ("testm on", "TestMode")],
)
def test_words_may_be_cut_while_they_are_unique(line: str, name: str) -> None:
    assert understood(line, GRAMMARS).name == name


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("Get", "Ambiguous: 'Get'"),
        ("SetMotor LWheelDi 100", "Ambiguous: 'LWheelDi'"),
        ("Dance", "Unknown Cmd: 'Dance'"),
        (" GetMotors", "Unknown Cmd: 'GetMotors'"),
        ("", "Unknown Cmd"),
        ("SetMotor Speed", "Missing or invalid value of 'Speed'"),
        ("SetMotor Speed fast", "Missing or invalid value of 'Speed'"),
        ("TestMode Perhaps", "Unrecognized Option: 'Perhaps'"),
        ("GetMotors 5", "Unrecognized Option: '5'"),
    ],
)
def test_what_it_does_not_know_it_says(line: str, reason: str) -> None:
    with pytest.raises(CommandError, match=reason):
        understood(line, GRAMMARS)


@given(st.text(max_size=60))
def test_any_line_is_understood_or_refused(line: str) -> None:
    names = {grammar.name for grammar in GRAMMARS}
    with contextlib.suppress(CommandError):
        assert understood(line, GRAMMARS).name in names
