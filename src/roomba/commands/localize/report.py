"""The report of a localized drive: figures, for people and for programs."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from roomba.commands.localize.localized import LocalizedDrive
from roomba.commands.localize.tally import Difference, Loss
from roomba.geometry import Pose

_SHOWN_LOSSES: Final = 8


@dataclass(frozen=True, slots=True)
class LocalizationSummary:
    """The figures of a drive; times in s, deviations in m and rad, shares 0..1 of the time.

    ``found_after`` is when the place was first known well enough to drive by, None if never.
    """

    logs: tuple[str, ...]
    map: str
    start: str
    seconds: float
    scans: int
    processing_seconds: float
    scans_per_second: float
    times_real_time: float
    way: float
    shares: dict[str, float]
    position_deviation: float | None
    heading_deviation: float | None
    agreement: float | None
    found_after: float | None
    found_at: tuple[float, float, float] | None
    losses: list[Loss]
    loss_count: int
    differences: list[Difference]
    stamps: dict[str, int]
    stamps_told: str
    notes: tuple[str, ...]

    def as_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return asdict(self)


def summary_of(done: LocalizedDrive, processing: float) -> LocalizationSummary:
    """Return the figures of a drive that took ``processing`` s on the clock."""
    tally = done.tally
    known = [row.estimate for row in tally.rows.rows if row.estimate.knowledge.is_usable]
    found = tally.found
    return LocalizationSummary(
        logs=tuple(map(str, done.logs)),
        map=str(done.map),
        start=done.start,
        seconds=tally.seconds,
        scans=done.scans,
        processing_seconds=processing,
        scans_per_second=done.scans / max(processing, 1e-9),
        times_real_time=tally.seconds / max(processing, 1e-9),
        way=tally.last.way if tally.last is not None else 0.0,
        shares=tally.shares,
        position_deviation=_median([each.position_deviation for each in known]),
        heading_deviation=_median([each.heading_deviation for each in known]),
        agreement=_median([each.agreement for each in known]),
        found_after=found.elapsed if found is not None else None,
        found_at=_numbers(found.estimate.pose) if found is not None else None,
        losses=tally.losses,
        loss_count=tally.loss_count,
        differences=tally.differences(done.own_poses),
        stamps=asdict(done.stamps),
        stamps_told=done.stamps.words,
        notes=done.notes,
    )


def lines_of(summary: LocalizationSummary) -> list[tuple[str, str]]:
    """Return the figures as rows of a name and a text."""
    shares = ", ".join(f"{name} {100.0 * share:.1f} %" for name, share in summary.shares.items())
    lines = [
        ("drive", f"{summary.seconds:.1f} s, {summary.scans} scans, way {summary.way:.2f} m"),
        (
            "speed",
            f"{summary.scans_per_second:.0f} scans/s, {summary.times_real_time:.0f} times real "
            f"time ({summary.processing_seconds:.1f} s)",
        ),
        ("stamps", summary.stamps_told),
        ("start", f"{summary.start}, {_found(summary)}"),
        ("place", shares),
    ]
    if summary.position_deviation is not None and summary.heading_deviation is not None:
        deviation = f"{summary.position_deviation:.3f} m, {summary.heading_deviation:.4f} rad"
        lines.append(("deviation", f"median {deviation}, while the place was known or rough"))
    lines += [("lost", _text_of(loss)) for loss in summary.losses[:_SHOWN_LOSSES]]
    if summary.loss_count > _SHOWN_LOSSES:
        lines.append(("lost", f"and {summary.loss_count - _SHOWN_LOSSES} times more"))
    lines += [
        (
            each.topic,
            f"differs by {each.median:.3f} m (median), {each.percentile_99:.3f} m (99th "
            f"percentile) at {each.count} places",
        )
        for each in summary.differences
    ]
    return [*lines, *(("note", note) for note in summary.notes)]


def _found(summary: LocalizationSummary) -> str:
    if summary.found_after is None or summary.found_at is None:
        return "the place was never known: is this its map?"
    x, y, theta = summary.found_at
    return f"known after {summary.found_after:.1f} s at ({x:.2f}, {y:.2f}), {theta:.2f} rad"


def _text_of(loss: Loss) -> str:
    for_how_long = "to the end" if loss.seconds is None else f"for {loss.seconds:.1f} s"
    return (
        f"at {loss.elapsed:.1f} s near ({loss.x:.2f}, {loss.y:.2f}) {for_how_long}: {loss.reason}"
    )


def _numbers(pose: Pose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta


def _median(values: list[float]) -> float | None:
    return float(np.median(values)) if values else None
