"""``./roomba import valetudo FILE.json``: a home's folder from a map of Valetudo."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from roomba.commands.program_name import spelled
from roomba.commands.trials.unreached import unreached_of
from roomba.commands.valetudo.homes import write_home
from roomba.commands.valetudo.options import parser_of, reason_of
from roomba.commands.valetudo.zones import taken_zones
from roomba.errors import RoombaError
from roomba.files.bounded import read_text
from roomba.files.home_layer import MAP_NAME
from roomba.files.valetudo.reading import parse

PROGRAM: Final = spelled("import")


def main(arguments: list[str] | None = None) -> int:
    """Write the folder; returns 0, or 2 with the reason on standard error."""
    parser = parser_of(PROGRAM, "Make a home's folder of a map of Valetudo.")
    parser.add_argument("file", type=Path, metavar="FILE.json")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="default: the file's name")
    given = parser.parse_args(arguments)
    folder = given.out or Path(given.file.stem)
    if folder.exists() and not folder.is_dir():
        parser.error(f"--out: expected a folder, or a new one, got the file {folder}")
    if (folder / MAP_NAME).exists():
        parser.error(f"--out: expected a folder without a home, got {folder}; choose another")
    try:
        found = parse(read_text(given.file))
        taken = taken_zones(found)
        home = write_home(found, taken.zones, folder)
    except (RoombaError, OSError, UnicodeDecodeError) as error:
        print(f"{PROGRAM}: {given.file}: {reason_of(error)}", file=sys.stderr)
        return 2
    put = "" if found.station is not None else ", where it was put: the map has no charger on it"
    print(
        f"{folder}: {home.map.free_area:.1f} m² of floor, {len(home.rooms)} rooms, {taken.words}, "
        f"station at ({home.station.x:.2f}, {home.station.y:.2f}){put}"
    )
    if words := unreached_of(home, taken.zones).words:
        print(words)
    print(f"to clean it: {spelled('sim')} --home {folder}")
    return 0
