"""Makes a map of a recorded drive, offline: ``./roomba map --bag FILE``.

Only bags of ``./roomba sim --bag`` have the truth to compare with. The report is the length of the
drive, whether it closes, and how much was corrected.
"""

from __future__ import annotations

import time

from roomba.commands.exit_status import COMPLETED, guarded
from roomba.commands.map.drive.options import DriveOptions, options_of
from roomba.commands.map.options import PROGRAM
from roomba.commands.output import named_table, tell_tables, write_json
from roomba.commands.progress import progress


def main(arguments: list[str] | None = None) -> int:
    """Map; returns the exit status."""
    return guarded(lambda: _run(options_of(arguments)), PROGRAM)


def _run(options: DriveOptions) -> int:
    # Imported here: it takes a second, and a mistyped option should be reported at once.
    from roomba.commands.map.drive.mapped import mapped_drive
    from roomba.commands.map.drive.report import lines_of, summary_of
    from roomba.commands.map.drive.trajectory import write_trajectory
    from roomba.commands.map.files import write_files

    output = options.output
    began = time.perf_counter()
    with progress("Mapping", output.quiet) as show:
        done = mapped_drive(options.logs, options.wanted, show)
    processing = time.perf_counter() - began
    if output.out is not None:
        write_files(output.out, done.occupancy, done.begin)
    if options.trajectory is not None:
        write_trajectory(options.trajectory, done.trajectory)
    if options.online is not None:
        write_trajectory(options.online, done.online)
    if output.plot is not None:
        # Imported here: it takes a second, which only a picture needs.
        from roomba.commands.map.drive.plot import write_plot

        write_plot(output.plot, done)
    summary = summary_of(done, processing)
    tell_tables([named_table(lines_of(summary))], output.json, quiet=output.quiet)
    if output.json is not None:
        write_json(output.json, summary.as_json())
    return COMPLETED
