"""The table's rows about cleans."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import mean, median

import numpy as np

from roomba_bench.coverage.aims import (
    CHANGED_COVERAGE,
    COVERAGE,
    MORE_BY_NOISE,
    NOISY_COVERAGE,
    Aims,
)
from roomba_bench.coverage.clean import Clean
from roomba_bench.coverage.peers import Driven, Planned
from roomba_bench.coverage.recorded import FAILED, NOTE, Recorded
from roomba_bench.record import Better, PeerFigure, Record

TOPIC = "coverage"
_RATIO = "way by (area by 0.20 m)"
_OF_ALL = ("coverage", "exact", "hits")
"""Figures that make sense for peers that drive at random, too."""
_HIGHER, _LOWER = Better.HIGHER, Better.LOWER


@dataclass(frozen=True)
class Case:
    """A case: its title in the table, its home, and its aims."""

    title: str
    home: str
    aims: Aims


def ideal_rows(
    case: Case,
    done: Clean,
    planned: Planned,
    driven: Sequence[Driven],
    noted: Sequence[Recorded],
    left_out: Sequence[PeerFigure] = (),
) -> list[Record]:
    """Return the rows of a clean with ideal sensors, beside other ways over the same floor.

    ``left_out`` peers have no figures here.
    """
    aims = case.aims
    failed = tuple(
        PeerFigure(name, NOTE, error="it gave no way") for name in FAILED.get(case.home, ())
    )

    def row(
        figure: str, value: float, unit: str, better: Better, aim: float | None, of: str, told: str
    ) -> Record:
        # A random way cannot be judged by its length or its turns.
        apt = [one for one in driven if of in _OF_ALL or not one.is_random]
        peers = tuple(PeerFigure(one.name, "", float(getattr(one, of))) for one in apt)
        peers += tuple(left_out)
        if told:
            peers += tuple(
                PeerFigure(one.name, NOTE, number)
                for one in noted
                if (number := getattr(one, told)) is not None
            )
            peers += failed
        return Record(TOPIC, case.title, figure, value, unit, better, aim, peers)

    title, exact = case.title, 100.0 * done.exact
    return [
        row("coverage", 100.0 * done.share, "%", _HIGHER, COVERAGE, "coverage", "coverage"),
        row("coverage, exact to the millimetre", exact, "%", _HIGHER, None, "exact", ""),
        row(_RATIO, done.ratio, "", _LOWER, aims.ratio, "ratio", "ratio"),
        row("turning", done.turning, "rad", _LOWER, aims.turning, "turning", "turning"),
        row("hits", float(done.hits), "hits", _LOWER, 0.0, "hits", ""),
        row("robot time", done.seconds / 60.0, "min", _LOWER, None, "minutes", ""),
        Record(TOPIC, title, "planned: coverage", 100.0 * planned.share, "%", _HIGHER, COVERAGE),
        Record(TOPIC, title, f"planned: {_RATIO}", planned.ratio, "", _LOWER, aims.ratio),
        Record(TOPIC, title, "planned: turning", planned.turning, "rad", _LOWER, aims.turning),
        Record(TOPIC, title, "planning, CPU", planned.cpu * 1e3, "ms", _LOWER, aims.planning),
        Record(TOPIC, title, "closed loop, CPU", done.cpu, "s", _LOWER, aims.clean),
        Record(TOPIC, title, "closed loop, wall", done.wall, "s", _LOWER),
        Record(TOPIC, title, "setting up before, CPU", done.setup, "s", _LOWER),
        Record(TOPIC, title, "docked and done", 100.0 * done.is_home_and_done, "%", _HIGHER, 100.0),
        *missed_rows(title, done),
    ]


def missed_rows(title: str, done: Clean) -> list[Record]:
    """Return how much floor was missed in truth, and what the robot says of it, by reason."""
    told: dict[str, float] = defaultdict(float)
    for reason, patch in done.told:
        told[reason.value] += patch.area
    return [
        Record(TOPIC, title, "missed in truth", done.missed_area, "m²", _LOWER),
        *(
            Record(TOPIC, title, f"missed, as the robot tells it: {reason}", area, "m²", _LOWER)
            for reason, area in told.items()
        ),
    ]


def noisy_rows(case: Case, ideal: Clean | None, done: Sequence[Clean]) -> list[Record]:
    """Return the rows of cleans with noise, the worst of the seeds where there is an aim."""
    title, aims = f"{case.title}, noise, {len(done)} seeds", case.aims
    ratio = max(one.ratio for one in done)
    rows = [
        Record(
            TOPIC,
            title,
            "coverage, least",
            100.0 * min(one.share for one in done),
            "%",
            _HIGHER,
            NOISY_COVERAGE,
        ),
        Record(TOPIC, title, f"{_RATIO}, most", ratio, "", _LOWER),
    ]
    if ideal is not None:
        figure = f"{_RATIO}, most: above that with ideal sensors"
        rows.append(Record(TOPIC, title, figure, ratio - ideal.ratio, "", _LOWER, MORE_BY_NOISE))
    turning = max(one.turning for one in done)
    worst = min(done, key=lambda one: one.share)
    short = [one for one in done if one.is_short(0.01 * NOISY_COVERAGE)]
    return [
        *rows,
        Record(TOPIC, title, "turning, most", turning, "rad", _LOWER, aims.turning),
        Record(
            TOPIC,
            title,
            "coverage, exact to the millimetre, least",
            100.0 * min(one.exact for one in done),
            "%",
            _HIGHER,
        ),
        Record(TOPIC, title, "hits, most", float(max(c.hits for c in done)), "hits", _LOWER, 0.0),
        Record(TOPIC, title, "robot time, median", _minutes(done), "min", _LOWER),
        Record(TOPIC, title, "docked and done", _home(done), "%", _HIGHER, 100.0),
        _wrong_row(title, done),
        *missed_rows(f"{title}: the one that missed most", worst),
        *(short_row(title, one, NOISY_COVERAGE) for one in short),
    ]


def changed_rows(title: str, done: Sequence[Clean]) -> list[Record]:
    """Return percentiles over the seeds of a changed home, and each run that falls short."""
    aim = CHANGED_COVERAGE
    shares = [100.0 * one.share for one in done]
    rows = [
        Record(TOPIC, title, f"coverage of what could be reached, {name}", value, "%", _HIGHER, to)
        for name, value, to in (
            ("least", min(shares), aim),
            ("5th percentile", _percentile(shares, 5.0), None),
            ("median", median(shares), None),
        )
    ]
    spreads = (
        (_RATIO, [one.ratio for one in done], ""),
        ("hits", [float(one.hits) for one in done], "hits"),
        ("robot time", [one.seconds / 60.0 for one in done], "min"),
        ("closed loop, CPU", [one.cpu for one in done], "s"),
    )
    for figure, values, unit in spreads:
        for name, value in (
            ("median", median(values)),
            ("95th percentile", _percentile(values, 95.0)),
            ("most", max(values)),
        ):
            rows.append(Record(TOPIC, title, f"{figure}, {name}", value, unit, _LOWER))
    short = [one for one in done if one.is_short(0.01 * aim)]
    silent = [one for one in done if one.is_silent(0.01 * aim)]
    return [
        *rows,
        Record(TOPIC, title, "docked and done", _home(done), "%", _HIGHER, 100.0),
        Record(TOPIC, title, "fell short", float(len(short)), "runs", _LOWER, 0.0),
        Record(
            TOPIC, title, "fell short without saying so", float(len(silent)), "runs", _LOWER, 0.0
        ),
        _wrong_row(title, done),
        *(short_row(title, one, aim) for one in short),
    ]


def short_row(title: str, one: Clean, aim: float) -> Record:
    """Return the row of a run that fell short, with all that is needed to see it again."""
    what = f" ({one.what})" if one.what else ""
    end = "" if one.is_home_and_done else f", {one.outcome.value}: {one.message}"
    if one.told and one.is_home_and_done:
        end = f", {one.told_area:.2f} m² told as missed"
    case = f"{title.rsplit(', ', 1)[0]}, seed {one.task.seed}{what}"
    return Record(TOPIC, case, f"coverage{end}", 100.0 * one.share, "%", _HIGHER, aim)


def over_time_rows(
    title: str, minutes: Sequence[int], ours: Sequence[float], peers: Mapping[str, Sequence[float]]
) -> list[Record]:
    """Return coverage after so many minutes; shares of ours, and of each peer by its name."""
    return [
        Record(
            TOPIC,
            title,
            f"coverage after {minute} min",
            100.0 * ours[at],
            "%",
            _HIGHER,
            None,
            tuple(PeerFigure(name, "", 100.0 * shares[at]) for name, shares in peers.items()),
        )
        for at, minute in enumerate(minutes)
    ]


def broken_row(case: str, error: Exception) -> Record:
    """Return a row for what could not be measured."""
    reason = f"{type(error).__name__}: {error}"
    return Record(TOPIC, case, "everything", None, "", _LOWER, error=reason)


def _wrong_row(title: str, done: Sequence[Clean]) -> Record:
    seconds = sum(one.wrong for one in done)
    figure = "pose more than 15 cm off and taken for KNOWN, all runs together"
    return Record(TOPIC, title, figure, seconds, "s", _LOWER, 0.0)


def _home(done: Sequence[Clean]) -> float:
    return 100.0 * mean(one.is_home_and_done for one in done)


def _minutes(done: Sequence[Clean]) -> float:
    return median(one.seconds for one in done) / 60.0


def _percentile(values: Sequence[float], percent: float) -> float:
    return float(np.percentile(values, percent))
