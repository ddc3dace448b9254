"""Parsers of command lines, with one spelling of the options that several commands share."""

from __future__ import annotations

import argparse
import math
import os
import re
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NoReturn, TypeAlias

from roomba.errors import RoombaError

Named: TypeAlias = tuple[str, Path | None]
"""An option, and the file that it names."""
MOST_SEED: Final = 2**63 - 1
STANDARD_OUTPUT: Final = "-"
"""The file name that stands for standard output."""
_HELP: Final = ("-h", "--help")


class UsageError(RoombaError):
    """A command line that cannot be obeyed; the message says what was expected, and came."""


class HelpfulParser(argparse.ArgumentParser):
    """Prints the help for ``--help`` anywhere on the line, even where a value is due."""

    def parse_args(self, args: Sequence[str] | None = None) -> argparse.Namespace:  # type: ignore[override]
        """Parse a command line; raises SystemExit for ``--help`` and for wrong usage."""
        words = sys.argv[1:] if args is None else args
        is_help_due = any(word in _HELP for word in words)
        return super().parse_args(["--help"] if is_help_due else words)


class Parser(HelpfulParser):
    """Refuses in one line, by UsageError, and reads negative numbers as values."""

    def __init__(self, program: str, description: str, epilog: str) -> None:
        """Expect the options of the command that is spelled ``program``."""
        super().__init__(prog=program, allow_abbrev=False, description=description, epilog=epilog)
        # Python's own pattern knows no exponents: it would take -1e-05 for an option.
        self._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")

    def error(self, message: str) -> NoReturn:
        """Raise UsageError."""
        raise UsageError(f"{message}; see {self.prog} --help")

    def add_told(self, figures: str, picture: str) -> argparse._ArgumentGroup:
        """Add ``--json``, ``--plot`` and ``--quiet``; return their group.

        ``figures`` and ``picture`` say what the file of figures, and the picture, are of.
        """
        told = self.add_argument_group("what is told")
        told.add_argument(
            "--json",
            nargs="?",
            const=STANDARD_OUTPUT,
            metavar="FILE|-",
            help=f"{figures}, for programs; -, or nothing: standard output",
        )
        told.add_argument("--plot", type=Path, metavar="FILE.png", help=picture)
        told.add_argument("--quiet", action="store_true", help="no progress and no table")
        return told


def whole(least: int, most: int) -> Callable[[str], int]:
    """Return the type of an option that is a whole number from ``least`` to ``most``."""

    def number_of(text: str) -> int:
        number = int(text) if re.fullmatch(r"[+-]?\d{1,20}", text) else least - 1
        if not least <= number <= most:
            raise argparse.ArgumentTypeError(
                f"expected a whole number from {least} to {most}, got {text!r}"
            )
        return number

    return number_of


def choice(*choices: str) -> Callable[[str], str]:
    """Return the type of an option that is one of some words."""

    def choice_of(text: str) -> str:
        if text not in choices:
            raise argparse.ArgumentTypeError(f"expected {', '.join(choices)}, got {text!r}")
        return text

    return choice_of


def number(is_right: Callable[[float], bool], expected: str) -> Callable[[str], float]:
    """Return the type of an option that is a number; ``expected`` says which ones are right."""

    def number_of(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not is_right(value):
            raise argparse.ArgumentTypeError(f"expected {expected}, got {text!r}")
        return value

    return number_of


finite = number(math.isfinite, "finite numbers (m, rad)")


def folder(text: str) -> Path:
    """Return the folder that an option names: the type of one that is read."""
    if not os.path.isdir(text):  # False, too, for a name that is too long
        raise argparse.ArgumentTypeError(f"expected a folder that is there, got {text!r}")
    return Path(text)


def file_of(name: str | None) -> Path | None:
    """Return the file to write figures to; None for standard output."""
    return None if name in (None, STANDARD_OUTPUT) else Path(str(name))


def check_config(path: Path | None) -> None:
    """Refuse a ``--config`` that is not there; raises UsageError."""
    if path is not None and not path.is_file():
        raise UsageError(f"--config: expected a file like robot.yaml, got {path}")


def check_written(written: Sequence[Named], read: Sequence[Named]) -> None:
    """Refuse files that cannot be written, before the work is done; raises UsageError.

    ``read`` are options with files that must not be overwritten.
    """
    used = {path.expanduser().resolve(): option for option, path in read if path is not None}
    for option, path in written:
        if path is None:
            continue
        if option == "--plot" and path.suffix.lower() != ".png":
            raise UsageError(f"--plot: expected a name that ends with .png, got {path}")
        if path.is_dir() or not path.absolute().parent.is_dir():
            raise UsageError(f"{option}: expected a file in a folder that is there, got {path}")
        if not _is_writable(path):
            raise UsageError(f"{option}: expected a file that can be written, got {path}")
        other = used.setdefault(path.resolve(), option)
        if other != option:
            raise UsageError(f"{option}: {path} is the file of {other} already; choose another one")


def _is_writable(path: Path) -> bool:
    """Whether a file can be written, or created."""
    if path.exists():
        return os.access(path, os.W_OK)
    try:
        with tempfile.TemporaryFile(dir=path.absolute().parent):
            return True
    except OSError:
        return False
