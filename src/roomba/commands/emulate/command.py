"""``./roomba emulate neato``: a made-up robot on a pseudo terminal, for programs that drive it."""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from pathlib import Path
from typing import Final

from roomba.commands.options import MOST_SEED, Parser, UsageError, choice, number, whole
from roomba.commands.spelling import spelled
from roomba.errors import RoombaError

PROGRAM: Final = spelled("emulate")
BAUD: Final = 115_200
_DONE, _USAGE = 0, 2
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
    from roomba.configuration.simulation import load_simulated_config
    from roomba.emulators.neato.dialects import Model
    from roomba.emulators.neato.robot import NeatoRobot, made_up
    from roomba.emulators.neato.server import NeatoServer
    from roomba.emulators.pseudo_terminal import PseudoTerminal
    from roomba.files.shipped import CONFIGURATION, HOMES
    from roomba.world.layers.layer import load_home
    from roomba.world.simulator import Simulator

    robots = CONFIGURATION / "robots"
    config = load_simulated_config(robots / "neato.yaml", CONFIGURATION / "simulation.yaml")
    config = made_up(config)
    simulator = Simulator(load_home(given.home, HOMES, config.body), config, seed=given.seed)
    robot = NeatoRobot(simulator, Model(given.model))
    line = PseudoTerminal(given.link, round(BAUD * given.speed) if given.serial else None)
    is_over = threading.Event()
    for ending in (signal.SIGINT, signal.SIGTERM):
        signal.signal(ending, lambda *_: is_over.set())
    try:
        with NeatoServer(robot, line, given.speed):
            where = given.link or line.name
            print(f"A Neato lives in the home {given.home}, on {where}. Ctrl-C ends it.")
            sys.stdout.flush()
            is_over.wait()
    finally:
        line.close()
    return _DONE


def _parser() -> Parser:
    parser = Parser(
        PROGRAM,
        "A robot that people own, made up: a robot in a simulated home that speaks the protocol of "
        "one on a pseudo terminal, for programs that drive such robots.",
        "What it knows of the protocol: docs/real_robots.md.",
    )
    parser.add_argument("robot", choices=("neato",), help="which robot")
    parser.add_argument(
        "--model",
        type=choice("botvac", "xv11"),
        default="botvac",
        metavar="botvac|xv11",
        help="whose labels it has: Botvac D3 to D7 (default), or XV-11",
    )
    parser.add_argument(
        "--home", default="studio", metavar="NAME|FOLDER", help="where it lives (default: studio)"
    )
    parser.add_argument("--seed", type=whole(0, MOST_SEED), default=0, metavar="N")
    parser.add_argument(
        "--link", type=Path, metavar="NAME", help="a link to the line, to find it by a fixed name"
    )
    parser.add_argument(
        "--serial",
        action="store_true",
        help=f"as slow as a serial line of {BAUD} baud; without it as quick as USB",
    )
    parser.add_argument(
        "--speed",
        type=_speed,
        default=1.0,
        metavar="N",
        help="seconds of its home in one, the line's timing included (default: 1)",
    )
    return parser
