"""A table of what was told: a row for each change, and for each 5 m2."""

from __future__ import annotations

import json

from roomba.commands.demonstration.listener import HeardMessage
from roomba.commands.demonstration.table import table_of, troubles_of

DUE = 1000.0


def told(
    time: float, state: str, phase: str, area: float | None, error: str = "none"
) -> HeardMessage:
    values = {"state": state, "phase": phase, "battery": 97.0, "area": area, "error": error}
    return HeardMessage(DUE + time, "roomba/roomba/state", json.dumps(values).encode())


def test_a_row_tells_each_change_and_each_five_square_metres() -> None:
    states = [
        told(-12.0, "docked", "docked", None),
        told(-2.0, "docked", "docked", None),
        told(3.0, "cleaning", "undocking", 0.0),
        told(9.0, "cleaning", "cleaning", 0.1),
        told(100.0, "cleaning", "cleaning", 4.9),
        told(101.0, "cleaning", "cleaning", 5.2),
        told(131.0, "error", "stuck", 5.2, "it is stuck"),
        told(133.0, "error", "stuck", 5.2, "it is stuck"),
        told(170.0, "docked", "docked", 5.2),
        told(175.0, "docked", "docked", 5.3),
    ]
    said = [HeardMessage(DUE + 130.0, "roomba/roomba/command", b"pause")]
    assert table_of(states, said, DUE).splitlines()[2:] == [
        "| −0:12 | docked | 97 % |  |",
        "| 0:03 | cleaning (undocking) | 97 % | 0.0 m² |",
        "| 0:09 | cleaning | 97 % | 0.1 m² |",
        "| 1:41 | cleaning | 97 % | 5.2 m² |",
        "| 2:10 | → `command`: `pause` | | |",
        "| 2:11 | error (stuck) | 97 % | 5.2 m² |",
        "| 2:50 | docked | 97 % | 5.2 m² |",
        "| 2:55 | docked | 97 % | 5.3 m² |",
    ]
    assert troubles_of(states) == "- “it is stuck”: 1 times, 39 s in all\n"
    assert troubles_of(states[:3]) == ""
