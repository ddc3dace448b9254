"""The robot's own scan as a message: where its beams go, and when each was measured."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba_ros.convert.sensors import scan_message


@pytest.mark.parametrize(
    ("model", "first", "last", "sweep"),
    [
        ("ideal_12m", 0.0, 359.0, 0.0),
        ("neato", 0.0, 359.0, 0.25),
        ("sick_lms_200", -90.0, 90.0, 0.5 / 75),
    ],
)
def test_a_message_tells_angles_and_times(
    model: str, first: float, last: float, sweep: float
) -> None:
    lidar = SimulatedRobotConfig().with_lidar(model).lidar
    message = scan_message(3.5, np.ones(lidar.beams, np.float32), lidar, "laser")
    assert np.degrees([message.angle_min, message.angle_max]) == pytest.approx([first, last])
    assert message.angle_min + (lidar.beams - 1) * message.angle_increment == pytest.approx(
        message.angle_max
    )
    assert message.time_increment * lidar.beams == pytest.approx(sweep, rel=1e-4)
    assert message.header.stamp.to_sec() == 3.5
