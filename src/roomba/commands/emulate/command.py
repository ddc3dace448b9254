"""``./roomba emulate``: a made-up robot or lidar on a pseudo terminal, for programs that use it."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from pathlib import Path
from typing import Final

from roomba.commands.emulate.making import BAUD, LD19_BAUD, MADE_UP
from roomba.commands.options import MOST_SEED, Parser, UsageError, choice, number, whole
from roomba.commands.process_end import ending_signals
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError

PROGRAM: Final = spelled("emulate")
_DONE, _USAGE = 0, 2
_SLOW_BAUD: Final = 19_200
"""The baud rate at which a robot starts after its button asked for it."""
_MOST_PORT: Final = 65_535
_SPEEDS: Final = (0.1, 20.0)
_speed = number(
    lambda value: _SPEEDS[0] <= value <= _SPEEDS[1],
    f"a number from {_SPEEDS[0]:g} to {_SPEEDS[1]:g}",
)


def main(arguments: list[str] | None = None) -> int:
    """Let the robot live until Ctrl-C; returns the exit status, 2 for wrong usage."""
    try:
        given = _parser().parse_args(arguments)
        return _live(given)
    except (UsageError, RoombaError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return _USAGE


def _live(given: argparse.Namespace) -> int:
    is_over = threading.Event()
    for ending in ending_signals():
        signal.signal(ending, lambda *_: is_over.set())
    with MADE_UP[given.robot](given) as told:
        print(f"{told} Ctrl-C ends it.")
        sys.stdout.flush()
        is_over.wait()
    return _DONE


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        "A robot that people own, made up: a robot in a simulated home that speaks the protocol of "
        "one on a pseudo terminal, for programs that drive such robots. An LD19 alone stands where "
        "a robot would charge.",
        "What it knows of the protocol: docs/real_robots.md. Exit status: 0 after Ctrl-C, 2 for "
        "wrong usage.",
    )
    parser.add_argument("robot", choices=tuple(MADE_UP), help="which robot, or lidar")
    parser.add_argument(
        "--model",
        type=choice("botvac", "xv11"),
        default="botvac",
        metavar="botvac|xv11",
        help="neato: whose labels it has: Botvac D3 to D7 (default), or XV-11",
    )
    parser.add_argument(
        "--home", default="studio", metavar="NAME|FOLDER", help="where it lives (default: studio)"
    )
    parser.add_argument("--seed", type=whole(0, MOST_SEED), default=0, metavar="N")
    parser.add_argument(
        "--link", type=Path, metavar="NAME", help="a link to the line, to find it by a fixed name"
    )
    parser.add_argument(
        "--lidar-link",
        type=Path,
        metavar="NAME",
        help="create2: the same for the line of its lidar, an LD19",
    )
    parser.add_argument(
        "--baud",
        type=int,
        choices=(BAUD, _SLOW_BAUD),
        default=BAUD,
        help=f"create2: the rate at which it starts, with --serial (default: {BAUD})",
    )
    parser.add_argument(
        "--sleeps",
        action="store_true",
        help="create2: asleep after five minutes in passive mode, as a real one; a pseudo terminal "
        "has no BRC, so the signal USR1 is its button, which wakes it",
    )
    parser.add_argument(
        "--port",
        type=whole(0, _MOST_PORT),
        default=0,
        metavar="N",
        help="openneato: of its HTTP server, on this machine alone (default: any that is free)",
    )
    parser.add_argument(
        "--serial",
        action="store_true",
        help=f"as slow as a serial line: {BAUD} baud, {LD19_BAUD} of an LD19; without it as "
        "quick as USB",
    )
    parser.add_argument(
        "--speed",
        type=_speed,
        default=1.0,
        metavar="N",
        help="seconds of its home in one, the line's timing included (default: 1)",
    )
    return parser
