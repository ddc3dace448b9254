"""Scans show odometry that is not from wheels; odometry that is only poor is not taken for it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from fixtures.drives.made_logs import Item, changed, drive, poor
from fixtures.drives.round_drive import round_drive
from fixtures.drives.turning_drive import half_circle, readings_of, turning_drive

from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_odometry import odometry_fault, shown_headings
from roomba.geometry import Pose


def fault(items: list[Item]) -> str:
    return odometry_fault(LidarSamples(readings_of(items, half_circle())))


def told_otherwise(change: Callable[[Pose], Pose], items: list[Item] | None = None) -> list[Item]:
    """Return a drive, along a rectangle or another one, whose odometry is changed."""

    def change_item(number: int, item: Item) -> Item:
        assert isinstance(item.value, Pose)
        return replace(item, value=change(item.value))

    return changed(round_drive() if items is None else items, "/odom", change_item)


@pytest.mark.parametrize(
    "items",
    [
        round_drive(),
        poor(round_drive()),
        round_drive(ahead=1.0),
        drive(),
        turning_drive(),
        turning_drive(yaw=math.pi),
        turning_drive(yaw=0.5 * math.pi, hangs=True),
        told_otherwise(lambda pose: Pose(3.0, -2.0, 2.0).compose(pose)),
    ],
    ids=[
        "right",
        "poor",
        "a lidar far ahead",
        "in a circle",
        "turning",
        "the lidar looks back",
        "and hangs",
        "begins elsewhere",
    ],
)
def test_with_odometry_of_wheels_nothing_is_wrong(items: list[Item]) -> None:
    assert fault(items) == ""


@pytest.mark.parametrize(
    ("items", "factor"),
    [
        (round_drive(), 1000.0),
        (round_drive(), 100.0),
        (round_drive(), 3.28),
        (drive(), 1000.0),
        (drive(), 100.0),
    ],
    ids=["mm", "cm", "feet", "mm in a circle", "cm in a circle"],
)
def test_ways_in_another_unit_are_told(items: list[Item], factor: float) -> None:
    said = fault(
        told_otherwise(lambda pose: Pose(factor * pose.x, factor * pose.y, pose.theta), items)
    ).split()
    assert said[:4] == ["it", "tells", "ways", "of"]
    told, shown = float(said[4]), float(said[-2])
    assert told / shown == pytest.approx(factor, rel=0.3)


def test_turns_in_degrees_are_told() -> None:
    items = told_otherwise(
        lambda pose: Pose(pose.x, pose.y, math.degrees(pose.theta)), turning_drive()
    )
    assert fault(items).startswith("it tells turns of ")


@pytest.mark.parametrize(
    "change",
    [
        lambda pose: Pose(pose.y, pose.x, pose.theta),
        lambda pose: Pose(pose.x, pose.y, -pose.theta),
        lambda pose: Pose(pose.x, -pose.y, pose.theta),
    ],
    ids=["x and y swapped", "turned the other way", "y to the right"],
)
def test_mirrored_ways_are_told(change: Callable[[Pose], Pose]) -> None:
    assert "better if they are mirrored" in fault(told_otherwise(change))


def test_odometry_that_never_changes_is_told() -> None:
    assert fault(told_otherwise(lambda pose: Pose(1.0, 2.0, 3.0))) == "it never changes"


def rare(items: list[Item], topic: str, every: int) -> list[Item]:
    """Return a drive of which only some messages of a topic are left."""
    of_topic = [item for item in items if item.topic == topic]
    kept = {id(item) for item in of_topic[::every]}
    return [item for item in items if item.topic != topic or id(item) in kept]


def test_odometry_that_seldom_comes_is_told() -> None:
    assert fault(rare(turning_drive(), "/odom", 50)) == "it comes once in 2.5 s"


def test_a_drive_with_few_scans_and_as_little_odometry_is_none_of_these() -> None:
    """Logs that were made from maps have a scan a metre, which no match tells anything of."""
    few = rare(rare(turning_drive(), "/odom", 60), "/scan", 15)
    assert fault(few) == ""
    assert fault(told_otherwise(lambda pose: Pose(9.0 * pose.x, pose.y, pose.theta), few)) == ""


def test_headings_are_those_that_scans_show_whatever_odometry_tells() -> None:
    true = LidarSamples(readings_of(turning_drive(), half_circle()))
    items = told_otherwise(
        lambda pose: Pose(pose.x, pose.y, math.degrees(pose.theta)), turning_drive()
    )
    samples = LidarSamples(readings_of(items, half_circle()))
    expected = {sample.stamp: sample.pose[2] for sample in true.scans}
    shown = shown_headings(samples)
    assert max(shown) - min(shown) > 1.8
    for sample, heading in zip(samples.scans, shown, strict=True):
        if sample.stamp in expected:
            assert heading == pytest.approx(expected[sample.stamp], abs=0.15)
    assert shown_headings(LidarSamples([])) == []


def test_without_anything_nothing_is_wrong() -> None:
    assert odometry_fault(LidarSamples([])) == ""
