"""Programs of ROS that draw the robot, each as it is: RViz, and robot_state_publisher."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from fixtures.graph import RosGraph
from fixtures.nodes.rviz import displays
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import TransformStamped
from roslib.packages import find_node
from rospkg import ResourceNotFound
from tf2_msgs.msg import TFMessage

from roomba.configuration.frozen import load_config
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import CONFIGURATION
from roomba_ros.body.frames import BodyFrames
from roomba_ros.model.picture import SIZE
from roomba_ros.model.screen import VirtualScreen


def needs(package: str, name: str) -> None:
    """Leave the test out where a program is not installed."""
    try:
        there = bool(find_node(package, name))
    except ResourceNotFound:
        there = False
    if not there:
        pytest.skip(f"{name} is not installed: ./roomba run {package}:=true installs it")


def needs_rviz() -> None:
    """Leave the test out where there is no RViz, or no screen for it."""
    needs("rviz", "rviz")
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed: ./roomba pictures --only rviz installs it")


def test_the_command_makes_a_picture_of_it(tmp_path: Path) -> None:
    needs_rviz()
    command = [sys.executable, "-m", "roomba_ros.model.picture", str(tmp_path), "--cleaned", "0.1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300.0, check=False)
    assert done.returncode == 0, done.stderr
    picture = cv2.imread(str(tmp_path / "rviz.png"))
    assert picture is not None
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    assert np.mean(np.all(picture > 250, axis=2)) > 0.15


def test_rviz_shows_the_robot(tmp_path: Path) -> None:
    needs_rviz()
    with VirtualScreen(*SIZE) as screen, RosGraph(tmp_path) as graph:
        graph.environment |= {
            "DISPLAY": screen.display,
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "XDG_RUNTIME_DIR": str(tmp_path),
        }
        run = graph.launch("rviz:=true")
        wanted = {display["topic"] for display in displays() if display["enabled"]}

        def missing() -> set[str]:
            return wanted - graph.heard_by("rviz")

        wait_until(lambda: not missing(), 60.0, lambda: f"RViz hears {missing()}\n{run.output}")
        wait_until(lambda: white_share(screen) > 0.2, 60.0, lambda: run.output)
        for word in ("robot_description", "No transform", "Could not load", "is not supported"):
            assert word not in run.output


def white_share(screen: VirtualScreen) -> float:
    """Return how much of the view, without panels, is the map's free floor."""
    view = screen.picture()[100:780, 460:1290]
    return float(np.mean(np.all(view > 250, axis=2)))


@pytest.fixture
def published(tmp_path: Path) -> Iterator[RosGraph]:
    """The robot, of whose frames robot_state_publisher tells."""
    needs("robot_state_publisher", "robot_state_publisher")
    with RosGraph(tmp_path) as graph:
        graph.launch("robot_state_publisher:=true")
        yield graph


def test_robot_state_publisher_tells_the_same_frames(published: RosGraph) -> None:
    wait_until(lambda: "/tf_static" in published.system_state()[0], 20.0, "/tf_static")
    assert published.system_state()[0]["/tf_static"] == ["/robot_state_publisher"]
    frames = BodyFrames(load_config(SimulatedRobotConfig, CONFIGURATION / "robot.yaml"))
    expected = {message.child_frame_id: message for message in frames.mounted()}
    probe = Probe(published)
    told = {each.child_frame_id: each for each in probe.next("/tf_static", TFMessage).transforms}
    assert told.keys() == expected.keys()
    for child, message in told.items():
        assert message.header.frame_id == expected[child].header.frame_id
        place, turn = placed(message)
        own_place, own_turn = placed(expected[child])
        assert place == pytest.approx(own_place, abs=1e-6), child
        # A rotation and its negative are the same.
        assert abs(float(np.dot(turn, own_turn))) == pytest.approx(1.0, abs=1e-6), child
    moving: set[str] = set()

    def has_wheels() -> bool:
        moving.update(each.child_frame_id for each in probe.next("/tf", TFMessage).transforms)
        return moving >= {"wheel_left", "wheel_right"}

    wait_until(has_wheels, 20.0, lambda: f"wheels in {moving}")


def placed(message: TransformStamped) -> tuple[list[float], list[float]]:
    """Return the numbers of a transform: place, m, and rotation."""
    place, turn = message.transform.translation, message.transform.rotation
    return [place.x, place.y, place.z], [turn.x, turn.y, turn.z, turn.w]
