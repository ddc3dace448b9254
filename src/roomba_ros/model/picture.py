"""``./roomba pictures --only rviz``: RViz over a robot that cleans, on a screen of its own."""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Final

import cv2
import numpy as np
import rosgraph
import rospy
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba_ros.client.ros_client import RosRobot
from roomba_ros.model.screen import VirtualScreen
from roomba_ros.runtime.graph.joining import join_graph
from roomba_ros.runtime.graph.master import MasterState, master, master_state

SIZE: Final = (1400, 900)
"""Pixels of the window."""
_SPEED: Final = 3
"""The robot's seconds per second."""
_CLEANED: Final = 7.0
"""m2 that are clean in the picture, unless it is asked for another."""
_START: Final = 90.0
_CLEANING: Final = 180.0
"""s of wall time until the robot is there, and until so much is clean."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the picture; returns the exit status."""
    parser = argparse.ArgumentParser(prog="./roomba pictures --only rviz", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("docs/pictures"))
    parser.add_argument("--only", choices=["rviz"], default="rviz")
    parser.add_argument(
        "--cleaned", type=float, default=_CLEANED, metavar="M2", help="how much is clean in it"
    )
    wanted = parser.parse_args(arguments)
    path = wanted.folder / "rviz.png"
    try:
        wanted.folder.mkdir(parents=True, exist_ok=True)
        picture = picture_of_rviz(wanted.cleaned)
        if not cv2.imwrite(str(path), picture[:, :, ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 9]):
            raise RoombaError(f"{path}: cannot be written")
    except (RoombaError, OSError) as error:
        print(f"./roomba pictures: {error}", file=sys.stderr)
        return 1
    print(path)
    return 0


def picture_of_rviz(cleaned: float) -> NDArray[np.uint8]:
    """Return RViz when ``cleaned`` m2 are clean, uint8 [height, width, 3] RGB.

    This process becomes a node of that robot's graph. Raises RoombaError.
    """
    with (
        tempfile.TemporaryDirectory(prefix="roomba_rviz_") as folder,
        VirtualScreen(*SIZE) as screen,
        _robot(screen, Path(folder)) as output,
    ):
        join_graph("picture_of_rviz")
        robot = RosRobot()
        robot.start()
        _wait(lambda: bool(robot.rooms()), _START, "the rooms of the map", output)
        robot.clean()
        what = f"{cleaned:g} m2 of clean floor"
        _wait(lambda: robot.vacuum().covered >= cleaned, _CLEANING, what, output)
        picture = screen.picture()
        rospy.signal_shutdown("done")
    return picture


@contextlib.contextmanager
def _robot(screen: VirtualScreen, folder: Path) -> Iterator[Path]:
    """Run the robot with RViz on a screen, and a master of its own; give the file of its output."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    os.environ |= {
        "DISPLAY": screen.display,
        "LIBGL_ALWAYS_SOFTWARE": "1",
        "ROOMBA_HISTORY": str(folder),
        "ROOMBA_HOUSEHOLD": str(folder),
        "ROS_HOME": str(folder),
        "ROS_LOG_DIR": str(folder / "log"),
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "XDG_RUNTIME_DIR": str(folder),
    }
    output = folder / "output.txt"
    command = [sys.executable, "-m", "roomba_ros.supervision", "rviz:=true", "page:=false"]
    with output.open("wb") as file:
        process = subprocess.Popen(
            [*command, f"speed:={_SPEED}"], stdout=file, stderr=subprocess.STDOUT
        )
    try:
        _wait(lambda: _has_robot(process, output), _START, "the robot", output)
        yield output
    finally:
        process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10.0)
        process.kill()
        process.wait()


def _has_robot(process: subprocess.Popen[bytes], output: Path) -> bool:
    """Whether RViz and the mission are there; raises RoombaError when all ended instead."""
    if process.poll() is not None:
        raise RoombaError(f"the robot did not start:\n{output.read_text(errors='replace')}")
    if master_state() is not MasterState.ANSWERS:
        return False
    publishers, subscribers, _ = master("/picture_of_rviz").getSystemState()
    told = dict(publishers)
    return "/vacuum/state" in told and any("/rviz" in nodes for _, nodes in subscribers)


def _wait(condition: Callable[[], bool], seconds: float, what: str, output: Path) -> None:
    """Wait until a condition is true; raises RoombaError after so many s of wall time."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        with contextlib.suppress(rosgraph.MasterException, OSError):
            if condition():
                return
        time.sleep(0.2)
    said = output.read_text(encoding="utf-8", errors="replace")
    raise RoombaError(f"expected {what} within {seconds:g} s; the robot said:\n{said}")


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    # Not sys.exit: threads of the node's connections may wait for a graph that is gone.
    os._exit(status)
