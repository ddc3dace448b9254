"""A made-up Create 2: modes, packets, and what it does when it is told to."""

from __future__ import annotations

import math
import struct

import pytest
from fixtures.robots.create2_rig import create2_in_studio

from roomba.drivers.create2.open_interface import FORMATS, GROUPS, Opcode, OpenMode, Packet
from roomba.emulators.create2.instructions import InstructionReader
from roomba.emulators.create2.robot import Create2Robot
from roomba.emulators.living import STEP
from roomba.geometry import Pose
from roomba.world.engine.state.arrays import Fault

AWAY = Pose(-0.6, 0.0, 0.0)
"""From the station, as the robot on it sees it."""


@pytest.fixture
def robot() -> Create2Robot:
    docked = create2_in_studio().pose
    return Create2Robot(create2_in_studio(docked.compose(AWAY)))


@pytest.fixture
def docked() -> Create2Robot:
    return Create2Robot(create2_in_studio())


def say(robot: Create2Robot, *sent: int) -> bytes:
    return b"".join(robot.do(told) for told in InstructionReader().take(bytes(sent)))


def ask(robot: Create2Robot, packet: int) -> int:
    answer = say(robot, Opcode.SENSORS, packet)
    return int(struct.unpack(">" + FORMATS[packet], answer)[0])


def live(robot: Create2Robot, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        robot.advance()


def drive(robot: Create2Robot, right: int, left: int) -> None:
    say(robot, Opcode.DRIVE_DIRECT, *struct.pack(">hh", right, left))


def test_it_is_off_until_it_is_started_and_when_it_is_stopped(robot: Create2Robot) -> None:
    assert say(robot, Opcode.SENSORS, 35) == b""
    say(robot, Opcode.SAFE)
    assert robot.mode is OpenMode.OFF
    say(robot, Opcode.START)
    assert ask(robot, Packet.MODE) == OpenMode.PASSIVE
    say(robot, Opcode.STREAM, 1, 7, Opcode.STOP)
    assert robot.mode is OpenMode.OFF
    assert not robot.is_streaming


@pytest.mark.parametrize(
    ("opcode", "mode"),
    [
        (Opcode.SAFE, OpenMode.SAFE),
        (Opcode.CONTROL, OpenMode.SAFE),
        (Opcode.FULL, OpenMode.FULL),
        (Opcode.CLEAN, OpenMode.PASSIVE),
        (Opcode.SEEK_DOCK, OpenMode.PASSIVE),
        (Opcode.POWER, OpenMode.PASSIVE),
    ],
)
def test_commands_change_its_mode(robot: Create2Robot, opcode: Opcode, mode: OpenMode) -> None:
    say(robot, Opcode.START, Opcode.FULL, opcode)
    assert ask(robot, Packet.MODE) == mode


def test_the_groups_are_as_long_as_is_specified(robot: Create2Robot) -> None:
    say(robot, Opcode.START)
    sizes = {group: len(say(robot, Opcode.SENSORS, group)) for group in GROUPS}
    assert sizes == {
        0: 26, 1: 10, 2: 6, 3: 10, 4: 14, 5: 12, 6: 52, 100: 80, 101: 28, 106: 12, 107: 9
    }  # fmt: skip
    parts = b"".join(say(robot, Opcode.SENSORS, packet) for packet in range(7, 59))
    assert say(robot, Opcode.SENSORS, 100) == parts


def test_a_list_is_answered_in_its_order_and_unknown_numbers_are_passed_over(
    robot: Create2Robot,
) -> None:
    say(robot, Opcode.START)
    assert say(robot, Opcode.QUERY_LIST, 3, 35, 99, 26) == bytes([1]) + struct.pack(">H", 3000)
    assert say(robot, Opcode.SENSORS, 59) == b""


def test_a_frame_of_the_stream_is_that_of_the_specification(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.STREAM, 2, 29, 13)
    assert robot.is_streaming
    frame = robot.frame()
    assert frame[:3] == bytes([19, 5, 29])
    assert frame[5:7] == bytes([13, 0])
    assert sum(frame) % 256 == 0
    assert len(frame) == 8
    say(robot, Opcode.TOGGLE_STREAM, 0)
    assert not robot.is_streaming
    say(robot, Opcode.TOGGLE_STREAM, 1)
    assert robot.is_streaming
    assert ask(robot, Packet.STREAM_PACKETS) == 2


def test_a_frame_is_as_long_as_its_length_can_tell(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.STREAM, 4, 100, 100, 100, 100)
    frame = robot.frame()
    assert frame[1] == len(frame) - 3 == 3 * (1 + 80)
    assert sum(frame) % 256 == 0
    assert ask(robot, Packet.STREAM_PACKETS) == 3


def test_passive_mode_moves_nothing(robot: Create2Robot) -> None:
    say(robot, Opcode.START)
    drive(robot, 200, 200)
    say(robot, Opcode.MOTORS, 7)
    live(robot, 0.5)
    assert robot.seen.twist.linear == 0.0
    assert robot.simulator.duty == (0.0, 0.0)


def test_it_drives_for_ever_as_it_was_told_last_and_counts_its_wheels(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SAFE)
    before = robot.simulator.pose
    drive(robot, -100, -100)
    live(robot, 3.0)
    way = before.distance_to(robot.simulator.pose.x, robot.simulator.pose.y)
    assert way == pytest.approx(0.3, abs=0.02)
    per_metre = 508.8 / (math.pi * 0.072)
    counts = 65_536 - ask(robot, Packet.LEFT_ENCODER)
    assert counts == pytest.approx(way * per_metre, abs=3)
    assert (ask(robot, Packet.REQUESTED_LEFT), ask(robot, Packet.REQUESTED_RIGHT)) == (-100, -100)
    say(robot, Opcode.START)
    live(robot, 0.5)
    assert robot.seen.twist.linear == 0.0


def test_way_and_turn_begin_anew_when_they_were_asked_for(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SAFE)
    say(robot, Opcode.DRIVE, *struct.pack(">hh", 100, 1))
    live(robot, 2.0)
    turned = math.degrees(robot.seen.odometry.theta)
    assert ask(robot, Packet.ANGLE) == pytest.approx(turned, abs=1)
    assert ask(robot, Packet.ANGLE) == 0
    drive(robot, -100, -100)
    live(robot, 2.0)
    assert ask(robot, Packet.DISTANCE) == pytest.approx(-200, abs=15)
    assert ask(robot, Packet.DISTANCE) == 0


def test_safe_mode_ends_when_it_is_lifted_and_full_mode_does_not(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SAFE)
    drive(robot, -100, -100)
    robot.simulator.inject(Fault.LIFTED, 1.0)
    live(robot, 0.1)
    assert robot.mode is OpenMode.PASSIVE
    assert ask(robot, Packet.BUMPS_AND_DROPS) & 0b1100 == 0b1100
    say(robot, Opcode.FULL)
    live(robot, 0.1)
    assert robot.mode is OpenMode.FULL


@pytest.mark.parametrize(
    ("right", "left", "mode"),
    [
        (100, 100, OpenMode.PASSIVE),
        (100, -100, OpenMode.PASSIVE),
        (-100, -10, OpenMode.PASSIVE),
        (-100, -100, OpenMode.SAFE),
        (0, 0, OpenMode.SAFE),
    ],
)
def test_at_a_cliff_safe_mode_allows_the_way_back_alone(
    robot: Create2Robot, right: int, left: int, mode: OpenMode
) -> None:
    robot.simulator.inject(Fault.CLIFF_DIRTY, 1.0)
    say(robot, Opcode.START, Opcode.SAFE)
    drive(robot, right, left)
    live(robot, 0.1)
    assert robot.mode is mode
    assert [ask(robot, Packet.CLIFF_LEFT + place) for place in range(4)] == [1, 1, 1, 1]


def test_on_the_station_it_has_power_and_safe_mode_ends(docked: Create2Robot) -> None:
    say(docked, Opcode.START, Opcode.SAFE)
    live(docked, 0.1)
    assert docked.mode is OpenMode.PASSIVE
    assert ask(docked, Packet.CHARGING_SOURCES) == 2
    assert ask(docked, Packet.CHARGING_STATE) in (2, 3)
    say(docked, Opcode.FULL)
    drive(docked, -200, -200)
    live(docked, 1.0)
    assert ask(docked, Packet.CHARGING_SOURCES) == 0
    assert docked.mode is OpenMode.FULL


def test_it_hears_its_station(robot: Create2Robot) -> None:
    say(robot, Opcode.START)
    live(robot, 0.1)
    heard = ask(robot, Packet.INFRARED_OMNI)
    assert heard in (161, 164, 165, 168, 169, 172, 173)
    assert heard == 160 + int(robot.seen.infrared)
    assert ask(robot, Packet.INFRARED_LEFT) == heard
    say(robot, Opcode.SAFE, Opcode.DRIVE, *struct.pack(">hh", 200, 1))
    live(robot, 1.6)
    assert abs(robot.seen.odometry.theta) > 2.5
    assert ask(robot, Packet.INFRARED_LEFT) == ask(robot, Packet.INFRARED_RIGHT) == 0


def test_what_it_touches_it_tells_by_its_side(robot: Create2Robot) -> None:
    robot.simulator.inject(Fault.BUMPER_STUCK, 1.0)
    say(robot, Opcode.START)
    live(robot, STEP)
    assert ask(robot, Packet.BUMPS_AND_DROPS) == 0b11


def test_its_battery_is_told_in_milliamperes(robot: Create2Robot) -> None:
    robot.simulator.set_charge(0.5)
    say(robot, Opcode.START)
    live(robot, STEP)
    assert ask(robot, Packet.CAPACITY) == 3000
    assert ask(robot, Packet.CHARGE) == pytest.approx(1500, abs=2)
    assert 12_000 < ask(robot, Packet.VOLTAGE) < 17_000
    assert ask(robot, Packet.CURRENT) < 0


def test_brush_and_fan_have_the_power_that_they_were_given(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SAFE, Opcode.PWM_MOTORS, 127, 40, 64)
    live(robot, STEP)
    assert robot.simulator.duty == (pytest.approx(1.0), pytest.approx(64 / 127))
    say(robot, Opcode.MOTORS, 0b110)
    live(robot, STEP)
    assert robot.simulator.duty == (1.0, 1.0)


def test_songs_and_lights_are_kept(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SONG, 0, 1, 60, 32, Opcode.PLAY, 0)
    assert ask(robot, Packet.SONG_PLAYING) == 0
    say(robot, Opcode.FULL, Opcode.PLAY, 0, Opcode.LEDS, 4, 128, 255)
    assert ask(robot, Packet.SONG_PLAYING) == 1
    assert robot.leds[Opcode.LEDS] == bytes([4, 128, 255])
    live(robot, 0.6)
    assert ask(robot, Packet.SONG_PLAYING) == 0


def test_a_reset_begins_all_anew(robot: Create2Robot) -> None:
    say(robot, Opcode.START, Opcode.SAFE, Opcode.BAUD, 7)
    drive(robot, -100, -100)
    live(robot, 1.0)
    assert robot.baud == 19_200
    assert say(robot, Opcode.RESET)
    assert (robot.mode, robot.baud) == (OpenMode.OFF, 115_200)
    say(robot, Opcode.START)
    assert ask(robot, Packet.LEFT_ENCODER) == 0
    live(robot, 1.0)
    assert robot.seen.twist.linear == 0.0


def test_in_passive_mode_it_falls_asleep_and_brc_wakes_it() -> None:
    robot = Create2Robot(create2_in_studio(), sleeps_after=2.0)
    say(robot, Opcode.START, Opcode.STREAM, 1, Packet.MODE)
    live(robot, 1.9)
    assert not robot.is_asleep
    live(robot, 0.2)
    assert robot.is_asleep
    assert not robot.is_streaming
    say(robot, Opcode.START)
    assert say(robot, Opcode.SENSORS, Packet.MODE) == b""
    robot.pull_brc(is_low=False)
    assert robot.is_asleep
    robot.pull_brc(is_low=True)
    assert not robot.is_asleep
    say(robot, Opcode.START)
    assert ask(robot, Packet.MODE) == OpenMode.PASSIVE


def test_pulses_keep_it_awake_and_a_pin_that_stays_low_does_not() -> None:
    robot = Create2Robot(create2_in_studio(), sleeps_after=2.0)
    say(robot, Opcode.START)
    for _ in range(3):
        robot.pull_brc(is_low=True)
        live(robot, 1.5)
        robot.pull_brc(is_low=False)
    assert not robot.is_asleep
    robot.pull_brc(is_low=True)
    for _ in range(3):
        robot.pull_brc(is_low=True)
        live(robot, 0.9)
    assert robot.is_asleep


def test_out_of_passive_mode_it_stays_awake(robot: Create2Robot) -> None:
    sleeper = Create2Robot(robot.simulator, sleeps_after=1.0)
    say(sleeper, Opcode.START, Opcode.SAFE)
    live(sleeper, 3.0)
    assert sleeper.mode is OpenMode.SAFE
    assert not sleeper.is_asleep
