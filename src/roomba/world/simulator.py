"""The simulated world: one robot in one home, a step at a time.

Poses are told in the home's frame: for a home that was turned, in the turned frame. ``dirt`` and
``numbers`` are in the home's own axes, as the world is.

Seeded: the same home, configuration, seed and commands give the same trace, bit for bit. It is a
fleet of one, so the same compiled code runs a robot alone and a thousand.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.world.emptying import EmptyingStation
from roomba.world.engine.brush_kernels import amount_under_disc
from roomba.world.engine.lidar.projection import ScanBuffers
from roomba.world.engine.state.arrays import Fault, Infrared, Rows, State
from roomba.world.fleet import Fleet
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM, DirtField
from roomba.world.home.home import Home, MovingKind
from roomba.world.observation import Bumper, Cliff, Observation, Wheels
from roomba.world.power import battery_state, noise_level

_CHAIR: Final = 0.40
"""m; between the middles of a chair's legs."""
_LEG: Final = 0.02
"""m; radius of a leg."""
_EMPTYING: Final = "emptying"
"""The name under which a station that empties the bin is saved."""


class Simulator:
    """A robot in its home; :meth:`step` is the only thing that lets time pass.

    ``emptying`` is the robot's station if it empties the bin, else None.
    """

    def __init__(
        self,
        home: Home,
        config: SimulatedRobotConfig | None = None,
        *,
        seed: int = 0,
        max_speed: float | None = None,
        start: Pose | None = None,
    ) -> None:
        """Put the robot at ``start``, map frame (the station, if none), and the home's dirt down.

        ``max_speed``, m/s, is what its drive does at most: by default what its body can.

        Raises HomeError when the body does not fit at the start.
        """
        config = config or SimulatedRobotConfig()
        self.start = start or config.body.docked_at(home.station)
        max_speed = config.body.max_speed if max_speed is None else max_speed
        own = home.own(self.start)
        starts = np.array([[own.x, own.y, own.theta]], np.float64)
        self._fleet = Fleet(
            [home], config, seeds=[seed], max_speed=max_speed, starts=starts, threads=1
        )
        self.home = home
        self.config = self._fleet.config
        self.dirt: DirtField = self._fleet.dirt(0)
        self._wanted = np.zeros((1, 2), np.float64)
        station = EmptyingStation(config.simulation.station)
        self.emptying = station if config.station.empties else None

    @property
    def time(self) -> float:
        """Seconds since the beginning."""
        return float(self._fleet.worlds["time"][0])

    @property
    def pose(self) -> Pose:
        """Where the body stands, in the map frame."""
        x, y, theta = self._fleet.poses[0].tolist()
        return self.home.told(Pose(x, y, theta))

    @property
    def max_speed(self) -> float:
        """What the drive does at most, m/s; may be set."""
        return float(self._fleet.robots["max_speed"][0])

    @max_speed.setter
    def max_speed(self, speed: float) -> None:
        self._fleet.limit_speed(speed)

    @property
    def gap(self) -> float:
        """Distance from the body's rim to the nearest solid thing, m, up to one body radius."""
        return self._fleet.gap(0)

    @property
    def brought_in(self) -> int:
        """Micrograms of dirt that ever came into the home."""
        return int(self._fleet.worlds["brought_in"][0])

    @property
    def in_bin(self) -> int:
        """Micrograms in the bin."""
        return int(self._fleet.robots["in_bin"][0])

    @property
    def numbers(self) -> dict[str, float]:
        """All of the robot's numbers by name: ROBOT of :mod:`roomba.world.engine.state.arrays`."""
        names = self._fleet.robots.dtype.names or ()
        return dict(zip(names, self._fleet.robots[0].tolist(), strict=True))

    @property
    def ranges(self) -> NDArray[np.float32]:
        """The lidar's last scan, float32 [beams], m: see :class:`roomba.world.lidar.Lidar`."""
        ranges: NDArray[np.float32] = self._fleet.ranges[0].copy()
        return ranges

    @property
    def things(self) -> NDArray[np.float64]:
        """Where the home's moving things are, float64 [things, 4]: x, y, theta, present."""
        things = self._fleet.things(0)
        if self.home.turned is None:
            return things
        things[:, 2] += self.home.axes.theta
        return self.home.axes.transform(things)

    @property
    def discs(self) -> NDArray[np.float64]:
        """Round things that were put down, float64 [discs, 3]: x, y, radius, m."""
        discs = self._fleet.discs(0)
        return discs if self.home.turned is None else self.home.axes.transform(discs)

    def step(self, wanted: Twist, dt: float) -> Observation:
        """Let ``dt`` s pass with the command ``wanted``; return the observation after it.

        Raises ValueError for a twist or a time that is not finite, or a time that is not above 0.
        """
        self.advance(wanted, dt, 1)
        return self.observe()

    def advance(self, wanted: Twist, dt: float, steps: int) -> None:
        """Let so many steps pass, as :meth:`step` does, without looking."""
        if not wanted.is_finite or not math.isfinite(dt) or dt <= 0.0:
            raise ValueError(f"expected a finite twist and dt > 0 s, got {wanted}, dt={dt}")
        self._wanted[0] = wanted.linear, wanted.angular
        self._fleet.step(self._wanted, dt, steps)
        if self.emptying is not None:
            self._empty(self.emptying, dt * steps)

    def _empty(self, station: EmptyingStation, seconds: float) -> None:
        """Let the station take dirt out of the bin."""
        now = self.numbers
        in_bin = now["in_bin"] / MICROGRAMS_PER_GRAM
        taken = station.pass_time(seconds, in_bin, is_docked=now["docked"] > 0.0)
        if taken > 0.0:
            left = round((in_bin - taken) * MICROGRAMS_PER_GRAM)
            self._fleet.robots["in_bin"] = max(left, 0)

    def observe(self) -> Observation:
        """Return the present observation; no time passes."""
        now = self.numbers
        radius = self.config.body.radius
        under = amount_under_disc(self.dirt.micrograms, self.dirt.place, now["x"], now["y"], radius)
        return Observation(
            time=self.time,
            pose=self.home.told(Pose(now["x"], now["y"], now["theta"])),
            twist=Twist(now["ground_linear"], now["ground_angular"]),
            odometry=Pose(now["odometry_x"], now["odometry_y"], now["odometry_theta"]),
            odometry_twist=Twist(now["odometry_linear"], now["odometry_angular"]),
            bumper=Bumper(now["bumper_left"] > 0.0, now["bumper_right"] > 0.0),
            cliff=Cliff(
                now["cliff_left"] > 0.0,
                now["cliff_front_left"] > 0.0,
                now["cliff_front_right"] > 0.0,
                now["cliff_right"] > 0.0,
            ),
            wheels=Wheels(
                now["encoder_left"],
                now["encoder_right"],
                now["drop_left"] > 0.0,
                now["drop_right"] > 0.0,
                now["stall_left"] > 0.0,
                now["stall_right"] > 0.0,
            ),
            angular_velocity=now["gyro"],
            acceleration=now["acceleration"],
            infrared=Infrared(int(now["beams"])),
            battery=battery_state(
                self.config.battery.capacity,
                self.config.simulation.battery.resistance,
                self.config.battery.cells,
                charge=now["charge"],
                power=now["power"],
                temperature=now["temperature"],
                is_docked=now["docked"] > 0.0,
            ),
            dirt_under=under / MICROGRAMS_PER_GRAM,
            in_bin=now["in_bin"] / MICROGRAMS_PER_GRAM,
            grains=float(round(now["grains"])),
            brush_current=now["brush_current"],
            scans=int(now["scans"]),
            scan_stamp=now["scan_stamp"],
        )

    def set_power(self, brush: float | None = None, fan: float | None = None) -> None:
        """Set the duty of brush and fan, 0..1; None leaves one as it is. ValueError for others.

        Both rest while the robot stands.
        """
        wanted = {"brush": brush, "fan": fan}
        for name, duty in wanted.items():
            if duty is not None and not 0.0 <= duty <= 1.0:
                raise ValueError(f"{name}: expected a duty from 0 to 1, got {duty}")
        for name, duty in wanted.items():
            if duty is not None:
                self._fleet.robots[f"{name}_duty"] = duty

    def set_charge(self, level: float) -> None:
        """Set what is in the battery, 0..1; raises ValueError for another level."""
        if not 0.0 <= level <= 1.0:
            raise ValueError(f"expected a charge from 0 to 1, got {level}")
        self._fleet.robots["charge"] = level * self.config.battery.capacity

    def empty_bin(self) -> float:
        """Take all out of the bin; return how much it was, g."""
        taken = self.in_bin
        self._fleet.robots["in_bin"] = 0
        return taken / MICROGRAMS_PER_GRAM

    @property
    def duty(self) -> tuple[float, float]:
        """Duty of brush and fan, 0..1."""
        robots = self._fleet.robots
        return float(robots["brush_duty"][0]), float(robots["fan_duty"][0])

    @property
    def compiled(self) -> tuple[State, Rows, NDArray[np.float32], ScanBuffers]:
        """What :func:`roomba.world.engine.step_kernels.advance` takes: for other compiled loops."""
        return self._fleet.compiled

    @property
    def noise_level(self) -> float:
        """How loud it is now, dB(A) at 1 m."""
        now = self.numbers
        if self.emptying is not None and self.emptying.is_at_work:
            return self.config.simulation.station.emptying_noise
        stands = now["linear"] == 0.0 and now["angular"] == 0.0
        if stands:
            return self.config.simulation.surroundings.quiet
        return noise_level(self.config.simulation, self.duty)

    def spill(self, x: float, y: float, radius: float, grams: float) -> None:
        """Spill crumbs around a point of the map frame; raises ValueError as DirtField.spread."""
        own = self.home.own(Pose(x, y, 0.0))
        self._fleet.worlds["brought_in"] += self.dirt.spread(own.x, own.y, radius, grams)

    def place_obstacle(self, x: float, y: float, radius: float) -> None:
        """Stand a round thing on the floor that no map knows; ValueError as Fleet.put_discs."""
        own = self.home.own(Pose(x, y, 0.0))
        self._fleet.put_discs(0, np.array([[own.x, own.y, radius]]))

    def place_chair(self, pose: Pose) -> None:
        """Stand a chair's four legs on the floor around a pose; ValueError as Fleet.put_discs."""
        half = 0.5 * _CHAIR
        corners = [
            self.home.own(pose).compose(Pose(ahead, aside, 0.0))
            for ahead in (-half, half)
            for aside in (-half, half)
        ]
        self._fleet.put_discs(0, np.array([[leg.x, leg.y, _LEG] for leg in corners]))

    def remove_obstacles(self) -> None:
        """Take all round things away."""
        self._fleet.remove_discs(0)

    def set_door(self, name: str, *, is_shut: bool) -> None:
        """Shut or open a door with a leaf that moves, for the rest of the day.

        It shuts as soon as the robot is out of its way. Raises ValueError for another name.
        """
        things = self.home.exact.moving
        leaves = {t.name: n for n, t in enumerate(things) if t.kind is MovingKind.DOOR}
        if name not in leaves:
            raise ValueError(f"expected a door of: {', '.join(leaves) or 'none'}; got {name!r}")
        self._fleet.keep_thing(0, leaves[name], is_present=is_shut)

    def inject(self, fault: Fault, value: float) -> None:
        """Set a fault, 0..1 (0: none); raises ValueError for another value."""
        self._fleet.inject(0, fault, value)

    def put(self, pose: Pose) -> None:
        """Put the robot down somewhere else; raises HomeError where it does not fit."""
        self._fleet.put(0, self.home.own(pose))

    def save(self) -> dict[str, NDArray[np.generic]]:
        """Return a copy of all that can change."""
        saved = self._fleet.save()
        return saved if self.emptying is None else {**saved, _EMPTYING: self.emptying.save()}

    def restore(self, saved: Mapping[str, NDArray[np.generic]]) -> None:
        """Bring back what :meth:`save` returned, of the same home; ValueError for another's."""
        if (_EMPTYING in saved) != (self.emptying is not None):
            does = "does not empty" if self.emptying is None else "empties"
            raise ValueError(
                f"expected what was saved with a station that {does} the bin; restore it with the "
                "same configuration"
            )
        self._fleet.restore(saved)
        if self.emptying is not None:
            self.emptying.restore(saved[_EMPTYING].astype(np.float64))

    def digest(self) -> str:
        """Return a SHA-256 over everything that can change, hexadecimal."""
        if self.emptying is None:
            return self._fleet.digest()
        hashed = hashlib.sha256(self._fleet.digest().encode())
        hashed.update(self.emptying.save().tobytes())
        return hashed.hexdigest()
