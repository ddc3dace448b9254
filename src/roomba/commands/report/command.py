"""``roomba report``: the recorded runs as tables, CSV and HTML."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final, TextIO

from rich.console import Console

from roomba.commands.options import STANDARD_OUTPUT, HelpfulParser, folder
from roomba.commands.output import tell_tables, told_width, write_json
from roomba.commands.program_name import spelled
from roomba.commands.report.table import csv_of, json_of, run_table, runs_table, weeks_table
from roomba.errors import RoombaError
from roomba.files.atomic import write_output
from roomba.history.database import LAST, History
from roomba.history.folder import history_folder
from roomba.history.report.document import comparison_of, report_of
from roomba.history.run import RunRecording
from roomba.history.run_file import write_run
from roomba.history.run_rows import KeptRun

PROGRAM: Final = spelled("report")
_LISTED: Final = 20
"""The most runs that the list on a terminal has."""


def main(arguments: list[str] | None = None) -> int:
    """Print the runs; returns 0, 1 if a file cannot be written, 2 for a run that is not there.

    Raises BrokenPipeError, when the reader of the output has closed it.
    """
    wanted = _parser().parse_args(arguments)
    if wanted.run is None and wanted.json is not None and _is_run(wanted.json):
        print(
            f"{PROGRAM}: --json: expected a file, got {wanted.json!r}; put the run first: "
            f"{PROGRAM} {wanted.json} --json",
            file=sys.stderr,
        )
        return 2
    history = History(wanted.history or history_folder())
    try:
        _tell(wanted, history)
    except BrokenPipeError:  # the reader has had enough
        raise
    except (RoombaError, OSError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2 if isinstance(error, RoombaError) else 1
    finally:
        if history.set_aside is not None:
            print(f"{PROGRAM}: damaged, and set aside: {history.set_aside}", file=sys.stderr)
    return 0


def _tell(wanted: argparse.Namespace, history: History) -> None:
    _write_figures(wanted, history)
    if _wants_figures_alone(wanted):
        return
    if wanted.compare is not None:
        one, other = (history.named(word) for word in wanted.compare)
        text = comparison_of((one, _recording(history, one)), (other, _recording(history, other)))
        _write_document(wanted, Path(f"compare-{one.number}-{other.number}.html"), text)
        return
    if wanted.run is None and wanted.out is None and wanted.recording is None:
        _list(history)
        return
    _report(wanted, history, history.named(wanted.run or LAST))


def _write_figures(wanted: argparse.Namespace, history: History) -> None:
    """Write the figures of runs for programs."""
    if wanted.csv is not None:
        _write(wanted.csv, csv_of(_all(history)))
    if wanted.json is not None:
        runs = _all(history) if wanted.run is None else [history.named(wanted.run)]
        write_json(wanted.json, json_of(runs))


def _is_run(word: str) -> bool:
    """Whether a word names a run; after ``--json`` it was meant to stand before."""
    return word == LAST or word.isdecimal()


def _wants_figures_alone(wanted: argparse.Namespace) -> bool:
    if any(each is not None for each in (wanted.compare, wanted.out, wanted.recording)):
        return False
    return wanted.json is not None or (wanted.csv is not None and wanted.run is None)


def _report(wanted: argparse.Namespace, history: History, run: KeptRun) -> None:
    recording = _recording(history, run)
    tell_tables([run_table(run)], _taken_output(wanted), quiet=False)
    if wanted.recording is not None:
        write_run(run.figures, recording or history.recording(run.number), wanted.recording)
        print(f"Recording: {wanted.recording}", file=_told_to(wanted))
    others = history.runs(home=run.figures.source.home)
    text = report_of(run, recording, others)
    _write_document(wanted, Path(f"run-{run.number}.html"), text)


def _all(history: History) -> Sequence[KeptRun]:
    return history.runs(limit=1_000_000)


def _list(history: History) -> None:
    runs = _all(history)
    if not runs:
        print(
            f"There are no runs yet in {history.path.parent}: ./roomba sim makes one, and each "
            "clean of ./roomba play and run."
        )
        return
    newest = runs_table(runs[:_LISTED], told_width(Console()))
    tell_tables([newest, weeks_table(runs)], None, quiet=False)
    if len(runs) > _LISTED:
        print(f"{len(runs) - _LISTED} older runs are in --csv.")


def _recording(history: History, run: KeptRun) -> RunRecording | None:
    return history.recording(run.number) if run.is_recorded else None


def _write_document(wanted: argparse.Namespace, usual: Path, text: str) -> None:
    path = wanted.out or usual
    _write(path, text)
    print(f"Report: {path}", file=_told_to(wanted))


def _told_to(wanted: argparse.Namespace) -> TextIO:
    """Return the stream for people's text: standard error if figures take standard output."""
    return sys.stderr if _taken_output(wanted) else sys.stdout


def _taken_output(wanted: argparse.Namespace) -> str | None:
    """Return ``-`` if figures or the report take standard output, else None."""
    files = (wanted.json, str(wanted.csv), str(wanted.out))
    return STANDARD_OUTPUT if STANDARD_OUTPUT in files else None


def _write(path: Path, text: str) -> None:
    if str(path) == STANDARD_OUTPUT:
        sys.stdout.write(text)
    elif path.is_dir():
        raise IsADirectoryError(f"{path}: expected a file, got a folder; choose another name")
    else:
        write_output(path, text.encode())


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="Tell of the runs that sim, play and run kept. Without a run: a list of the "
        "newest ones, and totals by week. With one: its report, an HTML file that stands alone.",
        epilog="Exit status: 0 when it was told, 1 when a file cannot be written, 2 for wrong "
        "usage, and for a run that there is not.",
    )
    parser.add_argument(
        "run", nargs="?", metavar="RUN", help=f"its number in the list, or {LAST} for the newest"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE.html|-", help="the report (default: run-RUN.html)"
    )
    parser.add_argument("--compare", nargs=2, metavar=("A", "B"), help="two runs in one report")
    parser.add_argument("--csv", type=Path, metavar="FILE|-", help="all runs, for programs")
    parser.add_argument(
        "--json",
        nargs="?",
        const=STANDARD_OUTPUT,
        metavar="FILE|-",
        help="all runs, or RUN alone, for programs; -, or nothing: standard output",
    )
    parser.add_argument(
        "--recording",
        type=Path,
        metavar="FILE.run",
        help="also the run as a file, to replay elsewhere",
    )
    parser.add_argument(
        "--history", type=folder, metavar="FOLDER", help="where the runs are (default: the own)"
    )
    return parser
