"""Serving a page until Ctrl-C, with the address that is printed."""

from __future__ import annotations

import argparse
import contextlib
import socket
import sys
import webbrowser

from roomba.client.observed import ObservedRobot
from roomba.client.ports import DEFAULT_PORT
from roomba.history.recorder import HistoryKeeper
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.kept_token import kept_token
from roomba.ui.web.server import PageServer, listen


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """Add what is the same for every page: its port, and whether a browser is opened."""
    parser.add_argument(
        "--port", type=int, metavar="N", help=f"default: {DEFAULT_PORT}, or the next that is free"
    )
    parser.add_argument(
        "--no-open", dest="open", action="store_false", help="open no browser on the page"
    )


def listen_on(port: int | None) -> socket.socket:
    """Return a socket of a port, or of one that is free; raises ServerError."""
    return listen("127.0.0.1", port or DEFAULT_PORT, is_fixed=port is not None)


def serve_page(
    robot: ObservedRobot,
    bound: socket.socket,
    told: str,
    *,
    is_opened: bool,
    keeper: HistoryKeeper | None = None,
) -> None:
    """Print the address, and serve the page of a robot until Ctrl-C."""
    guard = Guard(kept_token())
    server = PageServer(create_app(robot, guard, keeper), bound)
    address = f"{server.address}#token={guard.token}"
    print(f"{told}\n\n    {address}\n\nCtrl-C ends it.")
    sys.stdout.flush()
    if is_opened:
        webbrowser.open(address)
    with contextlib.suppress(KeyboardInterrupt):
        server.serve()
