"""A robot that localizes itself in a home by its sensors alone, beside its true pose."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.errors import HomeError
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.scan_view import LidarModel
from roomba.world.home.home import Home, cells_in
from roomba.world.layers.layer import load_home
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator
from roomba_bench.floors import Floor, room_for
from roomba_bench.ours_sim import ROBOT

STEP, STEPS = 0.025, 2
"""s of a step, and steps of a tick."""
WRONG = 0.15
"""m or rad; a pose with a larger error is wrong, and should not be called known."""
_ROOM = 0.06
"""m between the body and the middle of a solid cell, where the robot is put down."""
_APART = 0.6
"""m; between the middles of the robot and of a thing that is put down."""
_ATTEMPTS = 1000


class LocalizedRobot:
    """A simulated robot with its shipped noise, and a localizer that gets its readings."""

    def __init__(self, home: Home, seed: int) -> None:
        """Stand at the station, and know it."""
        self.home = home
        self.config = ROBOT
        self.simulator = Simulator(home, self.config, seed=seed)
        self.localizer = Localizer(
            home.map,
            self.config.localization,
            self.config.gyro,
            self.config.body.radius,
            home.station,
        )
        lidar = self.config.lidar
        self.lidar = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
        self.seen: Observation = self.simulator.observe()
        self.ranges = self.simulator.ranges
        self.has_scanned = False
        """Whether the last tick brought a scan."""

    def tick(self, wanted: Twist) -> None:
        """Drive for a tick, and tell the localizer what was sensed."""
        scans = self.seen.scans
        self.simulator.advance(wanted, STEP, STEPS)
        seen = self.seen = self.simulator.observe()
        self.has_scanned = seen.scans != scans
        self.localizer.lift(seen.wheels.dropped)
        self.localizer.move(seen.time, seen.odometry, seen.angular_velocity)
        if self.has_scanned:
            self.ranges = self.simulator.ranges
            self.localizer.see(seen.time, self.ranges, self.lidar)

    @property
    def touches(self) -> bool:
        """Whether the robot feels a thing, or a missing floor."""
        return self.seen.bumper.pressed or self.seen.cliff.any

    @property
    def is_known(self) -> bool:
        """Whether the localizer calls its pose known."""
        return self.localizer.estimate.knowledge is Knowledge.KNOWN

    def is_off(self, metres: float, radians: float) -> bool:
        """Whether the estimate's error is larger than this."""
        believed, true = self.localizer.estimate.pose, self.seen.pose
        away = math.hypot(believed.x - true.x, believed.y - true.y)
        return away > metres or abs(wrap_angle(believed.theta - true.theta)) > radians


class Spots:
    """Places on a home's floor that a body can reach from the station, by the map."""

    def __init__(self, home: Home, radius: float) -> None:
        """``radius`` is the body's, m; stairs are no floor."""
        self._frame = home.frame
        room = room_for(Floor(home.name, home.map.solid | home.drop, home.frame), radius + _ROOM)
        _, labels = cv2.connectedComponents(room.astype(np.uint8), connectivity=4)
        rows, columns = np.nonzero(labels)
        frame = home.frame
        x = frame.origin_x + (columns + 0.5) * frame.resolution
        y = frame.origin_y + (rows + 0.5) * frame.resolution
        nearest = int(np.argmin(np.hypot(x - home.station.x, y - home.station.y)))
        mine = labels[rows, columns] == labels[rows[nearest], columns[nearest]]
        self._places: NDArray[np.float64] = np.column_stack([x, y])[mine]

    def random(self, random: np.random.Generator) -> Pose:
        """Return one of them, with a direction."""
        x, y = self._places[random.integers(len(self._places))]
        across = random.uniform(-0.5, 0.5, 2) * self._frame.resolution
        return Pose(float(x + across[0]), float(y + across[1]), random.uniform(-math.pi, math.pi))


def home_named(name: str, folder: str = "") -> Home:
    """Return a shipped home, or the one of a map of a folder."""
    return load_home(str(Path(folder) / f"{name}.yaml") if folder else name, HOMES)


def with_closed_door(home: Home, random: np.random.Generator) -> Home:
    """Return the home with one door shut that its map shows open; unchanged without open doors."""
    doors = [door for door in home.doors if door.is_open]
    if not doors:
        return home
    shut = cells_in(home.frame, [doors[int(random.integers(len(doors)))].opening])
    return replace(home, solid=home.solid | shut, walls=home.walls | shut)


def stand_things(
    simulator: Simulator, spots: Spots, count: int, random: np.random.Generator
) -> None:
    """Stand so many round things of 0.1 to 0.3 m about, none of them on or next to the robot."""
    here = simulator.pose
    for _ in range(count):
        for _ in range(_ATTEMPTS):
            spot = spots.random(random)
            if spot.distance_to(here.x, here.y) > _APART:
                break
        simulator.place_obstacle(spot.x, spot.y, random.uniform(0.1, 0.3))


def put_anywhere(simulator: Simulator, spots: Spots, random: np.random.Generator) -> None:
    """Put the robot down at a random spot where it fits; raises HomeError if it fits nowhere."""
    for _ in range(_ATTEMPTS):
        try:
            simulator.put(spots.random(random))
            return
        except HomeError:
            continue
    raise HomeError(f"{simulator.home.name}: expected a spot where the robot fits, found none")
