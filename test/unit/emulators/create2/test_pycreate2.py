"""The unchanged library pycreate2 drives the made-up Create 2."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from fixtures.robots.create2_rig import create2_in_studio
from fixtures.waiting import wait_until
from pycreate2 import Create2

from roomba.drivers.create2.open_interface import OpenMode
from roomba.emulators.create2.robot import Create2Robot
from roomba.emulators.create2.server import Create2Server
from roomba.emulators.living import LivingWorld
from roomba.emulators.pseudo_terminal import PseudoTerminal

DEADLINE = 20.0
"""s of wall time."""


@pytest.fixture
def robot() -> Iterator[tuple[Create2Robot, str]]:
    made = Create2Robot(create2_in_studio())
    line, world = PseudoTerminal(baud=115_200), LivingWorld(made.advance)
    server = Create2Server(made, line, world)
    server.start()
    world.start()
    yield made, line.name
    server.end()
    world.end()
    line.close()


def drive_off_and_sing(port: str, made: Create2Robot) -> None:
    stranger = Create2(port)
    stranger.start()
    sensors = stranger.get_sensors()
    assert sensors.open_interface_mode == 1
    assert sensors.charger_available.home_base
    assert sensors.battery_capacity == 3000
    stranger.full()
    stranger.drive_direct(-200, -200)
    wait_until(lambda: not stranger.get_sensors().charger_available.home_base, DEADLINE, "off it")
    wait_until(lambda: stranger.get_sensors().encoder_counts_left < 64_000, DEADLINE, "it counts")
    sensors = stranger.get_sensors()
    assert (sensors.velocity_left, sensors.velocity_right) == (-200, -200)
    assert sensors.encoder_counts_left == pytest.approx(sensors.encoder_counts_right, abs=40)
    stranger.drive_stop()
    wait_until(lambda: made.simulator.observe().twist.linear == 0.0, DEADLINE, "it stands")
    stranger.createSong(1, [60, 64])
    stranger.playSong(1)
    wait_until(lambda: stranger.get_sensors().song_playing, DEADLINE, "it sings")


def test_pycreate2_drives_it_off_its_station_and_reads_all_of_it(
    robot: tuple[Create2Robot, str],
) -> None:
    made, port = robot
    drive_off_and_sing(port, made)
    # It gives the robot back when it is forgotten.
    wait_until(lambda: made.mode is OpenMode.OFF, DEADLINE, "it was given back")
