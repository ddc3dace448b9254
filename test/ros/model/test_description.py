"""The URDF has the configuration's numbers, and its frames are those that the body publishes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from geometry_msgs.msg import TransformStamped
from numpy.typing import NDArray

from roomba.configuration.frozen import load_config
from roomba.configuration.robot import RobotConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import RoombaError
from roomba.files.shipped import CONFIGURATION
from roomba_ros.body.frames import BodyFrames
from roomba_ros.convert.sensors import WHEEL_JOINTS
from roomba_ros.model.description import description

SHIPPED = CONFIGURATION / "robot.yaml"


def numbers(text: str | None) -> list[float]:
    return [float(word) for word in (text or "").split()]


def rotation_of_turns(turns: Iterable[float]) -> NDArray[np.float64]:
    """Return the matrix of a URDF's rpy: about the fixed axes x, y, z, one after the other."""
    whole = np.eye(3)
    for axis, angle in enumerate(turns):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[one, one] = turn[other, other] = math.cos(angle)
        turn[other, one] = math.sin(angle)
        turn[one, other] = -math.sin(angle)
        whole = turn @ whole
    return whole


def rotation_of(message: TransformStamped) -> NDArray[np.float64]:
    """Return the matrix of a message's quaternion, by turning the axes one by one."""
    q = message.transform.rotation
    real, imaginary = q.w, np.array([q.x, q.y, q.z])
    assert real**2 + imaginary @ imaginary == pytest.approx(1.0)
    axes = np.eye(3)
    turned = [
        axis + 2.0 * np.cross(imaginary, np.cross(imaginary, axis) + real * axis) for axis in axes
    ]
    return np.array(turned).T


@pytest.fixture(params=["shipped", "another"])
def configuration(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A robot.yaml: that which comes along, or one with other numbers throughout."""
    if request.param == "shipped":
        return SHIPPED
    text = SHIPPED.read_text(encoding="utf-8")
    for before, after in (
        ("diameter: 0.32 ", "diameter: 0.30 "),
        ("wheel_separation: 0.235", "wheel_separation: 0.21"),
        ("wheel_diameter: 0.072", "wheel_diameter: 0.08"),
        ("mount_forward: 0.15 ", "mount_forward: 0.12 "),
        ("mount_height: 0.085 ", "mount_height: 0.07 "),
        ("angles: [60.0, 15.0", "angles: [70.0, 25.0"),
        ("radius: 0.155", "radius: 0.14"),
    ):
        assert before in text
        text = text.replace(before, after)
    path = tmp_path / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_its_frames_are_those_that_the_body_tells(configuration: Path) -> None:
    model = ElementTree.fromstring(description(configuration))
    frames = BodyFrames(load_config(SimulatedRobotConfig, configuration))
    told = {message.child_frame_id: message for message in frames.mounted()}
    told |= {message.child_frame_id: message for message in frames.wheels(1.0, 0.0, 0.0)}
    joints = {joint.find("child").get("link"): joint for joint in model.findall("joint")}  # type: ignore[union-attr]
    assert joints.keys() == told.keys()
    for child, joint in joints.items():
        message = told[child]
        place = message.transform.translation
        parent, origin = joint.find("parent"), joint.find("origin")
        assert parent is not None
        assert origin is not None
        assert message.header.frame_id == parent.get("link")
        expected = numbers(origin.get("xyz"))
        assert [place.x, place.y, place.z] == pytest.approx(expected, abs=1e-9), child
        turned = rotation_of_turns(numbers(origin.get("rpy") or "0 0 0"))
        assert rotation_of(message) == pytest.approx(turned, abs=1e-9), child


def test_its_wheels_turn_as_the_encoders_count(configuration: Path) -> None:
    model = ElementTree.fromstring(description(configuration))
    moving = {
        joint.get("name"): joint
        for joint in model.findall("joint")
        if joint.get("type") == "continuous"
    }
    assert tuple(moving) == WHEEL_JOINTS
    for joint in moving.values():
        axis = joint.find("axis")
        assert axis is not None
        assert axis.get("xyz") == "0 1 0"
    frames = BodyFrames(load_config(SimulatedRobotConfig, configuration))
    for message, angle in zip(frames.wheels(2.0, 0.4, -7.0), (0.4, -7.0), strict=True):
        assert rotation_of(message) == pytest.approx(rotation_of_turns((0.0, angle, 0.0)))
        assert message.header.stamp.to_sec() == 2.0


def test_its_body_has_the_size_of_the_configuration(configuration: Path) -> None:
    model = ElementTree.fromstring(description(configuration))
    body = load_config(RobotConfig, configuration).body
    hull = model.find("link[@name='base_link']/collision")
    assert hull is not None
    cylinder, origin = hull.find("geometry/cylinder"), hull.find("origin")
    assert cylinder is not None
    assert origin is not None
    assert float(cylinder.get("radius", "")) == pytest.approx(body.radius)
    assert float(cylinder.get("length", "")) == pytest.approx(body.height)
    assert numbers(origin.get("xyz")) == pytest.approx([0.0, 0.0, body.height / 2.0])
    wheels = model.findall("link/collision/geometry/cylinder[@length='0.022']")
    assert [float(wheel.get("radius", "")) for wheel in wheels] == pytest.approx(
        [0.5 * body.wheel_diameter] * 2
    )


def test_links_are_a_tree_and_nothing_visible_is_outside_the_body(configuration: Path) -> None:
    model = ElementTree.fromstring(description(configuration))
    body = load_config(RobotConfig, configuration).body
    links = {str(link.get("name")) for link in model.findall("link")}
    children = [str(child.get("link")) for child in model.findall("joint/child")]
    assert sorted(children) == sorted(links - {"base_link"})
    assert {parent.get("link") for parent in model.findall("joint/parent")} <= links
    colours = {material.get("name") for material in model.findall("material")}
    used = {material.get("name") for material in model.findall("link/visual/material")}
    assert used == colours
    for visual in model.findall("link[@name='base_link']/visual"):
        origin, box = visual.find("origin"), visual.find("geometry/box")
        cylinder = visual.find("geometry/cylinder")
        assert origin is not None
        x, y, z = numbers(origin.get("xyz"))
        if cylinder is not None:
            reach, up = float(cylinder.get("radius", "")), 0.5 * float(cylinder.get("length", ""))
        else:
            size = numbers(box.get("size")) if box is not None else [0.024] * 3
            reach, up = 0.5 * size[0], 0.5 * size[2]
        assert math.hypot(x, y) + reach <= body.radius + 1e-9
        assert z - up >= -1e-9
        assert z + up <= body.height + 1e-3


def test_a_file_without_the_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("body: {diameter: 0.3}\n", encoding="utf-8")
    with pytest.raises(RoombaError, match=r"robot\.yaml: expected a robot\.yaml with all of"):
        description(path)
