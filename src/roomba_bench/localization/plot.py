"""Pictures of errors: along one drive, and their distribution over all drives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba_bench.localization.drive import Errors
from roomba_bench.localization.peers import Followed

_COLOURS = {"ours": "#2a6fbb", "wheels alone": "#9aa1a9", "wheels and gyro": "#5b626a"}
_PEERS = ("#d9822b", "#7a3e9d", "#3a9d5d")
_AIM = "#c0392b"
_BIN = 5.0
"""s of a bin, of which only the worst error is drawn."""
_LEAST = 0.01
"""mm; the least value that is drawn on a logarithmic scale."""
_AIMS = ((20.0, 60.0), (0.5, 0.99))
"""mm, and the shares of the time in which the error shall be less."""
_LEFT = 0.02
"""mm; where the distributions begin to be drawn."""


def plot_drive(path: Path, title: str, followed: Followed) -> None:
    """Draw the errors along one drive: the worst of each few seconds, position and heading."""
    figure = Figure(figsize=(10.0, 6.5), layout="constrained")
    FigureCanvasAgg(figure)
    place, heading = figure.subplots(2, 1, sharex=True)
    colours = _colours(list(followed.errors))
    for name, errors in followed.errors.items():
        style = {"color": colours[name], "linewidth": 1.8 if name == "ours" else 1.1}
        order = 3.0 if name == "ours" else 2.0
        minutes, millimetres = _worst(followed.stamps, 1e3 * errors[:, 0])
        place.plot(minutes, millimetres, label=name, zorder=order, **style)
        minutes, degrees = _worst(followed.stamps, np.degrees(errors[:, 1]))
        heading.plot(minutes, degrees, zorder=order, **style)
    place.set_title(f"{title}: worst error of each {_BIN:g} s", fontsize=10, loc="left")
    place.set_ylabel("position, mm")
    heading.set_ylabel("heading, degrees")
    heading.set_xlabel("minutes")
    place.legend(fontsize=8, ncols=3, frameon=False, loc="upper left", bbox_to_anchor=(0.0, 1.0))
    high = place.get_ylim()[1]
    for panel in (place, heading):
        panel.set_yscale("log")
        _tidy(panel)
    place.set_ylim(top=8.0 * high)
    _write(figure, path)


def plot_spread(path: Path, homes: Mapping[str, Errors], followed: Sequence[Followed]) -> None:
    """Draw the distribution of position errors: by share of the time, how large they are at most.

    To the left all sources on the same drives together; to the right ours in each home.
    """
    figure = Figure(figsize=(11.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, sharey=True)
    names = list(dict.fromkeys(name for each in followed for name in each.errors))
    colours = _colours(names)
    for name in names:
        all_of_it = [each.errors[name] for each in followed if name in each.errors]
        _curve(left, name, np.concatenate(all_of_it)[:, 0], colours[name])
    shades = colormaps["viridis"](np.linspace(0.0, 0.92, max(1, len(homes))))
    for shade, (name, errors) in zip(shades, homes.items(), strict=True):
        _curve(right, name, errors[:, 0], shade)
    for panel, title in (
        (left, "all homes but the hall, at the same scans"),
        (right, "ours, all drives"),
    ):
        panel.set_title(title, fontsize=10, loc="left")
        panel.set_xscale("log")
        panel.set_xlabel("position error, mm")
        panel.plot(*_AIMS, "x", label="aims: left of these", color=_AIM, zorder=4.0)
        panel.set_xlim(left=_LEFT)
        panel.legend(
            fontsize=8, frameon=False, ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.13)
        )
        _tidy(panel)
    left.set_ylabel("share of time")
    left.set_ylim(0.0, 1.03)
    _write(figure, path)


def _colours(names: Sequence[str]) -> dict[str, str]:
    peers = [name for name in names if name not in _COLOURS]
    return {**_COLOURS, **dict(zip(peers, _PEERS, strict=False))}


def _worst(stamps: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the middles of bins, minutes, and the greatest value in each."""
    bins = (stamps / _BIN).astype(np.int64)
    used, starts = np.unique(bins, return_index=True)
    worst = np.maximum(np.maximum.reduceat(values, starts), _LEAST / 10.0)
    return (used + 0.5) * _BIN / 60.0, worst


def _curve(panel: Axes, name: str, errors: NDArray[np.float32], colour: object) -> None:
    """Draw a distribution by its percentiles, finer towards the end."""
    shares = np.concatenate([np.linspace(0.0, 0.98, 99), np.linspace(0.9805, 1.0, 40)])
    millimetres = np.maximum(1e3 * np.quantile(errors, shares), _LEAST)
    width = 2.2 if name == "ours" else 1.3
    panel.plot(millimetres, shares, label=name, color=colour, linewidth=width)


def _tidy(panel: Axes) -> None:
    panel.grid(True, which="major", color="#e6e8eb", linewidth=0.7)
    panel.tick_params(which="both", labelsize=8)
    panel.spines[["top", "right"]].set_visible(False)


def _write(figure: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
