"""The parts of the robot, one by one: readings and the place's keeper."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import HOME
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.speed_loop import Hazards
from roomba.geometry import Pose, Twist
from roomba.headless.body import SimulatedBody
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import EmptyingTold
from roomba.perception.localization.belief.belief import numbers_of, unknown_belief
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.matching.scan_view import LidarModel, PlacedScan
from roomba.perception.slam.mapper import Mapper
from roomba.robot.command import Command
from roomba.robot.place import PlaceKeeper, ScanSelection
from roomba.robot.readings import CliffReading, Readings, ScanReading, senses_of
from roomba.world.engine.state.arrays import Fault

LIDAR = LidarModel.all_around(8, 0.1, 5.0)


class Noted:
    """A place that writes down what it is told."""

    is_calm = True
    placed: PlacedScan | None = None
    sight_to_look_around = None

    def __init__(self) -> None:
        self.belief = unknown_belief()
        self.numbers, self.path = numbers_of(NOISY.localization, NOISY.gyro), ReckonedPath.empty()
        self.lifts: list[bool] = []
        self.moves: list[float] = []
        self.scans: list[float] = []

    @property
    def estimate(self) -> Estimate:
        return Estimate(Pose(), np.eye(3), Knowledge.KNOWN, 1.0, "")

    def look_anew(self) -> None:
        raise NotImplementedError

    def lift(self, is_lifted: bool) -> None:
        self.lifts.append(is_lifted)

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        self.moves.append(stamp)

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        self.scans.append(stamp)

    def feel(self, radius: float, first: float, last: float) -> None:
        """Nothing that is asked for."""

    def go_by_lidar(self) -> None:
        """Nothing that is asked for."""


def body(start: Pose | None = None) -> SimulatedBody:
    return SimulatedBody(HOME, NOISY, 1, None, start)


def passed(robot: SimulatedBody) -> Readings:
    for _ in range(2):
        robot.act(Command())
    return robot.read()


def test_senses_are_what_sensors_tell_and_where_it_believes_to_be() -> None:
    robot = body()
    believed = Pose(9.0, 8.0, 7.0), Knowledge.ROUGH, "fog", 0.3
    senses = senses_of(passed(robot), *believed)
    assert senses.pose == believed[0]
    assert (senses.knowledge, senses.trouble, senses.unsure) == (Knowledge.ROUGH, "fog", 0.3)
    assert senses.battery.is_docked
    assert senses.battery.capacity == NOISY.battery.capacity
    assert not any(senses.touches)
    assert not senses.lifted
    robot.simulator.inject(Fault.BUMPER_STUCK, 1.0)
    robot.simulator.inject(Fault.CLIFF_DIRTY, 1.0)
    robot.simulator.inject(Fault.INFRARED_BLOCKED, 1.0)
    senses = senses_of(passed(robot), *believed)
    assert (senses.bumper_left, senses.bumper_right) == (True, True)
    assert (senses.cliff_left, senses.cliff_right) == (True, True)
    assert senses.beams == StationBeams()
    robot.simulator.inject(Fault.LIFTED, 1.0)
    assert senses_of(passed(robot), *believed).lifted


@pytest.mark.parametrize("sensor", ["left", "front_left", "front_right", "right"])
def test_each_cliff_sensor_is_one_of_a_side(sensor: str) -> None:
    readings = Readings(1.0, Pose(), cliff=CliffReading(**{sensor: True}))
    senses = senses_of(readings, Pose(), Knowledge.KNOWN)
    assert readings.hazards == Hazards(cliff=True)
    assert (senses.cliff_left, senses.cliff_right) == ("left" in sensor, "right" in sensor)


@pytest.mark.parametrize("side", ["left", "right"])
def test_one_side_of_the_bumper_and_one_wheel_are_enough(side: str) -> None:
    pressed = Readings(1.0, Pose(), **{f"bumper_{side}": True})  # type: ignore[arg-type]
    assert pressed.hazards == Hazards(bumper=True)
    dropped = Readings(1.0, Pose(), **{f"dropped_{side}": True})  # type: ignore[arg-type]
    assert dropped.hazards == Hazards(wheel_drop=True)
    senses = senses_of(dropped, Pose(), Knowledge.KNOWN)
    assert (senses.wheel_hangs, senses.lifted, dropped.is_lifted) == (True, False, False)
    both = Readings(1.0, Pose(), dropped_left=True, dropped_right=True)
    senses = senses_of(both, Pose(), Knowledge.KNOWN)
    assert (senses.wheel_hangs, senses.lifted, both.is_lifted) == (True, True, True)


def test_what_is_counted_and_weighed_is_sensed_at_its_time() -> None:
    senses = senses_of(Readings(7.5, Pose(), grains=3.0, in_bin=0.5), Pose(), Knowledge.KNOWN)
    assert (senses.now, senses.grains, senses.in_bin, senses.trouble) == (7.5, 3.0, 0.5, "")


def test_what_brush_and_station_tell_comes_through() -> None:
    told = EmptyingTold(is_at_work=True, bag=0.3)
    readings = Readings(7.5, Pose(), brush_current=0.4, emptying=told)
    senses = senses_of(readings, Pose(), Knowledge.KNOWN)
    assert (senses.brush_current, senses.emptying) == (0.4, told)
    plain = senses_of(Readings(7.5, Pose()), Pose(), Knowledge.KNOWN)
    assert (plain.brush_current, plain.emptying) == (0.0, None)


def test_without_a_gyro_the_wheels_tell_how_it_turns() -> None:
    known = Pose(), Knowledge.KNOWN
    wheels = Twist(0.2, 0.5)
    assert senses_of(Readings(1.0, Pose(), twist=wheels), *known).twist == wheels
    assert senses_of(Readings(1.0, Pose(), twist=wheels, turning=0.4), *known).twist == Twist(
        0.2, 0.4
    )


@pytest.mark.parametrize(
    ("fault", "hazards"),
    [
        (Fault.BUMPER_STUCK, Hazards(bumper=True)),
        (Fault.CLIFF_DIRTY, Hazards(cliff=True)),
        (Fault.LIFTED, Hazards(wheel_drop=True)),
    ],
)
def test_what_the_body_feels_is_a_hazard(fault: Fault, hazards: Hazards) -> None:
    robot = body(Pose(1.2, 0.6, 0.0))
    assert robot.read().hazards == Hazards()
    robot.simulator.inject(fault, 1.0)
    felt = passed(robot).hazards
    assert felt == replace(hazards, cliff=felt.cliff) if fault is Fault.LIFTED else felt == hazards


def scan_at(stamp: float) -> ScanReading:
    return ScanReading(stamp, np.ones(8, np.float32), LIDAR)


@pytest.mark.parametrize(("rate", "looked_at"), [(10.0, 5), (20.0, 5), (5.0, 5), (2.0, 2)])
def test_one_scan_in_a_period_is_looked_at(rate: float, looked_at: int) -> None:
    place = Noted()
    keeper = PlaceKeeper(place, RobotConfig())
    due = 0.0
    for tick in range(20):
        now = 100.0 + 0.05 * tick
        scan = None
        if 0.05 * tick >= due - 1e-9:
            scan, due = scan_at(now), due + 1.0 / rate
        seen = keeper.follow(Readings(now, Pose(), scan=scan))
        assert (seen is not None) == (bool(place.scans) and place.scans[-1] == now)
    assert len(place.scans) == looked_at
    assert len(place.moves) == 20


def test_after_kernels_selected_scans_the_next_one_is_a_period_later() -> None:
    scans = ScanSelection(RobotConfig().timing)
    scans.resumed(100.0)
    assert not scans.selects(scan_at(100.05))
    assert scans.selects(scan_at(100.0 + RobotConfig().timing.scan_period))


def test_a_clock_that_is_set_back_hides_no_scan() -> None:
    place = Noted()
    keeper = PlaceKeeper(place, RobotConfig())
    for stamp in (100.0, 50.0, 50.05, 50.2):
        keeper.follow(Readings(stamp, Pose(), scan=scan_at(stamp)))
    assert place.scans == [100.0, 50.0, 50.2]


def test_only_both_wheels_in_the_air_mean_that_it_is_held() -> None:
    place = Noted()
    keeper = PlaceKeeper(place, RobotConfig())
    for left, right in ((True, False), (False, True), (True, True)):
        keeper.follow(Readings(1.0, Pose(), dropped_left=left, dropped_right=right))
    assert place.lifts == [False, False, True]


def test_what_a_body_tells_needs_no_compiled_code() -> None:
    """A node that takes no scans starts by half the memory."""
    program = "import roomba.robot.readings, sys; print('numba' in sys.modules)"
    told = subprocess.run(
        [sys.executable, "-c", program],
        check=True,
        capture_output=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert told.stdout.strip() == b"False"


def test_a_mapper_is_told_what_the_bumper_begins_to_feel(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[float, float, float]] = []
    monkeypatch.setattr(Mapper, "feel", lambda _, *touch: told.append(touch))
    mapper = Mapper(MappingConfig(), NOISY.localization, NOISY.gyro, Pose())
    keeper, radius = PlaceKeeper(mapper, NOISY), NOISY.body.radius
    quarter, middle = 0.5 * np.pi, max(NOISY.body.bumper_middle)
    for time, left, right in (
        (1, True, False),
        (2, True, True),
        (3, False, False),
        (4, True, True),
    ):
        keeper.follow(Readings(time, Pose(), bumper_left=left, bumper_right=right))
    assert told == [(radius, 0.0, quarter), (radius, -middle, middle)]
    keeper.follow(Readings(5.0, Pose()))
    keeper.follow(Readings(6.0, Pose(), bumper_right=True))
    assert told[2:] == [(radius, -quarter, 0.0)]


def test_a_localizer_learns_nothing_of_what_the_bumper_feels() -> None:
    felt, free = (
        Localizer(HOME.map, NOISY.localization, NOISY.gyro, NOISY.body.radius, HOME.station)
        for _ in range(2)
    )
    for localizer, touches in ((felt, True), (free, False)):
        PlaceKeeper(localizer, NOISY).follow(Readings(1.0, Pose(), bumper_left=touches))
    assert felt.pose == free.pose
    assert felt.estimate.position_deviation == free.estimate.position_deviation


def test_a_robot_that_makes_its_map_has_no_other_place_to_find() -> None:
    mapper = Mapper(MappingConfig(), NOISY.localization, NOISY.gyro, Pose())
    keeper = PlaceKeeper(mapper, NOISY)
    for is_lifted in (True, False):
        mapper.lift(is_lifted)
        assert keeper.look_around(1.0, touches=True) is None
    assert mapper.estimate.knowledge is Knowledge.LOST


def test_a_robot_that_makes_its_map_keeps_its_lidar_where_it_is() -> None:
    mapper = Mapper(MappingConfig(), NOISY.localization, NOISY.gyro, Pose())
    before = mapper.belief.tobytes()
    PlaceKeeper(mapper, NOISY).recalibrated(scan_at(1.0))
    assert mapper.belief.tobytes() == before
