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

from roomba.commands.exercise.verdict import NotYetError, expect
from roomba_ros.runtime.graph.master import master, node_at

_CHECK: Final = "/check"
"""The node that the check is."""
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
        self._answer: subprocess.Popen[bytes] | None = None
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
        self.wait_for(rosgraph.is_master_online, _UP, "a ROS master of its own for the check")
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
        self._answer = self._run(sys.executable, str(file), *arguments)

        def is_there() -> bool:
            nodes = _others(master(_CHECK).getSystemState())
            expect(
                not nodes or f"/{node}" in nodes,
                f"expected your program to be the node {node}, it is {', '.join(nodes)}",
            )
            return bool(nodes)

        self.wait_for(is_there, _UP, f"your program to be the node {node}")

    def wait_for(self, is_so: Callable[[], object], seconds: float, expected: str) -> None:
        """Wait until a condition is true.

        Raises NotYetError after so many s of wall time, with what the graph has in its place; at
        once when the learner's program has ended.
        """
        end = time.monotonic() + seconds
        while not is_so():
            self.expect_running()
            if time.monotonic() > end:
                raise NotYetError(f"expected {expected} within {seconds:g} s{self._instead()}")
            time.sleep(_LOOK)

    def has_service(self, name: str) -> bool:
        """Return whether a node serves it."""
        return any(served == f"/{name}" for served, _ in master(_CHECK).getSystemState()[2])

    def expect_running(self) -> None:
        """Raise NotYetError when the learner's program has ended."""
        status = None if self._answer is None else self._answer.poll()
        why = ": does it loop, or spin?" if status == 0 else ""
        expect(status is None, f"your program ended with status {status}{why}")

    def _instead(self) -> str:
        """Return in words what the learner's program is in the graph, if it is there."""
        try:
            state = master(_CHECK).getSystemState()
            told = [f"{node}, which {_connections_of(node, state)}" for node in _others(state)]
        except (OSError, rosgraph.MasterException):
            # There is no master, or the node ends meanwhile.
            return ""
        return f"; your program is the node {' and '.join(told)}" if told else ""

    def _run(self, *command: str) -> subprocess.Popen[bytes]:
        program = subprocess.Popen(command, stdout=sys.stderr)
        self._programs.append(program)
        return program


def _others(state: Any) -> list[str]:
    """Return the names of all nodes but the check."""
    return sorted({node for part in state for _, nodes in part for node in nodes} - {_CHECK})


def _connections_of(node: str, state: Any) -> str:
    """Return in words what a node publishes, hears and serves, names and types, without the log."""
    asked = node_at(master(_CHECK).lookupNode(node))
    parts = {
        "publishes": _typed(asked.getPublications(_CHECK)),
        "hears": _typed(asked.getSubscriptions(_CHECK)),
        "serves": [name for name, nodes in state[2] if node in nodes and "_logger" not in name],
    }
    return ", ".join(f"{verb} {' '.join(what) or 'nothing'}" for verb, what in parts.items())


def _typed(answer: Any) -> list[str]:
    return [f"{name} ({kind})" for name, kind in answer[2] if name != "/rosout"]
