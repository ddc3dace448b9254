"""Records: JSON, ratios, aims, and that nothing is left out silently."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from roomba_bench.record import Better, PeerFigure, Record, gain, write_json

PEERS = (PeerFigure("quick", "1.0", 2.0), PeerFigure("absent", error="no wheel for this machine"))
ROW = Record("plan", "apartment", "path", 0.5, "ms", Better.LOWER, 1.0, PEERS)


def test_json_has_exactly_the_promised_keys(tmp_path: Path) -> None:
    write_json(tmp_path / "out.json", [ROW])
    [row] = json.loads((tmp_path / "out.json").read_text())
    assert list(row) == [
        *("topic", "case", "figure", "value", "unit", "better", "aim", "reached", "peers")
    ]
    assert row["better"] == "lower"
    assert row["reached"] is True
    assert row["peers"][0] == {"name": "quick", "version": "1.0", "value": 2.0, "ratio": 4.0}


def test_a_missing_peer_is_named_with_the_reason() -> None:
    assert ROW.to_json()["peers"][1] == {
        "name": "absent",
        "version": "",
        "value": None,
        "ratio": None,
        "error": "no wheel for this machine",
    }


def test_what_could_not_be_measured_says_why_and_reached_no_aim() -> None:
    row = replace(ROW, value=None, error="broken").to_json()
    assert row["error"] == "broken"
    assert row["value"] is None
    assert row["reached"] is False
    assert row["peers"][0]["ratio"] is None


def test_nothing_is_left_out_silently() -> None:
    with pytest.raises(ValueError, match="expected a value, or an error"):
        PeerFigure("absent")
    with pytest.raises(ValueError, match="expected a value, or an error"):
        replace(ROW, value=None)


@pytest.mark.parametrize(
    ("better", "ours", "peer", "ratio"),
    [
        (Better.HIGHER, 600.0, 200.0, 3.0),
        (Better.HIGHER, 200.0, 600.0, 1 / 3),
        (Better.LOWER, 2.0, 6.0, 3.0),
        (Better.LOWER, 6.0, 2.0, 1 / 3),
        (Better.LOWER, 0.0, 2.0, None),
    ],
)
def test_a_ratio_above_one_means_that_ours_is_better(
    better: Better, ours: float, peer: float, ratio: float | None
) -> None:
    row = replace(ROW, value=ours, better=better)
    assert row.ratio(PeerFigure("peer", value=peer)) == pytest.approx(ratio)


@pytest.mark.parametrize(
    ("better", "value", "aim", "reached"),
    [
        (Better.HIGHER, 5.0, 5.0, True),
        (Better.HIGHER, 4.9, 5.0, False),
        (Better.LOWER, 5.0, 5.0, True),
        (Better.LOWER, 5.1, 5.0, False),
        (Better.LOWER, 5.1, None, None),
    ],
)
def test_an_aim_is_reached_from_its_own_side(
    better: Better, value: float | None, aim: float | None, reached: bool | None
) -> None:
    assert replace(ROW, better=better, value=value, aim=aim).is_reached is reached


def test_a_gain_is_the_ratio_within_the_run_and_has_an_aim_of_its_own() -> None:
    row = gain(ROW, "quick", 5.0)
    assert (row.value, row.unit, row.better) == (4.0, "x", Better.HIGHER)
    assert row.is_reached is False


def test_a_gain_finds_its_peer_by_the_name_before_what_is_said_of_it() -> None:
    row = replace(ROW, peers=(PeerFigure("quick (cuts 3 corners)", value=1.0),))
    assert gain(row, "quick", 2.0).value == 2.0


@pytest.mark.parametrize(
    ("name", "reason"), [("absent", "absent: no wheel"), ("other", "other was not measured")]
)
def test_a_gain_over_no_peer_says_why(name: str, reason: str) -> None:
    row = gain(ROW, name, 2.0)
    assert reason in row.error
    assert row.lacks_peer


def test_a_gain_without_a_figure_of_ours_lacks_no_peer() -> None:
    assert not gain(ROW, "quick", 5.0).lacks_peer
    unmeasured = gain(replace(ROW, value=None, error="out of memory"), "quick", 5.0)
    assert (unmeasured.error, unmeasured.lacks_peer) == ("out of memory", False)
