"""AutonomyLab/libcreate, by the bytes that it sent while it drove this made-up robot.

Heard of its version of April 2025, built as it is, which took 314 frames, none spoilt: connect,
full mode, ``drive(-0.2, 0)``, ``driveRadius(0.1, 0.5)``, ``driveWheels(0.1, -0.1)``, motors,
lamps, a song, and disconnect.
"""

from __future__ import annotations

import pytest
from fixtures.robots.create2_rig import create2_in_studio

from roomba.drivers.create2.open_interface import OpenMode
from roomba.emulators.create2.instructions import InstructionReader
from roomba.emulators.create2.robot import Create2Robot
from roomba.emulators.living import STEP

PACKETS = (
    7, 8, 9, 10, 11, 12, 13, 14, 15, 17, 18, 21, 22, 23, 24, 25, 26, 35, 43, 44, 45, 46, 47, 48, 49,
    50, 51, 52, 53, 58,
)  # fmt: skip
CONNECT = bytes([128, 148, len(PACKETS), *PACKETS])
FULL = bytes([132])
BACKWARDS = bytes([145, 255, 56, 255, 56])
ARC = bytes([137, 0, 100, 1, 244])
TURN = bytes([145, 255, 156, 0, 100])
MOTORS = bytes([144, 0, 0, 64, 144, 64, 0, 64, 144, 64, 38, 64])
LAMPS = bytes([139, 8, 0, 0, 139, 8, 255, 128])
SONG = bytes([140, 0, 2, 60, 16, 64, 16, 141, 0])
STAND = bytes([145, 0, 0, 0, 0])
DISCONNECT = bytes([128, 173])


@pytest.fixture
def robot() -> Create2Robot:
    made = Create2Robot(create2_in_studio())
    hear(made, CONNECT + FULL)
    return made


def hear(robot: Create2Robot, sent: bytes, seconds: float = 0.0) -> bytes:
    """Let a robot do what was sent, all at once, and live on."""
    said = b"".join(robot.do(told) for told in InstructionReader().take(sent))
    for _ in range(round(seconds / STEP)):
        robot.advance()
    return said


def test_it_tells_a_stream_of_all_that_libcreate_asks_for(robot: Create2Robot) -> None:
    assert robot.is_streaming
    assert robot.streamed == bytes(PACKETS)
    assert robot.mode is OpenMode.FULL
    frame = robot.frame()
    assert frame[0] == 19
    assert frame[1] == len(frame) - 3
    assert sum(frame) % 256 == 0
    # libcreate takes the packets one after the other, each of one or two bytes.
    assert frame[2] == PACKETS[0]


def test_it_drives_as_libcreate_tells_it(robot: Create2Robot) -> None:
    hear(robot, BACKWARDS, 2.0)
    assert robot.seen.twist.linear == pytest.approx(-0.2, abs=0.01)
    assert not robot.seen.battery.is_docked
    hear(robot, ARC, 2.0)
    twist = robot.seen.twist
    assert twist.linear == pytest.approx(0.1, abs=0.01)
    assert twist.linear / twist.angular == pytest.approx(0.5, abs=0.05)
    hear(robot, TURN, 2.0)
    assert robot.seen.twist.linear == pytest.approx(0.0, abs=0.01)
    assert robot.seen.twist.angular > 0.5 or robot.seen.twist.angular < -0.5
    hear(robot, STAND, 1.0)
    assert robot.seen.twist.linear == robot.seen.twist.angular == 0.0


def test_it_sweeps_and_sings_and_is_let_go(robot: Create2Robot) -> None:
    hear(robot, BACKWARDS, 1.0)
    hear(robot, MOTORS + LAMPS + SONG + STAND, 0.1)
    brush, fan = robot.simulator.duty
    assert brush > 0.4
    assert fan == pytest.approx(0.5, abs=0.01)
    hear(robot, DISCONNECT, 0.1)
    assert robot.mode is OpenMode.OFF
    assert not robot.is_streaming
    assert robot.simulator.duty == (0.0, 0.0)
