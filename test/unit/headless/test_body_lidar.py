"""The scans of a headless body: their stamps, and the beams of lidars as sold."""

from __future__ import annotations

import pytest
from fixtures.homes.rooms import room_home

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.headless.body import SimulatedBody
from roomba.robot.command import Command
from roomba.robot.readings import ScanReading

START = Pose(2.0, 2.0, 0.3)


def first_scan(model: str) -> tuple[SimulatedBody, ScanReading, float]:
    body = SimulatedBody(room_home(), SimulatedRobotConfig().with_lidar(model), 0, None, START)
    for _ in range(100):
        readings = body.read()
        if readings.scan is not None:
            return body, readings.scan, readings.time
        body.act(Command())
    raise AssertionError("no scan came")


@pytest.mark.parametrize(
    ("model", "age"), [("ideal_12m", 0.0), ("neato", 0.25), ("neato_serial", 0.75)]
)
def test_a_scan_is_stamped_when_its_first_beam_was(model: str, age: float) -> None:
    _, scan, now = first_scan(model)
    assert now - scan.stamp == pytest.approx(age, abs=0.051)
    assert now - scan.stamp >= age - 1e-6


def test_beams_of_a_fan_end_where_the_lidar_looked() -> None:
    body, scan, _ = first_scan("sick_lms_200")
    view = body.lidar.view(scan.ranges)
    assert len(view) > 150
    assert view.ends[:, 2].min() > -0.02
    assert (view.ends[0, 3], view.ends[-1, 3]) == (
        pytest.approx(-1.0, abs=0.1),
        pytest.approx(1.0, abs=0.1),
    )
