"""``roomba status``: what the robot does now, in words or as JSON, once or again and again."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
import time
from collections.abc import Iterable
from typing import Any, Final

from rich.console import Console
from rich.live import Live

from roomba.client.ports import DEFAULT_PORT, LAST_PORT, PORTS
from roomba.commands.options import HelpfulParser, whole
from roomba.commands.output import named_table
from roomba.commands.program_name import spelled
from roomba.commands.status.asking import NoRobotError, find_robot, state_at
from roomba.ui.state_words import lines_of

PROGRAM: Final = spelled("status")
_PERIOD: Final = 1.0
"""s of wall time between two looks."""


def main(arguments: list[str] | None = None) -> int:
    """Tell the state; returns 0, or 1 when no robot answers."""
    wanted = _parser().parse_args(arguments)
    try:
        port = find_robot(PORTS if wanted.port is None else (wanted.port,))
        with contextlib.suppress(KeyboardInterrupt):
            _tell(port, is_json=wanted.json, is_watched=wanted.watch)
    except NoRobotError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    return 0


def _tell(port: int, *, is_json: bool, is_watched: bool) -> None:
    """Tell the state once, or each second until Ctrl-C; raises NoRobotError."""
    if is_json:
        for state in _states(port, is_watched=is_watched):
            print(json.dumps(state), flush=True)
        return
    console = Console()
    if is_watched and console.is_terminal:
        with Live(console=console, auto_refresh=False) as live:
            for state in _states(port, is_watched=True):
                live.update(named_table(lines_of(state)), refresh=True)
        return
    for state in _states(port, is_watched=is_watched):
        console.print(named_table(lines_of(state)), highlight=False, soft_wrap=True)


def _states(port: int, *, is_watched: bool) -> Iterable[dict[str, Any]]:
    yield state_at(port)
    while is_watched:
        time.sleep(_PERIOD)
        yield state_at(port)


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="What the robot does now: one of ./roomba run, or of ./roomba play.",
        epilog="Exit status: 0 when it was told, 1 when no robot answers, 2 for wrong usage.",
    )
    parser.add_argument("--json", action="store_true", help="for a program to read")
    parser.add_argument(
        "--watch", action="store_true", help="again each second, until Ctrl-C; JSON: a line each"
    )
    parser.add_argument(
        "--port",
        type=whole(1, LAST_PORT),
        metavar="N",
        help=f"that of its page (default: {DEFAULT_PORT}, or the next at which one answers)",
    )
    return parser
