"""Pictures: how coverage grows with time, and the way that was driven, coloured by time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from roomba.arrays import Floats, Mask
from roomba_bench.coverage.floor import Reachable, drawn, share_over_time

OURS = "ours"
_COLOURS = {OURS: "#2a6fbb", "random bounce": "#9aa1a9"}
_OTHERS = ("#d9822b", "#7a3e9d", "#3a9d5d")
_AIM = "#c0392b"
_WALL, _MISSED = (0.25, 0.27, 0.30), (0.86, 0.24, 0.20)
_APART = 3
"""Ticks between two corners of the drawn way."""


def plot_over_time(
    path: Path, title: str, floor: Reachable, poses: Mapping[str, Floats], aim: float
) -> None:
    """Draw coverage over robot time; ``poses`` by name have rows t, x, y, theta; ``aim`` in %."""
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    panel = figure.subplots()
    others = [name for name in poses if name not in _COLOURS]
    colours = {**_COLOURS, **dict(zip(others, _OTHERS, strict=False))}
    for name, rows in poses.items():
        minutes = (rows[:, 0] - rows[0, 0]) / 60.0
        shares = 100.0 * share_over_time(floor, rows[:, 1:3])
        each = slice(None, None, 20)
        minutes, shares = np.append(minutes[each], minutes[-1]), np.append(shares[each], shares[-1])
        width = 2.4 if name == OURS else 1.5
        label = f"{name}: {shares[-1]:.1f} % in {minutes[-1]:.0f} min"
        panel.plot(minutes, shares, color=colours[name], linewidth=width, label=label)
        panel.plot(minutes[-1:], shares[-1:], "o", color=colours[name], markersize=4.0)
    panel.axhline(aim, color=_AIM, linestyle="--", linewidth=1.0, label=f"aim: {aim:g} %")
    panel.set_title(title, fontsize=10, loc="left")
    panel.set_xlabel("robot time, min")
    panel.set_ylabel("floor swept, % of what the tool can reach")
    panel.set_ylim(0.0, 104.0)
    panel.set_xlim(left=0.0)
    panel.legend(fontsize=8, frameon=False, loc="lower right")
    panel.grid(True, color="#e6e8eb", linewidth=0.7)
    panel.spines[["top", "right"]].set_visible(False)
    _write(figure, path)


def plot_way(path: Path, title: str, floor: Reachable, solid: Mask, poses: Floats) -> None:
    """Draw the way that was driven over its floor, coloured by time; what it missed is red.

    ``solid`` is bool over the map's coarser cells, of the same extent as the floor's.
    """
    figure = Figure(figsize=(9.6, 9.0), layout="constrained")
    FigureCanvasAgg(figure)
    panel: Axes = figure.subplots()
    extent = floor.frame.extent
    picture = np.ones((*solid.shape, 3))
    picture[solid] = _WALL
    panel.imshow(picture, origin="lower", extent=extent, interpolation="nearest")
    missed = floor.floor & ~drawn(floor.frame, poses[:, 1:3])
    overlay = np.zeros((*missed.shape, 4))
    overlay[missed] = (*_MISSED, 1.0)
    panel.imshow(overlay, origin="lower", extent=extent, interpolation="nearest")
    corners = poses[::_APART, 1:3]
    legs = np.stack([corners[:-1], corners[1:]], axis=1)
    minutes = (poses[::_APART, 0] - poses[0, 0]) / 60.0
    way = LineCollection(list(legs), cmap="viridis", linewidths=1.1, array=minutes[:-1])
    panel.add_collection(way)
    panel.plot(*poses[0, 1:3], "o", color=_AIM, markersize=6.0)
    bar = figure.colorbar(way, ax=panel, shrink=0.7, pad=0.01)
    bar.set_label("robot time, min")
    panel.set_title(title, fontsize=10, loc="left")
    panel.set_aspect("equal")
    panel.tick_params(labelsize=8)
    panel.set_xlabel("x, m")
    panel.set_ylabel("y, m")
    _write(figure, path)


def _write(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
