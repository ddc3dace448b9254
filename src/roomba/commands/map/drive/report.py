"""The report of a mapped drive: figures, for people and for programs."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.mapped import MappedDrive
from roomba.grid import FREE, UNKNOWN
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.matching.scan_view import LidarModel


@dataclass(frozen=True, slots=True)
class MappingSummary:
    """The figures of a drive; s, m, m2.

    Errors are None where there is no truth, and what odometry alone tells where that is not used.
    ``closure_m`` is how far from its beginning the drive ends, on the map and by odometry alone;
    ``corrected_m`` how far apart the two took the robot to be, at most, while it drove. Of the
    ``scans`` that were used ``scans_unconfirmed`` fitted nothing that was seen before;
    ``scans_refused`` says of how many others why they were not used. ``times_real_time`` is by
    ``core_seconds``, what the mapper took of one core; ``processing_seconds`` is all of it, with
    reading, on the clock.
    """

    logs: tuple[str, ...]
    seconds: float
    scans: int
    scans_unconfirmed: int
    scans_refused: dict[str, int]
    way_m: float
    processing_seconds: float
    core_seconds: float
    times_real_time: float
    lidar: str
    range_noise_m: float
    latency_s: float
    stamps: dict[str, int]
    stamps_told: str
    width_m: float
    height_m: float
    free_m2: float
    closure_m: float
    closure_by_odometry_m: float | None
    corrected_m: float | None
    largest_error_m: float | None
    last_error_m: float | None
    largest_error_by_odometry_m: float | None
    last_error_by_odometry_m: float | None
    calibration: str
    notes: tuple[str, ...]

    def as_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return asdict(self)


def summary_of(done: MappedDrive, processing: float) -> MappingSummary:
    """Return the figures of a map that took ``processing`` s on the clock."""
    replay, occupancy, mapper = done.replay, done.occupancy, done.replay.mapper
    online, blind, has_odometry = done.online, replay.by_odometry, replay.has_odometry
    cells = np.argwhere(occupancy.values != UNKNOWN)
    high, wide = ((np.ptp(cells, axis=0) + 1) * occupancy.frame.resolution).tolist()
    ours = _errors(online, done.true)
    theirs = _errors(blind, done.true) if has_odometry else (None, None)
    end, blind_end = mapper.pose, replay.blind.pose
    blind_closure = math.dist((blind_end.x, blind_end.y), blind[0, 1:3].tolist())
    apart = np.hypot(*(online[:, 1:3] - blind[-len(online) :, 1:3]).T)
    return MappingSummary(
        logs=tuple(map(str, done.logs)),
        seconds=replay.elapsed,
        scans=replay.scans,
        scans_unconfirmed=replay.unconfirmed,
        scans_refused=done.refused_scans,
        way_m=replay.way,
        processing_seconds=processing,
        core_seconds=replay.seconds,
        times_real_time=replay.elapsed / max(replay.seconds, 1e-9),
        lidar="" if replay.lidar is None else _words_of(replay.lidar),
        range_noise_m=mapper.range_noise,
        latency_s=mapper.latency,
        stamps=asdict(done.stamps),
        stamps_told=done.stamps.words,
        width_m=wide,
        height_m=high,
        free_m2=float((occupancy.values == FREE).sum()) * occupancy.frame.resolution**2,
        closure_m=end.distance_to(done.begin.x, done.begin.y),
        closure_by_odometry_m=blind_closure if has_odometry else None,
        corrected_m=float(apart.max()) if has_odometry else None,
        largest_error_m=ours[0],
        last_error_m=ours[1],
        largest_error_by_odometry_m=theirs[0],
        last_error_by_odometry_m=theirs[1],
        calibration=str(Calibration.of(mapper.belief)),
        notes=done.notes,
    )


def lines_of(summary: MappingSummary) -> list[tuple[str, str]]:
    """Return the figures as rows of a name and a text."""
    lines = [
        ("drive", f"{summary.seconds:.1f} s, {summary.scans} scans, way {summary.way_m:.2f} m"),
        ("scans", _scan_words(summary)),
        ("stamps", summary.stamps_told),
        (
            "lidar",
            f"{summary.lidar}; noise found {1e3 * summary.range_noise_m:.1f} mm, latency found "
            f"{summary.latency_s:.2f} s",
        ),
        (
            "speed",
            f"{summary.times_real_time:.0f} times real time ({summary.core_seconds:.1f} s of one "
            f"core; {summary.processing_seconds:.1f} s with reading and comparing)",
        ),
        (
            "map",
            f"{summary.width_m:.2f} x {summary.height_m:.2f} m, {summary.free_m2:.2f} m² of it are "
            "known to be free",
        ),
        ("end", _end_words(summary)),
        ("calibration", summary.calibration),
    ]
    if summary.corrected_m is not None:
        words = f"odometry alone was up to {summary.corrected_m:.3f} m off the map"
        lines.append(("corrected", words))
    if summary.largest_error_m is not None:
        lines.append(("error", _error_words(summary)))
    return [*lines, *(("note", note) for note in summary.notes)]


def _end_words(summary: MappingSummary) -> str:
    words = f"{summary.closure_m:.3f} m from the beginning"
    if summary.closure_by_odometry_m is None:
        return words
    return f"{words}, by odometry alone {summary.closure_by_odometry_m:.3f} m"


def _error_words(summary: MappingSummary) -> str:
    words = (
        f"against the true poses in the bag: {summary.largest_error_m:.3f} m at most, "
        f"{summary.last_error_m:.3f} m at the end"
    )
    if summary.largest_error_by_odometry_m is None:
        return words
    return (
        f"{words}; by odometry alone {summary.largest_error_by_odometry_m:.3f} m, "
        f"{summary.last_error_by_odometry_m:.3f} m"
    )


def _scan_words(summary: MappingSummary) -> str:
    refused = sum(summary.scans_refused.values())
    words = f"{summary.scans} used, {summary.scans_unconfirmed} of them fitted nothing seen before"
    reasons = ", ".join(f"{count} {what}" for what, count in summary.scans_refused.items())
    return f"{words}; {refused} refused" + (f": {reasons}" if reasons else "")


def _words_of(lidar: LidarModel) -> str:
    beams = lidar.arrays()
    x, y, theta = lidar.mount.tolist()
    fan = math.degrees(abs(beams.step) * (lidar.beams - 1))
    return (
        f"{lidar.beams} beams over {fan:.0f} degrees, {beams.nearest:g} to {beams.farthest:g} m, "
        f"mounted at ({x:.3f}, {y:.3f}) m, {math.degrees(theta):.1f} degrees"
    )


def _errors(rows: Floats, true: Floats) -> tuple[float | None, float | None]:
    """Return how far rows of t, x, y were off the true ones: at most, and at the end."""
    if not len(true):
        return None, None
    stamps, x, y = true[np.argsort(true[:, 0], kind="stable")].T
    at = rows[(rows[:, 0] >= stamps[0]) & (rows[:, 0] <= stamps[-1])]
    if not len(at):
        return None, None
    off_x = at[:, 1] - np.interp(at[:, 0], stamps, x)
    off_y = at[:, 2] - np.interp(at[:, 0], stamps, y)
    off = np.hypot(off_x, off_y)
    return float(off.max()), float(off[-1])
