"""``./roomba map``: a home that is explored, told as a table, JSON, a picture and a map's files."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Final

from roomba.commands.exit_status import COMPLETED, ENDED_OTHERWISE, USAGE, guarded
from roomba.commands.garbage_pause import nothing_thrown_away
from roomba.commands.map.options import PROGRAM, MapOptions, Output, options_of
from roomba.commands.options import UsageError
from roomba.commands.output import tell_tables, write_json
from roomba.commands.process_end import quiet_loading
from roomba.commands.progress import Show, progress

if TYPE_CHECKING:
    from roomba.commands.map.runs import MapRun, MapScene, ObservedExplorer, RunObserver

_SHOWN: Final = 0.25
"""s between two updates of the progress."""


def main(arguments: list[str] | None = None) -> int:
    """Do what a command line asks for; returns the exit status."""
    return guarded(lambda: _explore(options_of(_without_bag(arguments))), PROGRAM, USAGE)


def _without_bag(arguments: list[str] | None) -> list[str] | None:
    """Refuse a recording, which has a command of its own; raises UsageError."""
    words = sys.argv[1:] if arguments is None else arguments
    if any(word == "--bag" or word.startswith("--bag=") for word in words):
        raise UsageError(
            f"--bag: expected a home to explore, got a recording; call {PROGRAM} --bag"
        )
    return arguments


def _explore(options: MapOptions) -> int:
    # Imported here: it takes a second, and a mistyped option should be reported at once.
    with quiet_loading(), nothing_thrown_away():
        from roomba.commands.compiling import compiling_counted
        from roomba.commands.first_use import require_compiled
        from roomba.commands.map.runs import MapScene

    require_compiled(is_quiet=options.output.quiet)
    scene = MapScene(options.trial)
    with (
        progress("Exploring", options.output.quiet) as show,
        compiling_counted(lambda words: show(0.0, words)),
    ):
        run = scene.run([_shown_by(show, scene)])
    _tell_run(options.output, run)
    return COMPLETED if run.is_completed else ENDED_OTHERWISE


def _shown_by(show: Show, scene: MapScene) -> RunObserver:
    import numpy as np

    from roomba.commands.output import clock
    from roomba.grid import FREE

    all_of_it = float(np.count_nonzero(scene.seen)) * scene.home.frame.resolution**2
    looked = time.monotonic()

    def observe(robot: ObservedExplorer) -> None:
        nonlocal looked
        if time.monotonic() - looked < _SHOWN:
            return
        looked = time.monotonic()
        known = robot.mission.context.occupancy
        area = float(np.count_nonzero(known.values == FREE)) * known.frame.resolution**2
        phase = robot.mission.state.phase.value
        show(min(area / all_of_it, 1.0), f"{area:.0f} m², {clock(robot.seen.time)}, {phase}")

    return observe


def _tell_run(output: Output, run: MapRun) -> None:
    from roomba.commands.map.files import write_files
    from roomba.commands.map.json_file import run_as_json
    from roomba.commands.map.report import error_table, run_table

    if output.out is not None:
        write_files(output.out, run.made.occupancy, run.station)
    if output.plot is not None:
        from roomba.commands.map.plot import write_plot

        write_plot(output.plot, run)
    tell_tables([run_table(run), error_table(run)], output.json, quiet=output.quiet)
    if output.json is not None:
        write_json(output.json, run_as_json(run))
