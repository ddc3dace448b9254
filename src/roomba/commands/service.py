"""``./roomba service``: the robot of ``./roomba run`` as a service of systemd, started at boot."""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from roomba.client.ports import DEFAULT_PORT, LAST_PORT
from roomba.commands.options import HelpfulParser, whole
from roomba.commands.process_end import quiet_end
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError
from roomba.files.atomic import write_whole

PROGRAM: Final = spelled("service")
UNITS: Final = ("roomba.service", "roomba.socket")
"""Unit files in ``launch``, with names between ``@`` that are replaced by values."""
FOLDER: Final = Path("/etc/systemd/system")
"""The folder of an administrator's units."""
_ARGUMENT: Final = re.compile(r"[A-Za-z_]\w*:=[\w./:+,-]*")
"""Arguments of this form need no quotes in a unit."""
_PATH: Final = re.compile(r"/[\w./+-]*")
_PATIENCE: Final = 60.0
"""s of wall time for one command of systemd."""


class ServiceError(RoombaError):
    """The service cannot be installed; the message says why, and what to do."""


Run = Callable[[Sequence[str]], None]
"""Runs a command; raises ServiceError when it fails."""


def units(repository: Path, port: int, arguments: Sequence[str]) -> dict[str, str]:
    """Return the text of each unit by its name; raises ServiceError for invalid arguments."""
    if not _PATH.fullmatch(str(repository)):
        raise ServiceError(
            f"expected a checkout whose path has letters, digits and ._+- alone, got {repository}"
        )
    for argument in arguments:
        if not _ARGUMENT.fullmatch(argument):
            raise ServiceError(
                f"expected arguments of `./roomba run` like home:=flat, got {argument!r}"
            )
    filled = {
        "@REPOSITORY@": str(repository),
        "@PORT@": str(port),
        "@ARGUMENTS@": "".join(f" {argument}" for argument in arguments),
    }
    texts = {}
    for name in UNITS:
        text = (repository / "launch" / name).read_text("utf-8")
        for mark, value in filled.items():
            text = text.replace(mark, value)
        texts[name] = text
    return texts


def install(texts: dict[str, str], folder: Path, run: Run) -> None:
    """Write the units, and start the service now and at each boot; raises ServiceError."""
    try:
        for name, text in texts.items():
            write_whole(folder / name, text.encode())
            # Users other than root may read how the service is run.
            (folder / name).chmod(0o644)
    except OSError as error:
        raise ServiceError(
            f"{folder}: expected to write units there: {error}; do it as root"
        ) from error
    run(["systemctl", "daemon-reload"])
    run(["systemctl", "enable", "--now", *UNITS])


def remove(folder: Path, run: Run) -> None:
    """Stop the service and forget it; what the robot keeps stays. Raises ServiceError."""
    if not any((folder / name).exists() for name in UNITS):
        raise ServiceError(f"expected {UNITS[0]} in {folder}, there is none; nothing to remove")
    run(["systemctl", "disable", "--now", *UNITS])
    try:
        for name in UNITS:
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise ServiceError(f"{folder}: expected to remove units: {error}; do it as root") from error
    run(["systemctl", "daemon-reload"])


def _run(command: Sequence[str]) -> None:
    try:
        subprocess.run(command, check=True, timeout=_PATIENCE)
    except (OSError, subprocess.SubprocessError) as error:
        raise ServiceError(f"expected `{' '.join(command)}` to succeed: {error}") from error


def main(arguments: Sequence[str] | None = None, run: Run = _run) -> int:
    """Show, install or remove the service; return 1 when that fails."""
    parser = HelpfulParser(prog=PROGRAM, description=__doc__)
    parser.add_argument("what", choices=("show", "install", "remove"))
    parser.add_argument("launch", nargs="*", metavar="name:=value", help="as for ./roomba run")
    parser.add_argument(
        "--port", type=whole(1, LAST_PORT), default=DEFAULT_PORT, help="of the page (%(default)s)"
    )
    parser.add_argument("--units", type=Path, default=FOLDER, help="the folder (%(default)s)")
    parser.add_argument("--repository", type=Path, required=True, help=argparse.SUPPRESS)
    given = parser.parse_args(arguments)
    try:
        if given.what == "remove":
            remove(given.units, run)
            return 0
        texts = units(given.repository, given.port, given.launch)
        if given.what == "show":
            print("\n".join(f"# {given.units / name}\n{text}" for name, text in texts.items()))
        else:
            install(texts, given.units, run)
            print(f"The page of the service: http://127.0.0.1:{given.port}/")
            print("What it prints: journalctl -u roomba")
    except RoombaError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
