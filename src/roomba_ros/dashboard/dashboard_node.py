"""The node that serves the web page."""

from __future__ import annotations

import os
import shlex
import socket
from pathlib import Path

import rospy
from std_msgs.msg import Bool

from roomba.client.ports import DEFAULT_PORT, OUTSIDE_ADDRESS, PAGE_SOCKET
from roomba.client.protocol import RequestRefusedError
from roomba.configuration.frozen import load_config
from roomba.configuration.household import HouseholdConfig
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION
from roomba.history.database import History
from roomba.history.folder import history_folder
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunSource
from roomba.household.folder import household_folder
from roomba.household.household import LiveHousehold
from roomba.ui.desktop import open_on_desktop
from roomba.ui.smart_home.switch import Switched, switched_on
from roomba.ui.web.addresses import ALL, addresses_of, guard_for, is_host
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import LOOPBACK
from roomba.ui.web.kept_token import kept_token
from roomba.ui.web.server import PageServer, listen
from roomba_ros.convert.values import data_of
from roomba_ros.dashboard.graph_robot import GraphRobot
from roomba_ros.rosbridge.bridge import RosBridge
from roomba_ros.runtime.node import run_node
from roomba_ros.runtime.parameters import read_robot_config
from roomba_ros.runtime.subscriptions import subscribe

_PERIOD = 0.05
"""s of the ROS clock between two twists while a person drives the robot by hand."""
_REPEATED = ("sensors", "wheels")
"""Parameters that belong to the command that repeats a run, where they differ from the defaults."""
_ANY = -1
"""The value of ``~port`` for the first free port."""


class DashboardNode:
    """Serves the page, and prints its address with the token that commands need.

    If :data:`PAGE_SOCKET` names a socket, the node serves there: the socket of an isolated robot,
    which is reached from outside its network.

    Upkeep and plans are those of :class:`LiveHousehold`; subscribes ``person_at_home``.

    Programs reach the graph over the same server, by rosbridge. Publishes, subscribes and calls
    what :class:`GraphRobot` does, and what programs ask :class:`RosBridge` for.
    Parameters: ``~port`` (by default -1: 8400, or the next that is free; 0: any), ``~host`` (by
    default 127.0.0.1, this machine alone; 0.0.0.0: the network as well), ``~home``, ``~seed``,
    ``~sensors``, ``~wheels`` (what runs are kept under in the history, and repeated by),
    ``~open`` (whether a browser is opened, once, where there is a desktop; by default not),
    ``~smart_home`` (the file of the smart home that the robot is in, empty for none).
    """

    period = _PERIOD

    def start(self) -> None:
        """Connect and serve; raises RoombaError.

        It is raised when no port is free, or for a wrong file of the smart home.
        """
        config, keeper = read_robot_config(), _keeper()
        self._robot = GraphRobot(config)
        self._robot.start()
        self._household = LiveHousehold(
            self._robot,
            household_folder(),
            load_config(HouseholdConfig, CONFIGURATION / "household.yaml"),
            config.brush.bin_capacity,
            rospy.logwarn,
            keeper.totals,
        )
        self._household.start()
        subscribe("person_at_home", Bool, data_of, self._on_person)
        bound = _bound()
        guard = guard_for(kept_token(), bound.getsockname()[0])
        app = create_app(self._robot, guard, keeper, RosBridge(), self._household)
        self._server = PageServer(app, bound)
        self._server.start()
        self._smart_home = _smart_home(self._robot)
        if self._smart_home is not None:
            self._smart_home.start()
        # Printed, not logged: every program on the graph can read the log.
        address, *others = addresses_of(bound, guard.token, os.environ.get(OUTSIDE_ADDRESS, ""))
        print(f"The page: {address}", flush=True)
        for other in others:
            print(f"The page, from other machines of the network: {other}", flush=True)
        _open_once(address)

    def _on_person(self, is_home: bool) -> None:
        try:
            self._household.set_person_home(is_home=is_home)
        except RequestRefusedError as refusal:
            rospy.logwarn("whether a person is at home: %s", refusal)

    def tick(self, _: float) -> None:
        """Publish the twist that the person on the page wants, if there is one."""
        self._robot.tick()

    def stop(self) -> None:
        """Stop the drive, leave the smart home, and save what is not saved yet."""
        self._robot.stop_hand()
        if self._smart_home is not None:
            self._smart_home.stop()
        self._household.stop()


def _keeper() -> HistoryKeeper:
    home, seed = str(rospy.get_param("~home", "home")), rospy.get_param("~seed", None)
    known = seed if isinstance(seed, int) else None
    words = [f"home:={home}"] + ([] if known is None else [f"seed:={known}"])
    words += [
        f"{name}:={value}" for name in _REPEATED if (value := rospy.get_param(f"~{name}", ""))
    ]
    source = RunSource("ros", home, known, shlex.join(["./roomba", "run", *words]))
    return HistoryKeeper(History(history_folder()), source, rospy.logwarn)


def _smart_home(robot: GraphRobot) -> Switched | None:
    file = str(rospy.get_param("~smart_home", ""))
    return switched_on(robot, Path(file).expanduser(), rospy.logwarn) if file else None


def _open_once(address: str) -> None:
    """Open the page on the desktop, unless an earlier one of this node did."""
    # An isolated robot has a network of its own, from which no browser reaches the page.
    if PAGE_SOCKET in os.environ or not rospy.get_param("~open", False):
        return
    rospy.set_param("~open", False)
    open_on_desktop(address)


def _bound() -> socket.socket:
    """Return the socket that this node was given, or a new one that listens in this network."""
    given = os.environ.get(PAGE_SOCKET)
    if given is not None:
        return socket.socket(fileno=int(given))
    port = _port()
    return listen(_host(), DEFAULT_PORT if port == _ANY else port, is_fixed=port != _ANY)


def _host() -> str:
    host = rospy.get_param("~host", LOOPBACK[0])
    if not isinstance(host, str) or not is_host(host):
        raise ConfigError(
            f"parameter ~host: expected an address of this machine, such as {ALL}, got {host!r}"
        )
    return host


def _port() -> int:
    port = rospy.get_param("~port", _ANY)
    if not isinstance(port, int) or isinstance(port, bool) or not _ANY <= port <= 65535:
        raise ConfigError(f"parameter ~port: expected -1, or a port up to 65535, got {port!r}")
    return port


def main() -> None:
    """Run the node."""
    run_node("dashboard_node", DashboardNode)
