"""The table's rows about drives and kidnappings: errors, shares of time, and tries."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.perception.localization.estimate import Knowledge
from roomba_bench.localization.drive import STATES, Drive, Errors
from roomba_bench.localization.kidnaps import TIME, Manner, Try
from roomba_bench.localization.robot import WRONG
from roomba_bench.record import Better, PeerFigure, Record

TOPIC = "localization"
RECKONED, ODOMETRY = "wheels and gyro", "wheels alone"
MATCH_AIM = 0.5
"""ms."""
_MEDIAN_AIM, _WORST_AIM, _HEADING_AIM = 20.0, 60.0, 0.7
"""mm, mm, degrees."""
_FOUND_AIM = 95.0
"""%."""
_FIGURES = (
    ("position error, median", "mm", _MEDIAN_AIM),
    ("position error, 99th percentile", "mm", _WORST_AIM),
    ("heading error, median", "degrees", _HEADING_AIM),
)


def figures(errors: Errors) -> tuple[float, float, float]:
    """Return median and 99th percentile of the position's error, mm, and the heading's, degrees."""
    median, worst = np.percentile(errors[:, 0], (50.0, 99.0)) * 1e3
    return float(median), float(worst), math.degrees(float(np.median(errors[:, 1])))


def drive_rows(case: str, drives: Sequence[Drive]) -> list[Record]:
    """Return the rows of drives in one home; all their ticks count alike, lost or not."""
    ours = np.concatenate([drive.ours for drive in drives])
    others = {
        RECKONED: np.concatenate([drive.reckoned for drive in drives]),
        ODOMETRY: np.concatenate([drive.odometry for drive in drives]),
    }
    states = np.concatenate([drive.states for drive in drives])
    is_wrong = (states == STATES.index(Knowledge.KNOWN)) & (ours[:, 0] > WRONG)
    peers = {name: figures(errors) for name, errors in others.items()}
    rows = error_rows(case, figures(ours), peers)
    for state in STATES:
        share = 100.0 * float(np.mean(states == STATES.index(state)))
        if state in (Knowledge.KNOWN, Knowledge.LOST) or share > 0.0:
            better = Better.HIGHER if state is Knowledge.KNOWN else Better.LOWER
            aim = 0.0 if state is Knowledge.LOST else None
            figure = f"time {state.name}"
            rows.append(Record(TOPIC, case, figure, share, "%", better, aim))
    wrong = f"more than {100.0 * WRONG:.0f} cm off while KNOWN"
    ticks = float(np.count_nonzero(is_wrong))
    return [*rows, Record(TOPIC, case, wrong, ticks, "ticks", Better.LOWER, 0.0)]


def error_rows(
    case: str,
    ours: Sequence[float],
    peers: Mapping[str, Sequence[float]],
    left_out: Sequence[PeerFigure] = (),
    has_aims: bool = True,
) -> list[Record]:
    """Return three rows, in the order of :func:`figures`; ``left_out`` peers have no figures."""
    return [
        Record(
            TOPIC,
            case,
            figure,
            ours[at],
            unit,
            Better.LOWER,
            aim if has_aims else None,
            (*(PeerFigure(name, "", peers[name][at]) for name in peers), *left_out),
        )
        for at, (figure, unit, aim) in enumerate(_FIGURES)
    ]


def kidnap_rows(case: str, manner: Manner, tries: Sequence[Try]) -> list[Record]:
    """Return the rows of tries; percentiles are over all of them, found or not."""
    found = np.array([each.found for each in tries])
    wrong = sum(each.is_wrong for each in tries)
    case = f"{case}, {manner.value}, {len(tries)} times"
    share = 100.0 * float(np.mean(found <= TIME))
    known = f"KNOWN and right within {TIME:.0f} s"
    rows = [Record(TOPIC, case, known, share, "%", Better.HIGHER, _FOUND_AIM)]
    times = [("until KNOWN and right", found)]
    if manner is Manner.SILENT:
        times.insert(0, ("until it is noticed", np.array([each.noticed for each in tries])))
    for figure, seconds in times:
        rows += [
            _time_row(case, f"{figure}, {name}", seconds, percent)
            for name, percent in (("median", 50.0), ("95th percentile", 95.0))
        ]
    rows.append(Record(TOPIC, case, "KNOWN while wrong", float(wrong), "tries", Better.LOWER, 0.0))
    return rows


def broken_row(case: str, error: Exception) -> Record:
    """Return a row for what could not be measured."""
    reason = f"{type(error).__name__}: {error}"
    return Record(TOPIC, case, "everything", None, "", Better.LOWER, error=reason)


def _time_row(case: str, figure: str, seconds: NDArray[np.float64], percent: float) -> Record:
    # The next larger value: no mean can be taken of a time and infinity.
    value = float(np.percentile(seconds, percent, method="higher"))
    if math.isfinite(value):
        return Record(TOPIC, case, figure, value, "s", Better.LOWER)
    return Record(TOPIC, case, figure, TIME, "s or more", Better.LOWER)
