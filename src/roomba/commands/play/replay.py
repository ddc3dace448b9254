"""``roomba replay``: a recorded run on the page, with a time line."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

from roomba.commands.options import HelpfulParser, folder
from roomba.commands.play.serving import add_page_options, listen_at, serve_page
from roomba.commands.play.told_to_end import ToldToEnd
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError
from roomba.history.database import LAST, History
from roomba.history.folder import history_folder
from roomba.history.replay import RecordedRobot
from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_file import read_run

PROGRAM: Final = spelled("replay")


def main(arguments: list[str] | None = None) -> int:
    """Show a run until Ctrl-C; returns 0, or 2 for one that cannot be read."""
    wanted = _parser().parse_args(arguments)
    ending = ToldToEnd()
    try:
        figures, recording = _run_of(wanted.run, History(wanted.history or history_folder()))
        robot = RecordedRobot(figures, recording)
        bound = listen_at(wanted)
        robot.play(is_playing=True)
        told = f"A recorded run of {figures.source.home!r}. Its page:"
        serve_page(robot, bound, told, ending, is_opened=wanted.open)
    except RoombaError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 0
    return 0


def _run_of(word: str, history: History) -> tuple[RunFigures, RunRecording]:
    if word == LAST or word.isdecimal():
        run = history.named(word)
        return run.figures, history.recording(run.number)
    return read_run(Path(word).expanduser())


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="Show a recorded run on a page, with a time line to drag. Nothing is driven.",
        epilog="Exit status: 0 after Ctrl-C, 2 for wrong usage, and for a run that there is not or "
        "that cannot be read. Bags (./roomba record) are played by rosbag play, or exported.",
    )
    parser.add_argument(
        "run",
        nargs="?",
        default=LAST,
        metavar="RUN|FILE.run",
        help=f"a run's number in the list of report, {LAST} (default) for the newest, or a file of "
        "report --recording",
    )
    parser.add_argument(
        "--history", type=folder, metavar="FOLDER", help="where the runs are (default: the own)"
    )
    add_page_options(parser)
    return parser
