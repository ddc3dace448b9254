"""``./roomba export valetudo HOME``: a map of Valetudo from a home."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Final

from roomba.commands.program_name import spelled
from roomba.commands.valetudo.homes import read_home
from roomba.commands.valetudo.options import parser_of, reason_of
from roomba.errors import RoombaError
from roomba.files.atomic import write_output
from roomba.files.valetudo.writing import compose

PROGRAM: Final = spelled("export")


def main(arguments: list[str] | None = None) -> int:
    """Write the file; returns 0, or 2 with the reason on standard error."""
    parser = parser_of(PROGRAM, "Make a map of Valetudo of a home.")
    parser.add_argument("home", metavar="NAME|PATH", help="as for sim --home")
    parser.add_argument("--out", type=Path, metavar="FILE.json", help="default: the home's name")
    given = parser.parse_args(arguments)
    file = given.out or Path(f"{Path(given.home).stem}.json")
    try:
        values = compose(read_home(given.home))
        write_output(file, json.dumps(values, ensure_ascii=False).encode())
    except (RoombaError, OSError) as error:
        print(f"{PROGRAM}: {given.home}: {reason_of(error)}", file=sys.stderr)
        return 2
    print(f"{file}: {len(values['layers'])} layers, {len(values['entities'])} entities")
    return 0
