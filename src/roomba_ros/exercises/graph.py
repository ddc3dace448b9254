"""A graph for a check: a master of its own, the learner's node on it, and the check as a node."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import rosgraph
import rospy

from roomba.commands.exercise.verdict import NotYetError

_UP: Final = 30.0
"""s of wall time in which a master, or a learner's node, is to be there."""
_LOOK: Final = 0.02
"""s of wall time between two looks."""
_ENDS: Final = 5.0
"""s of wall time in which a node ends that is told to."""


class OwnGraph:
    """A master on a free port; ``with`` ends it, and what was run on it."""

    def __init__(self) -> None:
        """Start nothing yet."""
        self._programs: list[subprocess.Popen[bytes]] = []
        self._folder = tempfile.TemporaryDirectory()

    def __enter__(self) -> OwnGraph:
        """Start the master, and become a node of it."""
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        os.environ |= {
            "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
            "ROS_IP": "127.0.0.1",
            "ROS_HOME": self._folder.name,
            "ROS_LOG_DIR": self._folder.name,
        }
        self._run("rosmaster", "--core", "-p", str(port), "-w", "4", "-t", "1")
        wait_for(rosgraph.is_master_online, _UP, "a ROS master of its own for the check")
        rospy.init_node("check", disable_signals=True)
        return self

    def __exit__(self, *_: object) -> None:
        """End all, the newest first."""
        rospy.signal_shutdown("done")
        for program in reversed(self._programs):
            program.send_signal(signal.SIGINT)
            try:
                program.wait(_ENDS)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        self._folder.cleanup()

    def run_answer(self, file: Path, node: str, *arguments: str) -> None:
        """Run the learner's file, and wait until it is the node that it should be."""
        program = self._run(sys.executable, str(file), *arguments)

        def is_there() -> bool:
            if program.poll() is not None:
                raise NotYetError(f"your program ended with status {program.returncode}")
            return any(f"/{node}" in nodes for part in _state() for _, nodes in part)

        wait_for(is_there, _UP, f"your program to be the node {node}")

    def _run(self, *command: str) -> subprocess.Popen[bytes]:
        program = subprocess.Popen(command, stdout=sys.stderr)
        self._programs.append(program)
        return program


def _state() -> Any:
    return rosgraph.Master("/check").getSystemState()


def wait_for(is_so: Callable[[], object], seconds: float, expected: str) -> None:
    """Wait until something is so; raises NotYetError after so many s of wall time."""
    end = time.monotonic() + seconds
    while not is_so():
        if time.monotonic() > end:
            raise NotYetError(f"expected {expected} within {seconds:g} s")
        time.sleep(_LOOK)
