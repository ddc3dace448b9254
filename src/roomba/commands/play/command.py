"""``roomba play``: the page over a robot that lives in a simulated home, or over one's own."""

from __future__ import annotations

import argparse
import contextlib
import shlex
import socket
import sys
from pathlib import Path
from typing import Final

from roomba.commands.exit_status import COMPLETED, USAGE
from roomba.commands.first_use import require_compiled
from roomba.commands.options import HelpfulParser
from roomba.commands.play.bumping import bumping_life
from roomba.commands.play.living import add_robot_options, wanted_robot
from roomba.commands.play.owned import (
    add_lidar_option,
    add_line_options,
    owned_life,
    require_fitting,
)
from roomba.commands.play.remote import remote_client
from roomba.commands.play.serving import add_page_options, listen_at, serve_page
from roomba.commands.play.told_to_end import ToldToEnd
from roomba.commands.program_name import spelled
from roomba.configuration.frozen import load_config
from roomba.configuration.household import HouseholdConfig
from roomba.configuration.mapping import MappingConfig
from roomba.errors import RoombaError
from roomba.files.shipped import CONFIGURATION
from roomba.headless.live.bumping.client import BumpingClient
from roomba.headless.live.client import LiveClient
from roomba.headless.live.kept_floor_plan import FOLDER as FLOOR_PLANS
from roomba.headless.live.remote.client import RemoteClient
from roomba.history.database import History
from roomba.history.folder import history_folder
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunSource
from roomba.household.folder import household_folder
from roomba.household.household import LiveHousehold
from roomba.storage.kept_stop import FOLDER as STOPS
from roomba.ui.smart_home.switch import Switched, switched_on

PROGRAM: Final = spelled("play")


def main(arguments: list[str] | None = None) -> int:
    """Let a robot live until Ctrl-C; returns 0, or 2 for wrong usage."""
    parser = _parser()
    wanted = parser.parse_args(arguments)
    require_fitting(parser, wanted)
    # By this, a robot on a line is given back, however the program is told to end.
    ending = ToldToEnd()
    with contextlib.ExitStack() as until_end:
        try:
            if wanted.lidar != "none":  # without a lidar nothing of it is used
                require_compiled(is_quiet=False)
            client, source, told = _robot(wanted, until_end, _repeat(arguments))
            file = wanted.smart_home
            smart_home = None if file is None else switched_on(client, file, _warn)
            bound = listen_at(wanted)
            _live(wanted, client, bound, source, told, ending, smart_home)
        except RoombaError as error:
            print(f"{PROGRAM}: {error}", file=sys.stderr)
            return USAGE
        except KeyboardInterrupt:
            return COMPLETED
    return COMPLETED


def _robot(
    wanted: argparse.Namespace, until_end: contextlib.ExitStack, repeat: str
) -> tuple[LiveClient | BumpingClient | RemoteClient, RunSource, str]:
    """Return the robot, where its runs come from, and a text for the user; raises RoombaError."""
    if wanted.robot is None:
        client = wanted_robot(wanted)
        until_end.callback(client.end)
        if wanted.map == "home":
            floors = load_config(MappingConfig, CONFIGURATION / "mapping.yaml").floors
            client.keep_plan(household_folder() / FLOOR_PLANS, floors, _warn)
        source = RunSource("play", wanted.home, wanted.seed, repeat)
        return client, source, f"The robot lives in {wanted.home!r}. Its page:"
    source = RunSource("play", wanted.robot, None, repeat)
    if remote := remote_client(wanted, _warn):
        until_end.callback(remote.end)
        return remote, source, f"Your {wanted.robot} on {wanted.line} cleans by itself. Its page:"
    life = bumping_life(wanted) if wanted.lidar == "none" else owned_life(wanted, _warn)
    until_end.callback(life.end)
    return life.client, source, f"Your {wanted.robot} on {wanted.line} is taken over. Its page:"


def _live(
    wanted: argparse.Namespace,
    client: LiveClient | BumpingClient | RemoteClient,
    bound: socket.socket,
    source: RunSource,
    told: str,
    ending: ToldToEnd,
    smart_home: Switched | None,
) -> None:
    """Let the robot live, with its household, history and page, until Ctrl-C."""
    keeper = HistoryKeeper(History(history_folder()), source, _warn)
    household = LiveHousehold(
        client,
        household_folder(),
        load_config(HouseholdConfig, CONFIGURATION / "household.yaml"),
        client.bin_capacity,
        _warn,
        keeper.totals,
    )
    client.keep_stop(household_folder() / STOPS)
    client.start()
    try:
        household.start()
        serve_page(
            client,
            bound,
            told,
            ending,
            is_opened=wanted.open,
            keeper=keeper,
            household=household,
            smart_home=smart_home,
        )
    finally:
        household.stop()


def _repeat(arguments: list[str] | None) -> str:
    return shlex.join([*PROGRAM.split(), *(sys.argv[1:] if arguments is None else arguments)])


def _warn(text: str) -> None:
    # A lost terminal must not end a thread that prints, nor interrupt how a robot is given back.
    with contextlib.suppress(OSError):
        print(f"{PROGRAM}: {text}", file=sys.stderr, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="A robot in a simulated home, or one that you own on its line, without ROS: "
        "seen and commanded on a page, whose address is printed. Its runs are kept (./roomba "
        "report), and the map that a robot of yours made.",
        epilog="Exit status: 0 after Ctrl-C, 2 for wrong usage.",
    )
    add_robot_options(parser)
    add_line_options(parser)
    add_lidar_option(parser)
    add_page_options(parser)
    parser.add_argument(
        "--smart-home",
        type=Path,
        metavar="FILE.yaml",
        help="MQTT with Home Assistant, and a webhook, as the file says (docs/smart_home.md)",
    )
    return parser
