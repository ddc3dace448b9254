"""Localizes a recorded drive on a map, offline: ``./roomba localize --map FILE --bag FILE``.

Any drive with a lidar's scans and odometry will do. The localizer gets the same data as on the
robot, but as fast as it can work; the result is printed as a short table, and written to files.
"""

from __future__ import annotations

import time

from roomba.commands.exit_status import COMPLETED, guarded
from roomba.commands.localize.options import PROGRAM, LocalizeOptions, options_of
from roomba.commands.options import UsageError
from roomba.commands.output import named_table, tell_tables, write_json
from roomba.commands.progress import progress
from roomba.files.occupancy_map import load_map
from roomba.geometry import Pose
from roomba.grid import OccupancyMap


def main(arguments: list[str] | None = None) -> int:
    """Localize; returns the exit status."""
    return guarded(lambda: _run(options_of(arguments)), PROGRAM)


def _run(options: LocalizeOptions) -> int:
    # Imported here: it takes a second, and a mistyped option should be reported at once.
    from roomba.commands.localize.localized import localized_drive
    from roomba.commands.localize.report import lines_of, summary_of

    occupancy = load_map(options.map)
    if options.start is not None:
        _check_start(options.start, occupancy)
    began = time.perf_counter()
    with progress("Localizing", options.quiet) as show:
        done = localized_drive(options, occupancy, show)
    summary = summary_of(done, time.perf_counter() - began)
    if options.plot is not None:
        # Imported here: it takes a second, which only a picture needs.
        from roomba.commands.localize.plot import write_plot

        title = f"{done.name} on {options.map.name}"
        write_plot(options.plot, occupancy, done.placed_rows, done.tally.losses, title)
    tell_tables([named_table(lines_of(summary))], options.json, quiet=options.quiet)
    if options.json is not None:
        write_json(options.json, summary.as_json())
    return COMPLETED


def _check_start(start: Pose, occupancy: OccupancyMap) -> None:
    """Raise UsageError for a start that is off the map."""
    if not occupancy.frame.contains(start.x, start.y):
        x_min, x_max, y_min, y_max = occupancy.frame.extent
        raise UsageError(
            f"--start: expected a place on the map, x {x_min:g} to {x_max:g}, "
            f"y {y_min:g} to {y_max:g}, got ({start.x:g}, {start.y:g})"
        )
