"""What the page says of a state, word by word."""

from __future__ import annotations

from typing import Any

import pytest
from web.conftest import SIZES, Opened

from roomba.vocabulary import Hindrance

SAY = """async ([name, ...given]) => (await import("/words.js"))[name](...given)"""
FAIL = """async (last) => {
    const { get, set } = await import("/store.js"), state = get("state");
    set("state", { ...state, last });
    return document.getElementById("explanation").textContent;
}"""
SAY_BIN = """async (told) => {
    const { get, set } = await import("/store.js"), state = get("state");
    set("state", { ...state, vacuum: { ...state.vacuum, ...told } });
    return !document.getElementById("bin").hidden;
}"""
"""Tells whether “Bin emptied” is offered while the robot says so."""
PHONE = pytest.mark.parametrize("size", [SIZES["phone"]])


def state(phase: str, speed: float = 0.0, **vacuum: Any) -> dict[str, Any]:
    said = {
        "message": "",
        "hindrance": "",
        "room": "hall",
        "phase": phase,
        "state": phase,
        "seconds_to_go": 0,
    }
    return {"speed": speed, "doubt": "", "vacuum": {**said, "queue": [], **vacuum}}


@PHONE
def test_the_headline_says_what_it_does(opened: Opened) -> None:
    def headline(told: dict[str, Any]) -> str:
        return str(opened.page.evaluate(SAY, ["headline", "live", told]))

    assert headline(state("paused")) == "Paused · Hall"
    assert headline(state("paused", 0.3)) == "On its way · Hall"
    assert headline(state("cleaning", 0.3)) == "Cleaning · Hall"
    assert headline(state("cleaning", 0.3, queue=["hall", "bath"])) == "Cleaning · Hall"
    assert headline(state("cleaning", 0.3, queue=["bath"])) == "On its way to Bath"
    # What changes each second is told beside it: screen readers would tell it as often.
    told = state("cleaning", 0.3, seconds_to_go=50)
    assert headline(told) == "Cleaning · Hall"
    assert opened.page.evaluate(SAY, ["toGo", "live", told]) == " · 50 s to go"
    assert opened.page.evaluate(SAY, ["toGo", "gone", told]) == ""


@PHONE
@pytest.mark.parametrize(
    ("hindrance", "said"),
    [
        (Hindrance.UNREACHABLE, "Cannot reach the robot"),
        (Hindrance.SENSOR_SILENT, "The robot stands: a sensor is silent"),
        (Hindrance.DISOBEYS, "The robot does not obey"),
    ],
)
def test_trouble_of_a_line_is_the_headline(opened: Opened, hindrance: Hindrance, said: str) -> None:
    told = state("cleaning", 0.3, message="in any words", hindrance=hindrance.value)
    assert opened.page.evaluate(SAY, ["headline", "live", told]) == said
    assert opened.page.evaluate(SAY, ["explanation", "live", told]) == "In any words."


@PHONE
@pytest.mark.parametrize(
    ("phase", "said"),
    [("returning", "No way home."), ("cleaning", "No way leads on.")],
)
def test_a_robot_that_waits_says_when_it_looks_again(opened: Opened, phase: str, said: str) -> None:
    hindered: dict[str, Any] = {"message": "in any words", "hindrance": Hindrance.NO_WAY.value}
    told = state(phase, **hindered, looks_within=30.0)
    assert opened.page.evaluate(SAY, ["headline", "live", told]) == (
        "Waiting for a way to open · Hall"
    )
    assert opened.page.evaluate(SAY, ["explanation", "live", told]) == (
        f"{said} It looks again within 30 s. Open a door or clear the way, and it goes on."
    )
    # A run that is looked back at does not tell when.
    recorded = state(phase, **hindered)
    assert opened.page.evaluate(SAY, ["explanation", "live", recorded]) == (
        f"{said} Open a door or clear the way, and it goes on."
    )


@PHONE
def test_what_the_robot_says_without_a_word_for_programs_is_shown_as_it_is(opened: Opened) -> None:
    message = "bin full; it waits for a way to open, and the robot does not obey"
    for hindrance in ("", "of a newer robot", None):
        told = state("cleaning", 0.3, message=message, hindrance=hindrance)
        assert opened.page.evaluate(SAY, ["headline", "live", told]) == "Cleaning · Hall"
        assert opened.page.evaluate(SAY, ["explanation", "live", told]) == f"B{message[1:]}."


@PHONE
@pytest.mark.parametrize(
    ("message", "hindrance", "is_offered"),
    [
        ("both rooms are combined", "", False),
        ("in any words", Hindrance.BIN_FULL.value, True),
        ("in any words", Hindrance.NOT_EMPTIED.value, True),
    ],
)
def test_a_bin_is_said_to_be_emptied_only_where_that_helps(
    opened: Opened, message: str, hindrance: str, is_offered: bool
) -> None:
    assert opened.page.evaluate(SAY_BIN, {"message": message, "hindrance": hindrance}) is is_offered


@PHONE
def test_a_clean_that_achieved_nothing_is_told_with_its_reason(opened: Opened) -> None:
    report = {
        "outcome": "completed", "message": "", "covered": 0.0, "wanted": 12.0, "duration": 60.0,
        "dirt": 0.0, "rate": 0.0, "times": [], "times_least": 0.0, "rooms": [],
        "missed": [
            {"area": 12.0, "x": 1.0, "y": 1.0, "room": "bath", "reason": "shut up", "code": "shut"}
        ],
    }  # fmt: skip
    helps = "Open it or clear the way, then clean there again."
    assert opened.page.evaluate(FAIL, report) == f"Nothing was cleaned: shut up. {helps}"
    for other in ({"outcome": "stopped"}, {"covered": 6.0}, {"wanted": 0.0}):
        assert opened.page.evaluate(FAIL, {**report, **other}) == ""


@PHONE
def test_a_run_that_fell_short_is_told_until_the_next_one_begins(opened: Opened) -> None:
    missed = [
        {"area": area, "x": 1.0, "y": 1.0, "room": room, "reason": reason, "code": code}
        for area, room, reason, code in (
            (12.0, "bath", "no way leads there: a door is shut", "shut"),
            (9.0, "hall", "no way leads there: a door is shut", "shut"),
            (1.0, "kitchen", "it was passed, but not all of it was met", "left over"),
        )
    ]
    report = {
        "outcome": "completed", "message": "not clean: 12.0 m² of bath (no way leads there: …)",
        "covered": 28.5, "wanted": 57.4, "duration": 60.0, "dirt": 0.0, "rate": 0.0, "times": [],
        "times_least": 0.0, "rooms": [], "missed": missed,
    }  # fmt: skip

    def told(**others: Any) -> str:
        return str(opened.page.evaluate(FAIL, {**report, **others}))

    assert told() == (
        "Last run: 28.5 of 57.4 m² clean. Bath, Hall: no way leads there: a door is shut. "
        "Open it or clear the way, then clean there again."
    )
    # Of an older run nothing is known but the sentence.
    older = [{**miss, "code": ""} for miss in missed]
    assert told(missed=older) == (
        "Last run: 28.5 of 57.4 m² clean. Bath, Hall: no way leads there: a door is shut."
    )
    # What the robot finds not worth a word, and what was wished for, is none here.
    assert told(message="") == told(outcome="stopped") == ""
    assert told(outcome="fault", message="emergency stop: the button", missed=[]) == (
        "Last run: ended early, 28.5 of 57.4 m² clean. Emergency stop: the button."
    )
    interrupted = told(
        outcome="interrupted", missed=[],
        message="the program that kept this run ended in the middle of it",
    )  # fmt: skip
    assert interrupted == (
        "Last run: interrupted, 28.5 of 57.4 m² clean. The program that kept this run ended in "
        "the middle of it. Clean again what is left."
    )
    opened.page.get_by_role("button", name="Clean all").click()
    opened.wait_for_phase("cleaning")
    assert opened.page.evaluate(FAIL, report) == ""
