"""``./roomba run``: the robot of the launch file, its processes watched."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
import tempfile
import uuid
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, NoReturn
from urllib.parse import urlparse

import rosgraph
import rospkg

from roomba.configuration.frozen import load_config
from roomba.configuration.nodes import NodesConfig
from roomba.errors import RoombaError
from roomba.files.home_layer import files_of_home
from roomba.files.shipped import CONFIGURATION, HOMES
from roomba_ros.maps.map_wish import FOLDER, require_map
from roomba_ros.runtime.graph.alone import living
from roomba_ros.runtime.graph.joining import require_own_address
from roomba_ros.runtime.graph.master import (
    UNANSWERED,
    MasterState,
    master_state,
    port_of,
    require_answering,
)
from roomba_ros.runtime.parameters import folder_for
from roomba_ros.runtime.senders import SUPERVISOR
from roomba_ros.supervision.claim import claim_robot
from roomba_ros.supervision.kept_master import be_master, wait_for_master
from roomba_ros.supervision.launch_file import Launch, ProcessEntry, described, read_launch
from roomba_ros.supervision.launch_parameters import set_parameters
from roomba_ros.supervision.launch_xml import launch_file, package_folder
from roomba_ros.supervision.scripts import be_node, import_for
from roomba_ros.supervision.supervisor import Supervisor
from roomba_ros.supervision.supervisor_node import be_supervisor_node

USAGE: Final = 2
"""The exit status for a wrong argument."""
_HOME: Final = "/home_sim_node/home"
"""The end of the full name of the parameter with the home."""
_MAP: Final = "/position_pub_node/map"
"""The end of the full name of the parameter with the map that the robot shall use."""
_MAPS_FOLDER: Final = "/position_pub_node/maps_folder"
"""The end of the full name of the parameter with the folder of saved maps."""
_WORDS: Final = "ROOMBA_LAUNCHING"
"""The environment variable with a text of ``./roomba``, printed once nothing was refused."""
_MASTER_WITHIN: Final = 20.0
"""s of wall time in which the master answers, on a busy machine too."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the robot until Ctrl-C; return the exit status."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    file = launch_file()
    try:
        if {"-h", "--help"} & set(given):
            print(f"usage: ./roomba run [--isolated] [name:=value ...]\n\n{described(file)}")
            return 0
        launch = read_launch(file, given)
        _require_home(launch)
        _require_map(launch)
        _require_host_of_master()
        require_own_address()
        _refuse_second(launch)
        claim = claim_robot(rosgraph.get_master_uri(), rosgraph.names.get_ros_namespace())
    except RoombaError as error:
        print(f"./roomba run: {error}", file=sys.stderr)
        return USAGE
    if words := os.environ.pop(_WORDS, ""):
        print(words, file=sys.stderr, flush=True)
    with claim:
        return _run(launch, package_folder() / "scripts")


def _run(launch: Launch, scripts: Path) -> int:
    run_id = str(uuid.uuid4())
    logs = Path(os.environ.get("ROS_LOG_DIR") or Path(rospkg.get_log_dir())) / run_id
    logs.mkdir(parents=True, exist_ok=True)
    os.environ["ROS_LOG_DIR"] = str(logs)
    supervisor = Supervisor(load_config(NodesConfig, CONFIGURATION / "nodes.yaml").supervision)
    with tempfile.TemporaryDirectory(prefix="roomba_run_") as folder:
        try:
            if master_state() is MasterState.ABSENT:
                port = port_of(rosgraph.get_master_uri())
                memory = Path(folder) / "master.xml"
                supervisor.add("master", partial(be_master, port, memory), is_master=True)
            if not _has_told_master(launch.parameters, run_id, supervisor):
                print("./roomba run: the master does not answer", file=sys.stderr)
                return 1
            if not supervisor.is_ending:
                import_for(scripts / each.script for each in launch.processes if each.script)
            supervisor.add(SUPERVISOR, partial(be_supervisor_node, supervisor.tell_to()))
            for entry in launch.processes:
                supervisor.add(
                    entry.name,
                    partial(_be_program if entry.command else _be_node, entry, scripts, logs),
                    is_required=entry.is_required,
                    is_kept=entry.is_respawned,
                )
            return supervisor.run()
        finally:
            supervisor.end_all()


def _has_told_master(parameters: dict[str, Any], run_id: str, supervisor: Supervisor) -> bool:
    """Wait for the master and set the parameters; return whether the master answered."""
    if not wait_for_master(_MASTER_WITHIN, lambda: supervisor.is_ending):
        return False
    if not supervisor.is_ending:
        try:
            set_parameters(parameters, run_id)
        except UNANSWERED:
            return False
    return True


def _require_home(launch: Launch) -> None:
    """Raise HomeError for an unknown home, before any process starts."""
    for name, value in launch.parameters.items():
        if name.endswith(_HOME):
            files_of_home(str(value), HOMES)


def _require_map(launch: Launch) -> None:
    """Raise MapStoreError for an unknown map's name: the robot would make a new map instead."""
    for name, value in launch.parameters.items():
        if name.endswith(_MAP):
            folder = name.removesuffix(_MAP) + _MAPS_FOLDER
            given = str(launch.parameters.get(folder, ""))
            require_map(str(value), folder_for(given, FOLDER))


def _require_host_of_master() -> None:
    """Raise RoombaError when the master's host has no address, as in a minimal system."""
    uri = rosgraph.get_master_uri()
    host = urlparse(uri).hostname
    if host is None:
        raise RoombaError(f"expected ROS_MASTER_URI to be http://HOST:PORT, got {uri!r}")
    try:
        socket.getaddrinfo(host, None)
    except (OSError, UnicodeError) as error:  # UnicodeError: of a text that cannot be a host's name
        raise RoombaError(
            f"expected the host of the master, {host}, to have an address: {error}; add a line for "
            "it to /etc/hosts, such as '127.0.0.1 localhost', or set ROS_MASTER_URI"
        ) from error


def _refuse_second(launch: Launch) -> None:
    """Raise RoombaError if this robot already runs: the master ends nodes with taken names."""
    state = master_state()
    if state is MasterState.ABSENT:
        return
    require_answering(state)
    there = living(tuple(entry.path for entry in launch.processes))
    if there:
        raise RoombaError(
            f"expected no such robot on {rosgraph.get_master_uri()}, got {', '.join(there)}; end "
            "it first, set ROS_NAMESPACE for another robot, or ROS_MASTER_URI for another master"
        )


def _be_node(entry: ProcessEntry, scripts: Path, logs: Path) -> None:
    """Run a node's script, as its own process would."""
    os.environ["ROS_NAMESPACE"] = entry.namespace
    be_node(scripts / entry.script, (f"__ns:={entry.namespace}", *_names_of(entry, logs)))


def _be_program(entry: ProcessEntry, _: Path, logs: Path) -> NoReturn:
    """Become a program of another package."""
    os.environ["ROS_NAMESPACE"] = entry.namespace
    os.execv(entry.command[0], [*entry.command, *_names_of(entry, logs)])


def _names_of(entry: ProcessEntry, logs: Path) -> tuple[str, str]:
    return f"__name:={entry.name}", f"__log:={logs / entry.name}.log"


def run_and_leave() -> NoReturn:
    """Run the robot, and end the process."""
    status = 0
    # The reader of the output may have closed it.
    with contextlib.suppress(BrokenPipeError):
        status = main()
        sys.stdout.flush()
        sys.stderr.flush()
    # Not sys.exit: tearing down the interpreter takes most of a second.
    os._exit(status)
