"""Walking where something stands that the map does not show."""

import math
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from roomba_robot.msg import Bumper, WheelDrop

from roomba.files.shipped import HOMES

SPEED = "speed:=4"


def flat_with(folder: Path, *things: str) -> Path:
    """Copy the flat and stand more furniture in it, unknown to its map."""
    home = folder / "changed_flat"
    shutil.copytree(HOMES / "flat", home)
    layer = home / "home.yaml"
    lines = "".join(f"  - {{{thing}, on_map: false}}\n" for thing in things)
    text = layer.read_text(encoding="utf-8")
    layer.write_text(text.replace("furniture:\n", f"furniture:\n{lines}", 1), encoding="utf-8")
    return home


@pytest.fixture(scope="module")
def flat(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in a flat where a parcel stands about, and a room is shut by boxes."""
    folder = tmp_path_factory.mktemp("flat")
    home = flat_with(
        folder,
        "name: parcel, kind: box, x: 1.5, y: 2.0",
        "name: pile 1, kind: box, x: 4.55, y: 3.2, size: {width: 0.6, depth: 0.6}",
        "name: pile 2, kind: box, x: 4.55, y: 3.6, size: {width: 0.6, depth: 0.6}",
    )
    with RosGraph(folder) as graph:
        graph.launch(f"home:={home}", SPEED)
        yield graph


@pytest.fixture(scope="module")
def family(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in a house with stairs.

    It brakes in time if the floor's end reaches the drive within 0.13 s of the robot's clock: at
    twice real time a busy machine manages that.
    """
    with RosGraph(tmp_path_factory.mktemp("family")) as graph:
        graph.launch("home:=family", "speed:=2")
        yield graph


def test_it_goes_around_what_the_lidar_sees_without_a_touch(flat: RosGraph) -> None:
    """On the way there stands a parcel."""
    probe = Probe(flat)
    pressed: list[bool] = []
    rospy.Subscriber(
        "/bumper", Bumper, lambda m: pressed.append(m.is_left_pressed or m.is_right_pressed)
    )
    probe.position()
    walker = Walker()
    walker.send(3.0, 4.0)
    walker.arrives(60.0)
    assert pressed
    assert not any(pressed)
    assert math.dist(probe.position(), (3.0, 4.0)) < 0.05


def test_a_way_that_is_blocked_ends_with_the_reason(flat: RosGraph) -> None:
    Probe(flat).position()
    walker = Walker()
    walker.send(5.2, 0.0)
    assert walker.ends(100.0) == GoalStatus.ABORTED
    assert "map does not show" in walker.text


def test_it_stops_at_the_stairs_and_says_so(family: RosGraph) -> None:
    probe = Probe(family)
    dropped: list[bool] = []
    rospy.Subscriber(
        "/wheel_drop",
        WheelDrop,
        lambda m: dropped.append(m.is_left_dropped or m.is_right_dropped),
    )
    probe.position()
    walker = Walker()
    walker.send(7.1, -0.7)
    assert walker.ends(60.0) == GoalStatus.ABORTED
    assert "the floor ends" in walker.text
    assert dropped
    assert not any(dropped)
    assert probe.position()[0] < 6.5
