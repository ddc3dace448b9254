"""``roomba export FILE --to mcap|ros2``: a recording for Foxglove or ROS 2, types included."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

from roomba.commands.options import HelpfulParser
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError
from roomba.recordings.bags.exporting import Form, export_bag

PROGRAM: Final = spelled("export")


def main(arguments: list[str] | None = None) -> int:
    """Write the export; returns 0, or 2 with the reason on standard error."""
    given = _parser().parse_args(arguments)
    form = Form(given.to)
    source: Path = given.file
    target = given.out or source.with_suffix(".mcap" if form is Form.MCAP else "")
    try:
        mended = export_bag(source, target, form)
    except (RoombaError, OSError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    if mended is not None:
        print(
            f"{source}: it was cut short, or is still being recorded; exported are the "
            f"{mended.messages} messages that are whole, left out {mended.torn} bytes of a torn end"
        )
    print(target)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="A recording for other programs, with the types of its messages. Of one "
        "that was cut short what is whole is exported. (export valetudo HOME: a home as a map.)",
        epilog="Exit status: 0 when it was written, 2 when it was not, with the reason; nothing "
        "is overwritten.",
    )
    parser.add_argument(
        "file", type=Path, metavar="FILE.bag", help="of ./roomba record, or of rosbag"
    )
    parser.add_argument(
        "--to",
        required=True,
        choices=[form.value for form in Form],
        help="mcap: one file, which Foxglove and Lichtblick open; ros2: a folder for ros2 bag",
    )
    parser.add_argument(
        "--out", type=Path, metavar="PATH", help="where to (default: beside it, by its name)"
    )
    return parser
