"""What the page says of a state, word by word."""

from __future__ import annotations

from typing import Any

import pytest
from web.conftest import SIZES, Opened

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


@PHONE
def test_a_clean_that_achieved_nothing_is_told_with_its_reason(opened: Opened) -> None:
    report = {
        "outcome": "completed", "message": "", "covered": 0.0, "wanted": 12.0, "duration": 60.0,
        "dirt": 0.0, "rate": 0.0, "times": [], "times_least": 0.0, "rooms": [],
        "missed": [{"area": 12.0, "x": 1.0, "y": 1.0, "room": "bath", "reason": "a door is shut"}],
    }  # fmt: skip
    assert opened.page.evaluate(FAIL, report) == "Nothing was cleaned: a door is shut."
    for other in ({"outcome": "stopped"}, {"covered": 6.0}, {"wanted": 0.0}):
        assert opened.page.evaluate(FAIL, {**report, **other}) == ""
