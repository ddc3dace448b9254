"""Reports as HTML: of one run, and of two compared. Nothing in them refers to anything outside."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import MissedFloor
from roomba.history.report import words
from roomba.history.report.chart import chart_svg
from roomba.history.report.picture import floor_svg
from roomba.history.report.style import STYLE
from roomba.history.run import REQUEST, RunFigures, RunRecording
from roomba.history.run_rows import KeptRun
from roomba.history.totals import totals_by_week
from roomba.vocabulary import OpenEdge, places_told

_RATE_WINDOW: Final = 20.0
"""s over which the rate of dirt is the mean."""
_DIFFERENCES: Final = (
    ("Clean, m²", "covered", 2, 1.0),
    ("Wanted, m²", "wanted", 2, 1.0),
    ("Share, %", "fraction", 2, 100.0),
    ("Time, min", "duration", 1, 1.0 / 60.0),
    ("Rate, m² a minute", "rate", 2, 1.0),
    ("Way, m", "distance", 1, 1.0),
    ("Turning, rad", "turning", 1, 1.0),
    ("Dirt, g", "dirt", 2, 1.0),
    ("Energy, Wh", "energy", 2, 1.0),
)
"""Name with its unit, attribute of the figures, digits, and the factor to that unit."""


def report_of(run: KeptRun, recording: RunRecording | None, others: Iterable[KeptRun] = ()) -> str:
    """Return the report of a run; ``others`` are the runs of its home, for what changed."""
    figures = run.figures
    title = f"Run {run.number}: {figures.source.home}, {words.moment(figures.began)}"
    return _page(
        title,
        _headline(figures)
        + _section("Figures", _pairs(words.figure_rows(figures)))
        + _times(figures)
        + _floor(figures, recording)
        + _missed(figures.missed)
        + _open_edges(figures.open_edges)
        + _charts(recording)
        + _over_time([other.figures for other in others])
        + _again(figures),
    )


def comparison_of(
    one: tuple[KeptRun, RunRecording | None], other: tuple[KeptRun, RunRecording | None]
) -> str:
    """Return a report of two runs side by side."""
    first, second = one[0], other[0]
    sides = "".join(
        f'<div class="side"><h2>Run {run.number}</h2>'
        + f'<p class="quiet">{escape(_named(run.figures))}</p>'
        + _headline(run.figures)
        + _floor(run.figures, recording)
        + _missed(run.figures.missed)
        + "</div>"
        for run, recording in (one, other)
    )
    return _page(
        f"Runs {first.number} and {second.number} compared",
        _section("Differences", _differences(first, second)) + f'<div class="sides">{sides}</div>',
    )


def _page(title: str, body: str) -> str:
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        '<meta name="color-scheme" content="light dark">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head>"
        f"<body><main><h1>{escape(title)}</h1>{body}</main></body></html>\n"
    )


def _section(title: str, body: str) -> str:
    return f"<section><h2>{escape(title)}</h2>{body}</section>" if body else ""


def _headline(run: RunFigures) -> str:
    message = run.message[:1].upper() + run.message[1:]
    text = words.outcome_of(run) + (f". {message}" if message else "")
    return f'<p class="headline">{escape(text)}</p>'


def _named(run: RunFigures) -> str:
    """Return what tells a run from others: its home, its time, its program, its seed."""
    seed = "" if run.source.seed is None else f", seed {run.source.seed}"
    return f"{run.source.home}, {words.moment(run.began)}, by {run.source.program}{seed}"


def _pairs(rows: Sequence[tuple[str, str]]) -> str:
    cells = "".join(
        f'<tr><th scope="row">{escape(name)}</th><td>{escape(value)}</td></tr>'
        for name, value in rows
    )
    return f'<table class="pairs">{cells}</table>'


def _table(names: Sequence[str], rows: Iterable[Sequence[str]], kind: str = "figures") -> str:
    head = "".join(f'<th scope="col">{escape(name)}</th>' for name in names)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(value)}</td>" for value in row) + "</tr>" for row in rows
    )
    return (
        f'<div class="wide {kind}" tabindex="0" role="group" aria-label="{escape(names[0])}">'
        f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )


def _times(run: RunFigures) -> str:
    """Return where its time went."""
    rows = words.time_rows(run)
    table = _table(("What", "Time", "Share"), rows) if rows else ""
    return _section("Where the time went", table)


def _floor(run: RunFigures, recording: RunRecording | None) -> str:
    if recording is None:
        return _section("Floor", "<p>The recording of this run is no longer kept.</p>")
    share = words.share(run.fraction)
    title = f"Floor of {run.source.home}: {share} clean, {places_told(len(run.missed))} missed"
    keys = (("c1", "swept once"), ("c2", "twice"), ("c3", "more often"), ("cm", "missed"))
    legend = "".join(f'<span><i class="{key}"></i>{text}</span>' for key, text in keys)
    svg = floor_svg(recording, run.missed, title)
    return _section(
        "Floor", f'<figure>{svg}<figcaption class="legend">{legend}</figcaption></figure>'
    )


def _missed(missed: Sequence[MissedFloor]) -> str:
    if not missed:
        return _section("Missed", "<p>Nothing.</p>")
    rows = (
        (str(number), miss.room or "–", words.area(miss.area), miss.reason)
        for number, miss in enumerate(missed, 1)
    )
    return _section("Missed", _table(("Number", "Room", "Area", "Why"), rows, "reasons"))


def _open_edges(edges: Sequence[OpenEdge]) -> str:
    rows = [
        (words.number(edge.length, 1, "m"), words.place(edge.x, edge.y), edge.reason.value)
        for edge in edges
    ]
    table = _table(("Length", "Place, m", "Why"), rows, "reasons") if rows else ""
    return _section("Where the map stays open", table)


def _charts(recording: RunRecording | None) -> str:
    if recording is None or len(recording.trace) < 2:
        return ""
    times = recording.column("time").astype(np.float64)
    ends = ("0 min", words.duration(recording.duration))
    charts: list[tuple[str, NDArray[np.float64], float | None]] = [
        ("Speed, m/s", recording.column("speed").astype(np.float64), None),
        ("Rate of dirt, g/min", _rate(times, recording.column("dirt").astype(np.float64)), None),
    ]
    battery = recording.column("battery").astype(np.float64)
    if (battery >= 0.0).any():
        charts.insert(0, ("Battery, %", 100.0 * np.maximum(battery, 0.0), 100.0))
    body = "".join(
        f"<figure><figcaption>{escape(title)}</figcaption>"
        + chart_svg(title, times, values, ends, highest)
        + "</figure>"
        for title, values, highest in charts
    )
    return _section("Over the run", f'<div class="charts">{body}</div>')


def _rate(times: NDArray[np.float64], dirt: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rate of dirt, g/min; when the bin is emptied, that does not count as negative."""
    taken = np.concatenate(([0.0], np.maximum(np.diff(dirt), 0.0).cumsum()))
    before = np.interp(times - _RATE_WINDOW, times, taken)
    rate: NDArray[np.float64] = (taken - before) * 60.0 / _RATE_WINDOW
    return rate


def _over_time(runs: Sequence[RunFigures]) -> str:
    if not runs:
        return ""
    cleans = sorted(
        (run for run in runs if run.kind == "clean" and math.isfinite(run.dirt)),
        key=lambda run: run.began,
    )
    chart = ""
    if len(cleans) > 1:
        title = "Dirt that each clean picked up, g"
        ends = (words.moment(cleans[0].began), words.moment(cleans[-1].began))
        times = np.array([run.began for run in cleans])
        svg = chart_svg(title, times, np.array([run.dirt for run in cleans]), ends)
        chart = f'<div class="charts"><figure><figcaption>{title}</figcaption>{svg}</figure></div>'
    rows = (
        (
            week.week,
            str(week.runs),
            f"{week.covered:.1f} m²",
            words.duration(week.duration),
            f"{week.distance:.0f} m",
            f"{week.dirt:.1f} g",
            f"{week.energy:.1f} Wh",
        )
        for week in totals_by_week(runs)
    )
    names = ("Week", "Runs", "Clean", "Time", "Way", "Dirt", "Energy")
    return _section("This home, week by week", chart + _table(names, rows))


def _again(run: RunFigures) -> str:
    command = run.source.repeat
    wish = run.source.configuration.get(REQUEST)
    body = f"<pre>{escape(command)}</pre>" if command else ""
    if wish is not None and run.source.program != "sim":  # whose command says it all
        body += f"<pre>POST /api/v1/clean\n{escape(json.dumps(wish))}</pre>"
    return _section("To repeat it", body)


def _differences(one: KeptRun, other: KeptRun) -> str:
    rows = []
    for name, attribute, digits, scale in _DIFFERENCES:
        values = [scale * _known(getattr(run.figures, attribute)) for run in (one, other)]
        texts = [f"{value:.{digits}f}" if math.isfinite(value) else "–" for value in values]
        change = values[1] - values[0]
        told = _signed(f"{change:+.{digits}f}") if math.isfinite(change) else "–"
        rows.append((name, *texts, told))
    rows.append(
        (
            "Places missed",
            str(len(one.figures.missed)),
            str(len(other.figures.missed)),
            _signed(f"{len(other.figures.missed) - len(one.figures.missed):+d}"),
        )
    )
    return _table(("Figure", f"Run {one.number}", f"Run {other.number}", "Change"), rows)


def _known(value: float | None) -> float:
    return math.nan if value is None else value


def _signed(number: str) -> str:
    """Return a number with a minus sign that is as wide as its plus."""
    return number.replace("-", "−")
