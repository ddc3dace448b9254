"""The single topics tell the same of a body as the one message that tells all."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest
from fixtures.nodes.lockstep import Lockstep
from std_msgs.msg import Float32, UInt16

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.docking.beams import StationBeams
from roomba.robot.readings import CliffReading, Readings
from roomba_ros.body.told_topics import ToldTopics
from roomba_ros.senses.single_topics import single_topics

CONFIG = RobotConfig()
TABLE = single_topics(CONFIG)
TOLD = Readings(
    time=3.0,
    odometry=Pose(),
    bumper_left=True,
    cliff=CliffReading(front_right=True),
    dropped_right=True,
    beams=StationBeams(halo=True, red=True),
)


def test_a_row_names_fields_of_readings_and_no_two_the_same() -> None:
    told = [field for row in TABLE.values() for field in row.fields]
    assert set(told) < {field.name for field in fields(Readings)}
    assert len(told) == len(set(told))


@pytest.mark.parametrize("topic", ["bumper", "cliff", "wheel_drop", "ir_omni"])
def test_what_a_body_tells_is_heard_as_it_was(topic: str) -> None:
    heard: list[Any] = []
    with Lockstep().installed() as lockstep:
        lockstep.hear(topic, heard.append)
        ToldTopics(CONFIG).tell(10.0, 0, TOLD)
        lockstep.deliver()
    row = TABLE[topic]
    assert isinstance(heard[0], row.kind)
    told = row.told(row.convert(heard[0]))
    assert told == {field: getattr(TOLD, field) for field in row.fields}


@pytest.mark.parametrize(
    ("topic", "message", "told"),
    [
        ("dirt_detect", UInt16(7), {"grains": 7.0}),
        ("bin_level", Float32(0.25), {"in_bin": 0.25 * CONFIG.brush.bin_capacity}),
        ("brush_current", Float32(1.5), {"brush_current": 1.5}),
    ],
)
def test_what_is_counted_is_told_in_the_units_of_readings(
    topic: str, message: Any, told: dict[str, float]
) -> None:
    row = TABLE[topic]
    assert row.told(row.convert(message)) == told
