"""The view of a page as values for JSON."""

from __future__ import annotations

import json
import math

from roomba.client.plain import report_of
from roomba.client.protocol import CleanReport, ErrandOutcome, ExploreReport, MissedFloor
from roomba.client.view import exploration_as_clean
from roomba.vocabulary import EdgeReason, OpenEdge


def told(report: CleanReport) -> dict[str, object]:
    """Return what a program reads of it."""
    read = json.loads(json.dumps(report_of(report), allow_nan=False))
    assert isinstance(read, dict)
    return read


def test_an_exploration_tells_what_it_mapped_and_each_edge_that_stayed_open() -> None:
    edge = OpenEdge(2.0, 1.0, 3.0, EdgeReason.NO_ECHO)
    report = ExploreReport(ErrandOutcome.COMPLETED, "", 34.5, 30.0, 40.0, (edge,))
    read = told(exploration_as_clean(report))
    assert read["mapped"] == 34.5
    assert read["open_edges"] == [
        {"length": 2.0, "x": 1.0, "y": 3.0, "reason": EdgeReason.NO_ECHO.value, "code": "no echo"}
    ]


def test_why_floor_was_missed_is_told_in_words_and_as_a_code() -> None:
    missed = (MissedFloor(0.5, 1.0, 2.0, "hall", "a door is shut", "shut"),)
    clean = CleanReport(ErrandOutcome.COMPLETED, "", 9.0, 10.0, 2.0, 30.0, 40.0, 1.0, missed)
    place = {"area": 0.5, "x": 1.0, "y": 2.0, "room": "hall"}
    assert told(clean)["missed"] == [{**place, "reason": "a door is shut", "code": "shut"}]


def test_a_clean_mapped_nothing() -> None:
    clean = CleanReport(ErrandOutcome.COMPLETED, "", 9.0, 10.0, 2.0, 30.0, 40.0, math.nan)
    read = told(clean)
    assert (read["mapped"], read["open_edges"]) == (None, [])
