"""What the command lines of import and export share."""

from __future__ import annotations

import argparse

from roomba.commands.options import HelpfulParser
from roomba.errors import RoombaError

FORMATS = ("valetudo",)
_GZIP = b"\x1f\x8b"
"""The first bytes of a gzip file."""


def parser_of(program: str, description: str) -> argparse.ArgumentParser:
    """Return a parser whose first word is the format."""
    parser = HelpfulParser(
        prog=program,
        allow_abbrev=False,
        description=description,
        epilog="Exit status: 0 written, 2 refused, with the reason.",
    )
    parser.add_argument("format", choices=FORMATS)
    return parser


def reason_of(error: Exception) -> str:
    """Return a line with the reason why a file was refused."""
    if isinstance(error, RoombaError):
        return " ".join(str(error).split())
    if isinstance(error, UnicodeDecodeError):
        if error.object.startswith(_GZIP):
            return "expected text in UTF-8, got a file that gzip packed; unpack it: gunzip FILE.gz"
        return "expected text in UTF-8; the map is the JSON of api/v2/robot/state/map"
    return str(getattr(error, "strerror", "") or error)
