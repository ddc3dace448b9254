"""The result as a picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from roomba_bench.plot import write_plot
from roomba_bench.record import Better, PeerFigure, Record

ROW = Record(
    "sim", "flat", "steps", 600.0, "1/s", Better.HIGHER, 500.0, (PeerFigure("p", "", 7.0),)
)


@pytest.mark.parametrize(
    "rows",
    [
        [ROW, replace(ROW, better=Better.LOWER, aim=None)],
        [replace(ROW, peers=())],
        [replace(ROW, value=None, error="broken", peers=(PeerFigure("p", error="absent"),))],
        [],
    ],
    ids=["peers", "no peers", "nothing measured", "no rows"],
)
def test_a_picture_is_written_whatever_was_measured(rows: list[Record], tmp_path: Path) -> None:
    write_plot(tmp_path / "out.png", rows, "a machine")
    with Image.open(tmp_path / "out.png") as picture:
        assert picture.width > 500


def test_each_figure_with_peers_has_a_panel(tmp_path: Path) -> None:
    for count in (1, 3):
        write_plot(tmp_path / f"{count}.png", [ROW] * count, "a machine")
    with Image.open(tmp_path / "1.png") as one, Image.open(tmp_path / "3.png") as three:
        assert three.height > 2 * one.height


def test_without_any_peer_our_own_bars_are_drawn(tmp_path: Path) -> None:
    write_plot(tmp_path / "none.png", [], "a machine")
    write_plot(tmp_path / "ours.png", [replace(ROW, peers=())] * 3, "a machine")
    with Image.open(tmp_path / "none.png") as none, Image.open(tmp_path / "ours.png") as ours:
        assert ours.height > 2 * none.height
