"""The differences of a campaign's variants as a picture: means with their intervals."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from matplotlib.figure import Figure

from roomba.commands.campaign.comparison import Comparison
from roomba.commands.campaign.running.measures import MEASURES
from roomba.commands.campaign.running.specification import Campaign
from roomba.plots.png import write_png
from roomba.plots.style import BLUE, GREEN, GREY, INK, ORANGE, PINK, RED, drawn, empty_figure

_WIDTH: Final = 1000
_PER_ROW, _REST = 16, 150
"""px of height: of each mark, and of title, axis and legend."""
_COLOURS: Final = (BLUE, ORANGE, GREEN, RED, PINK, INK)
_BETWEEN: Final = 1.2
"""Rows between two measures."""
_WIDEST: Final = 100.0
"""% of the baseline's mean; a wider interval does not determine the scale."""
_MARGIN: Final = 1.25
"""The picture's reach as a factor of the largest value, so that homes' names have room."""


def write_plot(path: Path, campaign: Campaign, comparisons: Sequence[Comparison]) -> None:
    """Draw the comparisons into a PNG file; raises OSError."""
    write_png(path, picture_of(campaign, comparisons))


def reach_of(comparisons: Sequence[Comparison]) -> float | None:
    """Return how far the picture reaches to either side, %; None if no interval determines it.

    A rare event, such as a hit, has so wide an interval that all others would look like points
    beside it. Such intervals are drawn up to the edge.
    """
    ends: list[float] = []
    for each in comparisons:
        values = [value for value in each.percent or () if value is not None]
        if values and max(values) - min(values) <= _WIDEST and len(values) > 1:
            ends += map(abs, values)
    return _MARGIN * max(ends) if any(ends) else None


@drawn
def picture_of(campaign: Campaign, comparisons: Sequence[Comparison]) -> Figure:
    """Return the picture: a group for each measure, in it a mark for each variant and home.

    Differences are in % of the baseline's mean, and left out where that is 0. See :func:`reach_of`.
    """
    shown = [each for each in comparisons if each.percent is not None]
    measures = list(dict.fromkeys(each.measure for each in shown))
    variants = list(dict.fromkeys(each.variant for each in shown))
    rows = len(shown) + _BETWEEN * len(measures)
    figure = empty_figure(_WIDTH, round(_REST + _PER_ROW * max(rows, 1.0)))
    axes = figure.subplots()
    axes.axvline(0.0, color=GREY, linewidth=1.0)
    at, ticks = 0.0, []
    for measure in measures:
        group = [each for each in shown if each.measure == measure]
        ticks.append(at + 0.5 * (len(group) - 1))
        for each in group:
            assert each.percent is not None
            colour = _COLOURS[variants.index(each.variant) % len(_COLOURS)]
            middle, low, high = each.percent
            if low is not None and high is not None:
                axes.plot([low, high], [at, at], color=colour, linewidth=1.4 if each.home else 2.6)
            fill = "none" if each.home else "full"
            axes.plot([middle], [at], "o", color=colour, markersize=6.0, fillstyle=fill)
            if each.home:
                axes.annotate(
                    each.home,
                    (high if high is not None else middle, at),
                    xytext=(6, 0),
                    textcoords="offset points",
                    va="center",
                    color=GREY,
                    fontsize=8.0,
                )
            at += 1.0
        at += _BETWEEN
    axes.set_yticks(ticks, [MEASURES[measure].label.partition(",")[0] for measure in measures])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    reach = reach_of(shown)
    if reach is not None:
        axes.set_xlim(-reach, reach)
    axes.set_xlabel(f"difference from {campaign.baseline}, % of its mean")
    pairs = max((each.pairs for each in shown), default=0)
    axes.set_title(
        f"{campaign.name}: up to {pairs} pairs of home and seed, "
        f"{100.0 * campaign.file.confidence:g} % intervals"
    )
    for number, variant in enumerate(variants):
        axes.plot([], [], "o-", color=_COLOURS[number % len(_COLOURS)], label=variant)
    if variants:
        axes.legend(loc="best")
    return figure
