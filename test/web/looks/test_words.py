"""What the page says of a state, word by word."""

from __future__ import annotations

from typing import Any

import pytest
from web.conftest import SIZES, Opened

from roomba.drivers.create2.obedience import DisobeyedError
from roomba.drivers.line import LineError
from roomba.drivers.neato.questions import UntoldError

SAY = """async ([name, ...given]) => (await import("/words.js"))[name](...given)"""
FAIL = """async (last) => {
    const { get, set } = await import("/store.js"), state = get("state");
    set("state", { ...state, last });
    return document.getElementById("explanation").textContent;
}"""
PHONE = pytest.mark.parametrize("size", [SIZES["phone"]])


def state(phase: str, speed: float = 0.0, **vacuum: Any) -> dict[str, Any]:
    said = {"message": "", "room": "hall", "phase": phase, "state": phase, "seconds_to_go": 0}
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
    ("error", "said"),
    [
        (LineError, "Cannot reach the robot"),
        (UntoldError, "The robot stands: a sensor is silent"),
        (DisobeyedError, "The robot does not obey"),
    ],
)
def test_trouble_of_a_line_is_the_headline(
    opened: Opened, error: type[LineError], said: str
) -> None:
    told = state("cleaning", 0.3, message=f"{error.trouble}: expected an answer")
    assert opened.page.evaluate(SAY, ["headline", "live", told]) == said
    doubted = {**state("cleaning", 0.3), "doubt": told["vacuum"]["message"]}
    assert opened.page.evaluate(SAY, ["headline", "live", doubted]) == said


@PHONE
@pytest.mark.parametrize(
    ("why", "said"),
    [
        ("no way home: (0.65, -0.00) cannot be reached: no way leads there", "No way home."),
        ("no way leads on from (6.22, 5.80): no way leads there", "No way leads on."),
        ("no way leads out of where it is", "No way leads out of where it is."),
    ],
)
def test_a_robot_that_waits_says_when_it_looks_again(opened: Opened, why: str, said: str) -> None:
    ends = "it waits for a way to open, and looks again within 30 s"
    told = state("returning", message=f"{why}; {ends}")
    assert opened.page.evaluate(SAY, ["headline", "live", told]) == (
        "Waiting for a way to open · Hall"
    )
    assert opened.page.evaluate(SAY, ["explanation", "live", told]) == (
        f"{said} It looks again within 30 s. Open a door or clear the way, and it goes on."
    )
    paused = state("paused", message=told["vacuum"]["message"])
    assert opened.page.evaluate(SAY, ["headline", "live", paused]) == "Paused · Hall"


@PHONE
def test_a_clean_that_achieved_nothing_is_told_with_its_reason(opened: Opened) -> None:
    report = {
        "outcome": "completed", "message": "", "covered": 0.0, "wanted": 12.0, "duration": 60.0,
        "dirt": 0.0, "rate": 0.0, "times": [], "times_least": 0.0, "rooms": [],
        "missed": [{"area": 12.0, "x": 1.0, "y": 1.0, "room": "bath", "reason": "a door is shut"}],
    }  # fmt: skip
    helps = "Open it or clear the way, then clean there again."
    assert opened.page.evaluate(FAIL, report) == f"Nothing was cleaned: a door is shut. {helps}"
    for other in ({"outcome": "stopped"}, {"covered": 6.0}, {"wanted": 0.0}):
        assert opened.page.evaluate(FAIL, {**report, **other}) == ""


@PHONE
def test_a_run_that_fell_short_is_told_until_the_next_one_begins(opened: Opened) -> None:
    missed = [
        {"area": area, "x": 1.0, "y": 1.0, "room": room, "reason": reason}
        for area, room, reason in (
            (12.0, "bath", "no way leads there: a door is shut"),
            (9.0, "hall", "no way leads there: a door is shut"),
            (1.0, "kitchen", "it was passed, but not all of it was met"),
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
