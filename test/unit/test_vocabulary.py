"""What a name may be made of, and the words for what a robot does."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.vocabulary import (
    AT_REST,
    HELD,
    NO_REASON,
    EdgeReason,
    Hindrance,
    Phase,
    Reason,
    cleaned_name,
    fault_of_name,
    places_told,
    word_of,
)

JOINERS = ("\u200c", "\u200d")
LETTERS = st.characters(categories=("L", "M", "N", "P", "S"))
WORDS = st.text(LETTERS, min_size=1, max_size=30)


@pytest.mark.parametrize("name", ["Küche", "می‌خواهم", "👩‍👩‍👧‍👦", "👩‍👧 and 👨‍👦", "a b"])
def test_names_that_people_write_are_names(name: str) -> None:
    assert fault_of_name(name) == ""


@given(WORDS, st.sampled_from(JOINERS), WORDS)
def test_a_joiner_stands_between_two_characters(one: str, joiner: str, other: str) -> None:
    assert fault_of_name(f"{one}{joiner}{other}") == ""
    for wrong in (joiner, f"{joiner}{one}", f"{one}{joiner}", f"{one}{2 * joiner}{other}"):
        assert "printable" in fault_of_name(wrong)
    for wrong in (f"{one}{joiner} {other}", f"{one} {joiner}{other}"):
        assert "printable" in fault_of_name(wrong)


@given(WORDS, st.characters(categories=("C", "Z"), exclude_characters=" \u200c\u200d"), WORDS)
def test_what_is_invisible_or_turns_the_text_is_in_no_name(
    one: str, letter: str, other: str
) -> None:
    assert "printable" in fault_of_name(f"{one}{letter}{other}")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Kids\u00a0room", "Kids room"),
        (" Kids\t\r\n room\u2028", "Kids room"),
        ("Kü\u202eche\x00\ud800", "Küche"),
        ("👨\u200d👩\u200d👧 Zimmer", "👨\u200d👩\u200d👧 Zimmer"),
        ("a\u200d \u200db", "a b"),
        ("a" * 5000, "a" * 80),
        (f"{'a' * 79} b", "a" * 79),
        (" \u200b\u200d\n", ""),
    ],
)
def test_a_name_of_another_program_is_made_one(text: str, name: str) -> None:
    assert cleaned_name(text) == name


@given(st.text())
def test_what_is_left_of_any_text_is_a_name_and_stays_one(text: str) -> None:
    name = cleaned_name(text)
    assert not name or fault_of_name(name) == ""
    assert cleaned_name(name) == name


def test_one_place_is_no_places() -> None:
    assert [places_told(count) for count in (0, 1, 2)] == ["0 places", "1 place", "2 places"]


@pytest.mark.parametrize("phase", Phase)
def test_a_phase_is_found_by_its_word_as_programs_hear_it(phase: Phase) -> None:
    word = json.loads(json.dumps(phase.value))
    assert type(word) is str
    assert phase == word
    assert word in frozenset(Phase)
    assert (word in AT_REST) == (word in ("docked", "idle"))
    assert (word in HELD) == (word in ("paused", "error"))


def test_a_word_that_is_no_phase_is_in_no_group_of_them() -> None:
    assert "starting" not in frozenset(Phase)
    assert "starting" not in AT_REST | HELD


def test_what_programs_decide_by_is_no_sentence() -> None:
    assert json.dumps(Hindrance.NO_WAY) == '"no way"'
    assert word_of(EdgeReason.NOT_LOOKED_AT) == "not looked at"


def test_a_reason_is_one_if_it_says_something() -> None:
    assert Reason("it is stuck")
    assert not NO_REASON
