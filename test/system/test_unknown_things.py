"""Walking where something stands that the map does not show."""

import math
import shutil
from pathlib import Path

import rospy
from actionlib_msgs.msg import GoalStatus
from fixtures.forked import run_forked
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from roomba_robot.msg import Bumper, WheelDrop

HOMES = Path(__file__).parents[2] / "homes"


def flat_with(folder: Path, *things: str) -> Path:
    """Copy the flat and stand more furniture in it, unknown to its map."""
    home = folder / "changed_flat"
    shutil.copytree(HOMES / "flat", home)
    layer = home / "home.yaml"
    lines = "".join(f"  - {{{thing}, on_map: false}}\n" for thing in things)
    text = layer.read_text(encoding="utf-8")
    layer.write_text(text.replace("furniture:\n", f"furniture:\n{lines}", 1), encoding="utf-8")
    return home


def test_it_goes_around_what_the_bumper_finds(tmp_path: Path) -> None:
    with RosGraph(tmp_path) as graph:
        graph.launch(
            f"home:={flat_with(tmp_path, 'name: parcel, kind: box, x: 1.5, y: 2.0')}", "speed:=3"
        )

        def walk() -> None:
            probe = Probe(graph)
            pressed: list[bool] = []
            walker = Walker()
            walker.send(3.0, 4.0)
            rospy.Subscriber(
                "/bumper", Bumper, lambda m: pressed.append(m.is_left_pressed or m.is_right_pressed)
            )
            assert walker.ends(60.0) == GoalStatus.SUCCEEDED
            assert any(pressed)
            assert math.dist(probe.position(), (3.0, 4.0)) < 0.05

        run_forked(walk)


def test_it_stops_at_the_stairs_and_says_so(tmp_path: Path) -> None:
    with RosGraph(tmp_path) as graph:
        graph.launch("home:=family", "speed:=3")

        def walk() -> None:
            probe = Probe(graph)
            dropped: list[bool] = []
            rospy.Subscriber(
                "/wheel_drop",
                WheelDrop,
                lambda m: dropped.append(m.is_left_dropped or m.is_right_dropped),
            )
            walker = Walker()
            walker.send(7.1, -0.7)
            assert walker.ends(60.0) == GoalStatus.ABORTED
            assert "the floor ends" in walker.text
            assert dropped
            assert not any(dropped)
            assert probe.position()[0] < 6.5

        run_forked(walk)


def test_a_way_that_is_blocked_ends_with_the_reason(tmp_path: Path) -> None:
    doors = (
        "name: pile 1, kind: box, x: 4.55, y: 3.2, size: {width: 0.6, depth: 0.6}",
        "name: pile 2, kind: box, x: 4.55, y: 3.6, size: {width: 0.6, depth: 0.6}",
    )
    with RosGraph(tmp_path) as graph:
        graph.launch(f"home:={flat_with(tmp_path, *doors)}", "speed:=5")

        def walk() -> None:
            Probe(graph)
            walker = Walker()
            walker.send(5.2, 0.0)
            assert walker.ends(100.0) == GoalStatus.ABORTED
            assert "map does not show" in walker.text

        run_forked(walk)
