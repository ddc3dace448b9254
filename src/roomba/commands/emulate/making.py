"""What can be emulated: each robot or lidar is put together from its parts, begun and ended."""

from __future__ import annotations

import argparse
import math
import signal
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from roomba.files.shipped import CONFIGURATION, HOMES

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from roomba.configuration.simulation import SimulatedRobotConfig
    from roomba.world.simulator import Simulator

Given = argparse.Namespace
BAUD: Final = 115_200
LD19_BAUD: Final = 230_400


@contextmanager
def _neato(given: Given) -> Iterator[str]:
    from roomba.emulators.neato.dialects import Model
    from roomba.emulators.neato.robot import NeatoRobot, made_up
    from roomba.emulators.neato.server import NeatoServer
    from roomba.emulators.pseudo_terminal import PseudoTerminal

    simulator = _in_home(given, made_up(_config("neato")))
    robot = NeatoRobot(simulator, Model(given.model))
    line = PseudoTerminal(given.link, round(BAUD * given.speed) if given.serial else None)
    try:
        with NeatoServer(robot, line, given.speed):
            yield f"A Neato lives in the home {given.home}, on {given.link or line.name}."
    finally:
        line.close()


@contextmanager
def _openneato(given: Given) -> Iterator[str]:
    from roomba.emulators.neato.bridge import NeatoBridge
    from roomba.emulators.neato.robot import NeatoRobot, made_up
    from roomba.errors import RoombaError

    simulator = _in_home(given, made_up(_config("neato")))
    try:
        bridge = NeatoBridge(NeatoRobot(simulator), given.port, given.speed)
    except OSError as error:
        raise RoombaError(f"expected a free port, got {given.port}: {error}") from error
    with bridge:
        yield f"A Neato with OpenNeato's bridge is in the home {given.home}, at {bridge.address}."


@contextmanager
def _create2(given: Given) -> Iterator[str]:
    from roomba.emulators.create2.robot import SLEEPS_AFTER, Create2Robot
    from roomba.emulators.create2.server import Create2Server
    from roomba.emulators.lidars.ld19 import Ld19Emulator, with_ld19
    from roomba.emulators.lidars.sender import LidarSender
    from roomba.emulators.living import LivingWorld
    from roomba.emulators.pseudo_terminal import PseudoTerminal

    simulator = _in_home(given, with_ld19(_config("create2")))
    sleeps_after = SLEEPS_AFTER if given.sleeps else math.inf
    robot, lidar = Create2Robot(simulator, given.baud, sleeps_after), Ld19Emulator(simulator)
    signal.signal(signal.SIGUSR1, lambda *_: robot.press_button())
    line = PseudoTerminal(given.link, given.baud if given.serial else None, given.speed)
    try:
        lidar_line = PseudoTerminal(given.lidar_link, _lidar_baud(given))
    except Exception:
        line.close()
        raise
    sender = LidarSender(lidar_line)

    def step() -> None:
        robot.advance()
        sender.put(lidar.advance())

    world = LivingWorld(step, given.speed)
    server = Create2Server(robot, line, world, given.speed)
    parts = (sender, server, world)
    try:
        for part in parts:
            part.start()
        yield (
            f"A Create 2 lives in the home {given.home}, on {given.link or line.name}; its LD19 "
            f"is on {given.lidar_link or lidar_line.name}."
        )
    finally:
        for part in reversed(parts):
            part.end()
        line.close()
        lidar_line.close()


@contextmanager
def _ld19(given: Given) -> Iterator[str]:
    from roomba.emulators.lidars.ld19 import Ld19Emulator, with_ld19
    from roomba.emulators.lidars.sender import LidarSender
    from roomba.emulators.living import STEP, LivingWorld
    from roomba.emulators.pseudo_terminal import PseudoTerminal
    from roomba.geometry import STANDSTILL

    simulator = _in_home(given, with_ld19(_config("create2")))
    lidar = Ld19Emulator(simulator)
    line = PseudoTerminal(given.link, _lidar_baud(given))
    sender = LidarSender(line)

    def step() -> None:
        simulator.advance(STANDSTILL, STEP, 1)
        sender.put(lidar.advance())

    world = LivingWorld(step, given.speed)
    try:
        sender.start()
        world.start()
        yield f"An LD19 stands in the home {given.home}, on {given.link or line.name}."
    finally:
        world.end()
        sender.end()
        line.close()


def _lidar_baud(given: Given) -> int | None:
    return round(LD19_BAUD * given.speed) if given.serial else None


def _config(robot: str) -> SimulatedRobotConfig:
    from roomba.configuration.simulation import load_simulated_config

    return load_simulated_config(
        CONFIGURATION / "robots" / f"{robot}.yaml", CONFIGURATION / "simulation.yaml"
    )


def _in_home(given: Given, config: SimulatedRobotConfig) -> Simulator:
    from roomba.world.layers.layer import load_home
    from roomba.world.simulator import Simulator

    return Simulator(load_home(given.home, HOMES, config.body), config, seed=given.seed)


MADE_UP: Final[Mapping[str, Callable[[Given], AbstractContextManager[str]]]] = MappingProxyType(
    {"neato": _neato, "openneato": _openneato, "create2": _create2, "ld19": _ld19}
)
"""By name, a context in which the emulation runs; it gives a text to print."""
