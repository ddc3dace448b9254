"""The result as a picture: bars on a logarithmic scale, a panel for each figure with peers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from roomba_bench.record import Better, Record
from roomba_bench.table import number

_OURS, _PEERS, _AIM = "#2a6fbb", "#b8bec6", "#c0392b"
_BAR_HEIGHT, _PANEL_HEIGHT = 0.28, 0.95
"""Inches: of a bar, and of the rest of a panel."""
_WIDTH = 10.0
_ROOM_FOR_NUMBERS = 4.0
"""Factor by which the axis is longer than the longest bar."""


def write_plot(path: Path, records: Sequence[Record], caption: str) -> None:
    """Draw all figures that have peers into a PNG file, or all figures if none has peers."""
    drawn = [record for record in records if _bars(record)[1:]]
    drawn = drawn or [record for record in records if _bars(record)]
    heights = [_PANEL_HEIGHT + _BAR_HEIGHT * len(_bars(record)) for record in drawn] or [1.0]
    figure = Figure(figsize=(_WIDTH, sum(heights) + 0.5), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(heights), 1, squeeze=False, height_ratios=heights)
    for record, panel in zip(drawn, panels[:, 0], strict=False):
        _draw(panel, record)
    if not drawn:
        panels[0, 0].set_axis_off()
    figure.suptitle(caption, fontsize=8, wrap=True)
    figure.savefig(path, dpi=110)


def _bars(record: Record) -> list[tuple[str, float]]:
    """Return name and length of each bar, ours first; a logarithmic axis needs positive values."""
    figures = [("ours", record.value), *((peer.name, peer.value) for peer in record.peers)]
    return [(name, value) for name, value in figures if value is not None and value > 0.0]


def _draw(panel: Axes, record: Record) -> None:
    names, values = zip(*_bars(record), strict=True)
    colours = [_OURS if name == "ours" else _PEERS for name in names]
    bars = panel.barh(range(len(names)), values, color=colours)
    panel.bar_label(bars, [f" {number(value)}" for value in values], fontsize=8)
    panel.set_yticks(range(len(names)), names, fontsize=8)
    panel.invert_yaxis()
    panel.set_xscale("log")
    panel.set_xlim(min(values) / _ROOM_FOR_NUMBERS, max(values) * _ROOM_FOR_NUMBERS)
    if record.aim is not None:
        panel.axvline(record.aim, color=_AIM, linestyle="--", linewidth=1.0)
    direction = "more is better" if record.better is Better.HIGHER else "less is better"
    title = f"{record.topic}: {record.case}: {record.figure}, {record.unit} ({direction})"
    panel.set_title(title, fontsize=9, loc="left")
    panel.tick_params(axis="x", which="both", labelsize=7)
    panel.spines[["top", "right"]].set_visible(False)
