"""A ROS graph for measuring: its own master on a free port, loopback only; ended by process ids."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client
from collections.abc import Callable
from pathlib import Path
from typing import Any

from roomba_bench.contestants import ContestantError
from roomba_bench.places import HERE

_CALLER = "/bench"
_START_DEADLINE = 60.0
_END_DEADLINE = 6.0
_WORKERS = ("-w", "8", "-t", "1")
"""As ``./roomba run`` starts its master."""
NO_ROS = "there is no ROS environment"


def has_ros() -> bool:
    """Whether programs can be started in a graph."""
    return "ROS_PACKAGE_PATH" in os.environ


def free_port() -> int:
    """Return a port of loopback on which nothing listens now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Graph:
    """Starts programs that all use one master, and ends them all on exit, the newest first."""

    def __init__(self, folder: Path) -> None:
        """Choose a port; what the programs write is under ``folder``."""
        self._port = str(free_port())
        self._folder = folder
        self.environment = {
            **{k: v for k, v in os.environ.items() if k not in ("ROS_HOSTNAME", "ROS_NAMESPACE")},
            "ROS_MASTER_URI": f"http://127.0.0.1:{self._port}",
            "ROS_IP": "127.0.0.1",
            "ROS_HOME": str(folder / "ros_home"),
            "ROS_LOG_DIR": str(folder / "ros_log"),
        }
        self._master = xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"])
        self._programs: list[subprocess.Popen[bytes]] = []
        self._logs: dict[int, tuple[str, Path]] = {}

    def __enter__(self) -> Graph:
        """Start nothing yet."""
        return self

    def __exit__(self, *_: object) -> None:
        """End every program that still runs."""
        for program in reversed(self._programs):
            _end(program)

    def start_master(self) -> None:
        """Start a bare master and wait for it; raises ContestantError."""
        self.start("rosmaster", "--core", "-p", self._port, *_WORKERS)
        self._wait("the master answers", lambda: self._published() is not None)

    def launch(self, *arguments: str) -> None:
        """Launch the robot as ``./roomba run`` does and wait for its nodes; ContestantError."""
        launch_file = ("roomba_robot", "roomba_robot.launch")
        self.start("roslaunch", "-p", self._port, *_WORKERS, *launch_file, *arguments)
        self.wait_for_topic("/walk_to_point/status")

    def run_robot(self, *arguments: str) -> int:
        """Run the robot by the program of ``./roomba run``; return its process when all is up.

        Raises ContestantError.
        """
        pid = self.start(sys.executable, "-m", "roomba_ros.supervision", *arguments)
        self.wait_for_topic("/walk_to_point/status")
        self.wait_for_topic("/clean/status")
        return pid

    def start(self, *command: str) -> int:
        """Start a program in this graph; return its process."""
        log = self._folder / f"{len(self._programs)}-{Path(command[0]).name}.log"
        with log.open("wb") as output:
            program = subprocess.Popen(
                command,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        self._programs.append(program)
        self._logs[program.pid] = (Path(command[0]).name, log)
        return program.pid

    def wait_for_topic(self, topic: str) -> None:
        """Wait until a topic has a publisher; raises ContestantError."""
        self._wait(f"{topic} is published", lambda: self._publishes(topic))

    def _publishes(self, topic: str) -> bool:
        return topic in (self._published() or {})

    def _published(self) -> dict[str, list[str]] | None:
        """Return nodes by topic, or None while there is no master."""
        try:
            answer: Any = self._master.getSystemState(_CALLER)
        except OSError:
            return None
        _, _, (publishers, _, _) = answer
        return dict(publishers)

    def _wait(self, what: str, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + _START_DEADLINE
        while not condition():
            ended = [program for program in self._programs if program.poll() is not None]
            if ended:
                name, log = self._logs[ended[0].pid]
                raise ContestantError(f"{name} ended before {what}: {_last_words(log)}")
            if time.monotonic() > end:
                raise ContestantError(f"not so within {_START_DEADLINE:g} s: {what}")
            time.sleep(0.02)


def _last_words(log: Path) -> str:
    """Return why a program ended, as far as its output tells: what was fatal, or its last line."""
    lines = [line for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    fatal = [line for line in lines if "[FATAL]" in line or "Error:" in line]
    return (fatal or lines or ["it said nothing"])[-1].replace(f"{HERE.root}/", "").strip()


def _end(program: subprocess.Popen[bytes]) -> None:
    for number in (signal.SIGINT, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(program.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            program.wait(_END_DEADLINE)
            break
    with contextlib.suppress(ProcessLookupError):
        os.killpg(program.pid, signal.SIGKILL)  # what it started and left behind
