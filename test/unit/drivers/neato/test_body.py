"""A driver and a made-up Neato at the two ends of a pseudo terminal, in real time."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from fixtures.waiting import wait_until

from roomba.configuration.simulation import load_simulated_config
from roomba.drivers.line import LineError, SerialLine
from roomba.drivers.neato.body import NeatoBody
from roomba.drivers.neato.conversation import Conversation
from roomba.emulators.neato.robot import NeatoRobot, made_up
from roomba.emulators.neato.server import NeatoServer
from roomba.emulators.pseudo_terminal import PseudoTerminal
from roomba.files.shipped import CONFIGURATION, HOMES
from roomba.geometry import Twist
from roomba.robot.command import Command
from roomba.robot.readings import ScanReading
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

PROMISE = 0.5
"""s; so long after the last command the robot stands."""


class Rig:
    """A robot in a home, its line, and the driver at the other end, served by a thread."""

    def __init__(self, baud: int | None) -> None:
        robots = CONFIGURATION / "robots"
        config = load_simulated_config(robots / "neato.yaml", CONFIGURATION / "simulation.yaml")
        config = made_up(config.with_sensors("ideal"))
        self.simulator = Simulator(load_home("studio", HOMES, config.body), config, seed=1)
        self.terminal = PseudoTerminal(baud=baud)
        self.server = NeatoServer(NeatoRobot(self.simulator), self.terminal)
        self.server.start()
        line = SerialLine(self.terminal.name, 115_200)
        self.body = NeatoBody(Conversation(line, time.monotonic), time.monotonic)
        self.body.begin()
        self.errors: list[LineError] = []
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        while not self._is_over.is_set():
            try:
                self.body.serve()
            except LineError as error:
                self.errors.append(error)

    def stop_serving(self) -> None:
        self._is_over.set()
        self._thread.join(3.0)

    def drive_until(self, twist: Twist, is_so: Callable[[], bool], what: str) -> None:
        def looked() -> bool:
            self.body.act(Command(twist, fan=0.6))
            return is_so()

        wait_until(looked, 20.0, what, pause=0.03)

    @property
    def moves(self) -> bool:
        twist = self.simulator.observe().twist
        return abs(twist.linear) > 1e-4 or abs(twist.angular) > 1e-3

    def end(self) -> None:
        self.stop_serving()
        self.server.end()
        self.terminal.close()


@pytest.fixture(params=[None, 115_200], ids=["usb", "serial"])
def rig(request: pytest.FixtureRequest) -> Iterator[Rig]:
    made = Rig(request.param)
    yield made
    made.end()


def test_it_drives_and_its_odometry_is_the_way(rig: Rig) -> None:
    begin = rig.simulator.pose
    rig.drive_until(Twist(0.15, 0.0), lambda: rig.body.read().odometry.x > 0.25, "it drove")
    rig.drive_until(Twist(), lambda: not rig.moves, "it stands")

    def agrees() -> bool:
        told, true = rig.body.read().odometry, rig.simulator.pose
        moved = begin.inverse().compose(true)
        return abs(told.x - moved.x) < 0.005 and abs(told.y - moved.y) < 0.005

    wait_until(agrees, 5.0, "odometry tells where it is")
    assert not rig.errors


def test_it_stands_when_nothing_more_is_wanted_of_it(rig: Rig) -> None:
    rig.drive_until(Twist(0.1, 0.0), lambda: rig.moves, "it drives")
    silent = rig.simulator.time
    wait_until(lambda: not rig.moves, 5.0, "it stands")
    # The looks and the steps of the world are up to 0.05 s apart.
    assert rig.simulator.time - silent <= PROMISE + 0.05


def test_it_stands_when_its_driver_hangs(rig: Rig) -> None:
    rig.drive_until(Twist(0.1, 0.0), lambda: rig.moves, "it drives")
    rig.stop_serving()
    silent = rig.simulator.time
    wait_until(lambda: not rig.moves, 5.0, "it stands")
    assert rig.simulator.time - silent <= PROMISE + 0.05


def test_its_scans_are_those_of_its_lidar(rig: Rig) -> None:
    scans: list[ScanReading] = []

    def has_come() -> bool:
        rig.body.act(Command())
        scan = rig.body.read().scan
        if scan is not None:
            scans.append(scan)
        return len(scans) > 2

    wait_until(has_come, 20.0, "scans")
    seen, true = scans[-1].ranges, rig.simulator.ranges
    both = np.isfinite(seen) & np.isfinite(true)
    assert both.sum() > 100
    assert np.abs(seen[both] - true[both]).max() <= 0.001
    assert scans[-1].lidar.time_increment == pytest.approx(1.0 / 4.0 / 360.0, rel=0.01)


def test_garbage_on_the_line_is_passed_over(rig: Rig) -> None:
    random = np.random.default_rng(1)
    for _ in range(20):
        rig.terminal.write(random.bytes(200))
    told = rig.body.read().odometry
    rig.drive_until(Twist(0.0, 0.5), lambda: rig.body.read().odometry != told, "it goes on")
    assert rig.body.trouble == ""


def test_a_line_that_is_gone_is_told() -> None:
    rig = Rig(None)
    rig.server.end()
    rig.terminal.close()
    wait_until(lambda: bool(rig.errors), 10.0, "the driver notices")
    assert rig.body.trouble
    rig.end()


def test_a_port_that_is_not_there_is_told_with_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(LineError, match="Is it plugged in"):
        SerialLine(str(tmp_path / "ttyNone"), 115_200)


def test_a_link_names_the_line_and_replaces_no_file(tmp_path: Path) -> None:
    link = tmp_path / "neato"
    terminal = PseudoTerminal(link)
    assert os.readlink(link) == terminal.name
    terminal.close()
    assert not link.exists()
