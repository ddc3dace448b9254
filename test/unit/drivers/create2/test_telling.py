"""What the packets of a Create 2 mean."""

from __future__ import annotations

import pytest

from roomba.drivers.create2.open_interface import OpenMode, Packet, format_of
from roomba.drivers.create2.telling import FAST, SLOW, state_of
from roomba.mission.docking.beams import StationBeams
from roomba.robot.readings import CliffReading


@pytest.mark.parametrize(
    ("character", "beams"),
    [
        (0, StationBeams()),
        (255, StationBeams()),
        (162, StationBeams()),
        (160, StationBeams()),
        (161, StationBeams(halo=True)),
        (164, StationBeams(green=True)),
        (169, StationBeams(halo=True, red=True)),
        (173, StationBeams(halo=True, green=True, red=True)),
        (242, StationBeams(halo=True)),
        (248, StationBeams(red=True)),
        (254, StationBeams(halo=True, green=True, red=True)),
    ],
)
@pytest.mark.parametrize(
    "receiver", [Packet.INFRARED_OMNI, Packet.INFRARED_LEFT, Packet.INFRARED_RIGHT]
)
def test_each_receiver_hears_stations_of_both_ages(
    receiver: Packet, character: int, beams: StationBeams
) -> None:
    assert state_of({receiver: character}).beams == beams


def test_bits_are_of_their_sides() -> None:
    state = state_of({Packet.BUMPS_AND_DROPS: 0b1010, Packet.CLIFF_FRONT_RIGHT: 1})
    assert (state.bumper_left, state.bumper_right) == (True, False)
    assert (state.dropped_left, state.dropped_right) == (True, False)
    assert state.cliff == CliffReading(front_right=True)
    assert state_of({Packet.BUMPS_AND_DROPS: 0b0101}).bumper_right


@pytest.mark.parametrize(
    ("told", "has_power", "has_cable"),
    [
        ({Packet.CHARGING_SOURCES: 2}, True, False),
        ({Packet.CHARGING_SOURCES: 1}, True, True),
        ({Packet.CHARGING_STATE: 2}, True, False),
        ({Packet.CHARGING_STATE: 5}, False, False),
        ({}, False, False),
    ],
)
def test_where_it_charges(told: dict[int, int], has_power: bool, has_cable: bool) -> None:
    state = state_of(told)
    assert (state.has_power, state.has_cable) == (has_power, has_cable)


def test_the_charge_is_a_share_and_dirt_a_rate() -> None:
    state = state_of({Packet.CHARGE: 1500, Packet.CAPACITY: 3000, Packet.DIRT: 12})
    assert (state.level, state.grains) == (0.5, 120.0)
    assert state_of({Packet.CHARGE: 3100, Packet.CAPACITY: 3000}).level == 1.0
    assert state_of({Packet.CAPACITY: 0}).level == 1.0


def test_the_wall_sensor_tells_how_near_a_wall_is() -> None:
    assert state_of({}).wall == 0.0
    assert state_of({Packet.WALL_SIGNAL: 1023}).wall == 1.0
    assert state_of({Packet.WALL_SIGNAL: 409}).wall == pytest.approx(0.4, abs=0.001)


def test_a_mode_that_there_is_not_is_off() -> None:
    assert state_of({Packet.MODE: 9}).mode is OpenMode.OFF


def test_on_a_slow_line_a_frame_fits_into_its_time() -> None:
    for packets in (FAST, SLOW):
        size = 3 + sum(1 + format_of(packet).size for packet in packets)
        assert size * 10 / 19_200 < 0.015
