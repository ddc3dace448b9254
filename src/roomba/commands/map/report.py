"""A run as a table for people: the map that was made beside the one by odometry alone."""

from __future__ import annotations

import math

from rich.table import Table

from roomba.commands.map.runs import Drawn, MapRun
from roomba.commands.output import clock, named_table


def run_lines(run: MapRun) -> list[tuple[str, str]]:
    """Return what happened: rows of a name and a text."""
    result = run.record.result
    outcome = result.outcome.name + (f": {result.message}" if result.message else "")
    unseen = ", ".join(f"({x:.1f}, {y:.1f})" for x, y in result.unseen[:8])
    return [
        ("outcome", outcome),
        ("floor", f"{result.known:.2f} m² are known to be free"),
        ("way", f"{result.distance:.1f} m, {clock(result.duration)} of robot time"),
        ("hits", f"{run.record.hits}"),
        ("given up", f"{len(result.unseen)} places" + (f": {unseen}" if unseen else "")),
        ("wall time", f"{run.record.wall:.2f} s, {run.times_real_time:.0f} times real time"),
    ]


def error_lines(drawn: Drawn) -> list[tuple[str, str]]:
    """Return the errors of a map: rows of a name and a text, the same names for each map."""
    error = drawn.error
    return [
        ("walls within 5 cm", f"{100.0 * error.walls:.2f} %"),
        ("walls off by, median", f"{1e3 * error.wall_distance:.1f} mm"),
        ("free floor, IoU", f"{error.floor:.4f}"),
        ("walls mapped twice", f"{error.doubled} cells"),
        ("turned by", f"{math.degrees(error.rotation):.2f} degrees"),
        ("moved by", f"{1e3 * math.hypot(*error.shift):.1f} mm"),
        ("robot's place, largest error", f"{1e3 * drawn.largest:.1f} mm"),
        ("robot's place, at the end", f"{1e3 * drawn.last:.1f} mm"),
    ]


def run_table(run: MapRun) -> Table:
    """Return the table of what happened."""
    return named_table(run_lines(run), {"outcome": "green" if run.is_completed else "red"})


def error_table(run: MapRun) -> Table:
    """Return the table of errors: the robot's own map, and the one by odometry alone."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column("against the truth", style="bold", no_wrap=True)
    table.add_column("its map", justify="right", no_wrap=True)
    table.add_column("by wheels and gyro alone", justify="right", no_wrap=True)
    both = zip(error_lines(run.made), error_lines(run.by_odometry), strict=True)
    for (name, ours), (_, theirs) in both:
        table.add_row(name, ours, theirs)
    return table
