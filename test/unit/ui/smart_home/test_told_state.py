"""The state that a smart home is told: in its units, and what is not known as null."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from fixtures.households.written_robot import HOME, VIEW

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.view import RobotView
from roomba.ui.smart_home.told_state import StateTeller, attributes_of

REPORT = CleanReport(ErrandOutcome.COMPLETED, "", 38.25, 38.5, 1.0, 9.0, 1312.0, math.nan)


def seen(state: str, time: float, phase: str = "", **changes: Any) -> RobotView:
    view = replace(VIEW, time=time, **changes)
    return replace(view, vacuum=replace(view.vacuum, state=state, phase=phase or state))


def test_a_run_and_after_it() -> None:
    teller = StateTeller()
    first = teller.state_of(seen("docked", 10.0), "quiet")
    assert (first["state"], first["fan_speed"], first["time"]) == ("docked", "quiet", None)
    assert first["battery"] is None
    teller.state_of(seen("cleaning", 20.0, "undocking"), "quiet")
    during = teller.state_of(seen("cleaning", 141.0), "quiet")
    assert (during["time"], during["area"], during["to_go"], during["room"]) == (120, 1, 60, "hall")
    after = teller.state_of(seen("docked", 200.0, last=REPORT), "quiet")
    assert (after["time"], after["area"]) == (1310, 38.2)
    again = teller.state_of(seen("cleaning", 300.0, last=REPORT), "quiet")
    assert (again["time"], again["area"]) == (0, 1)
    json.dumps(again, allow_nan=False)


def test_a_run_that_charges_in_its_middle_is_one_run() -> None:
    teller = StateTeller()
    teller.state_of(seen("cleaning", 0.0, "undocking", last=REPORT), "quiet")
    charging = teller.state_of(seen("docked", 100.0, "charging", last=REPORT), "quiet")
    assert (charging["state"], charging["time"], charging["area"]) == ("docked", 100, 1)
    emptying = teller.state_of(seen("docked", 150.0, "emptying", last=REPORT), "quiet")
    assert emptying["time"] == 150
    goes_on = teller.state_of(seen("cleaning", 200.0, last=REPORT), "quiet")
    assert goes_on["time"] == 200
    after = teller.state_of(seen("docked", 300.0, last=REPORT), "quiet")
    emptied = teller.state_of(seen("docked", 310.0, "emptying", last=REPORT), "quiet")
    assert after["time"] == emptied["time"] == 1310


def test_the_bin_and_what_is_wrong() -> None:
    teller = StateTeller()
    full = teller.state_of(seen("error", 1.0, "bin full"), "standard")
    assert (full["bin_full"], full["bin"], full["error"]) == (True, 3.0, "none")
    assert full["bag"] is None
    assert teller.state_of(replace(seen("docked", 1.0), bag=0.41), "standard")["bag"] == 41
    held = teller.state_of(seen("error", 2.0, held="the button"), "standard")
    assert (held["bin_full"], held["error"]) == (False, "the button")
    long = teller.state_of(seen("error", 3.0, doubt="?" * 900), "standard")
    assert len(long["error"]) == 255


def test_names_that_commands_take() -> None:
    assert attributes_of(HOME) == {"rooms": [], "zones": [], "station": [0.0, 0.0]}
