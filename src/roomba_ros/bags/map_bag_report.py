"""The report of a mapped drive: figures, for people and for programs."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.table import Table
from rich.text import Text

from roomba.geometry import Pose
from roomba.grid import FREE, UNKNOWN, OccupancyMap
from roomba_ros.bags.map_replay import MapReplay


@dataclass(frozen=True, slots=True, eq=False)
class BagMap:
    """A map that was made; ``true`` has rows t (s), x, y (m), none where unknown.

    ``begin`` is where the drive began on the map, ``processing`` what it took, s.
    """

    bag: str
    occupancy: OccupancyMap
    replay: MapReplay
    true: list[tuple[float, float, float]]
    begin: Pose
    processing: float
    notes: list[str]


@dataclass(frozen=True, slots=True)
class MappingSummary:
    """The figures of a drive; s, m, m2. Errors are None where there is no truth.

    ``closure_m`` is how far from its beginning the drive ends, on the map and by odometry alone;
    ``corrected_m`` how far apart the two took the robot to be, at most, while it drove.
    """

    bag: str
    seconds: float
    scans: int
    way_m: float
    processing_seconds: float
    times_real_time: float
    width_m: float
    height_m: float
    free_m2: float
    closure_m: float
    closure_by_odometry_m: float
    corrected_m: float
    largest_error_m: float | None
    last_error_m: float | None
    largest_error_by_odometry_m: float | None
    last_error_by_odometry_m: float | None
    notes: tuple[str, ...]

    def as_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return asdict(self)


def summary_of(done: BagMap) -> MappingSummary:
    """Return the figures of a map."""
    replay, occupancy, rows = done.replay, done.occupancy, done.replay.poses
    cells = np.argwhere(occupancy.values != UNKNOWN)
    high, wide = ((np.ptp(cells, axis=0) + 1) * occupancy.frame.resolution).tolist()
    ours, theirs = _errors(rows, done.true, 1), _errors(rows, done.true, 4)
    end, blind = replay.mapper.pose, replay.blind.pose
    apart = np.hypot(*(rows[:, 1:3] - rows[:, 4:6]).T)
    return MappingSummary(
        bag=done.bag,
        seconds=replay.elapsed,
        scans=replay.scans,
        way_m=replay.way,
        processing_seconds=done.processing,
        times_real_time=replay.elapsed / max(done.processing, 1e-9),
        width_m=wide,
        height_m=high,
        free_m2=float((occupancy.values == FREE).sum()) * occupancy.frame.resolution**2,
        closure_m=end.distance_to(done.begin.x, done.begin.y),
        closure_by_odometry_m=math.dist((blind.x, blind.y), rows[0, 4:6].tolist()),
        corrected_m=float(apart.max()),
        largest_error_m=ours[0],
        last_error_m=ours[1],
        largest_error_by_odometry_m=theirs[0],
        last_error_by_odometry_m=theirs[1],
        notes=tuple(done.notes),
    )


def table_of(summary: MappingSummary) -> Table:
    """Return the figures as a table."""
    table = Table.grid(padding=(0, 2))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, text in lines_of(summary):
        table.add_row(name, Text(text))
    return table


def lines_of(summary: MappingSummary) -> list[tuple[str, str]]:
    """Return the figures as rows of a name and a text."""
    lines = [
        ("drive", f"{summary.seconds:.1f} s, {summary.scans} scans, way {summary.way_m:.2f} m"),
        (
            "speed",
            f"{summary.times_real_time:.0f} times real time ({summary.processing_seconds:.1f} s)",
        ),
        (
            "map",
            f"{summary.width_m:.2f} x {summary.height_m:.2f} m, {summary.free_m2:.2f} m² of it are "
            "known to be free",
        ),
        (
            "end",
            f"{summary.closure_m:.3f} m from the beginning, by odometry alone "
            f"{summary.closure_by_odometry_m:.3f} m",
        ),
        ("corrected", f"odometry alone was up to {summary.corrected_m:.3f} m off the map"),
    ]
    if summary.largest_error_m is not None and summary.last_error_m is not None:
        lines.append(
            (
                "error",
                f"against the true poses in the bag: {summary.largest_error_m:.3f} m at most, "
                f"{summary.last_error_m:.3f} m at the end; by odometry alone "
                f"{summary.largest_error_by_odometry_m:.3f} m, "
                f"{summary.last_error_by_odometry_m:.3f} m",
            )
        )
    return [*lines, *(("note", note) for note in summary.notes)]


def _errors(
    rows: NDArray[np.float64], true: list[tuple[float, float, float]], column: int
) -> tuple[float | None, float | None]:
    """Return how far the poses of some columns were off the true ones: at most, and at the end."""
    if not true:
        return None, None
    stamps, x, y = np.array(sorted(true)).T
    within = (rows[:, 0] >= stamps[0]) & (rows[:, 0] <= stamps[-1])
    if not within.any():
        return None, None
    at = rows[within]
    off_x = at[:, column] - np.interp(at[:, 0], stamps, x)
    off_y = at[:, column + 1] - np.interp(at[:, 0], stamps, y)
    off = np.hypot(off_x, off_y)
    return float(off.max()), float(off[-1])
