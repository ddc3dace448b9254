"""Numbers of the simulated robot that its brain does not know: errors, dirt and energy.

The simulator alone reads them. What is true and known as well, such as the body's size, is in
``configuration/robot.py``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field, model_validator

from roomba.configuration.body import Speed
from roomba.configuration.frozen import (
    Duration,
    Frozen,
    Length,
    NotNegative,
    Positive,
    Ratio,
    Side,
    Wait,
    load_config,
    read_yaml,
    validated,
)
from roomba.configuration.robot import UNKNOWN, RobotConfig
from roomba.configuration.sensors import (
    LIDAR,
    SIMULATION,
    LidarConfig,
    lidar_file,
    with_model,
)

Sensors = Literal["ideal", "noisy"]
Wheels = Literal["factory", "worn"]
_SIMPLE_ERRORS: Final = frozenset({"noise", "misses", "dark", "shiny"})
"""Errors of a lidar that need no simulation beam by beam; dark and shiny things are only seen by
one that has a reach."""


class SimulatedBrush(Frozen):
    """What the brush picks up of the dirt that it is driven over, and what it draws.

    One pass of the brush at full power picks up the share ``pickup``; with the fan see
    :func:`pickup_share`. Depth in m, power in W, current in A, noise in dB(A) at 1 m.
    """

    depth: Side = 0.05
    pickup: Ratio = 0.60
    carpet_pickup: Ratio = 0.45
    power: NotNegative = 3.0
    carpet_power: NotNegative = 6.0
    current_noise: NotNegative = 0.02
    noise_level: NotNegative = 58.0


class SimulatedFan(Frozen):
    """Suction, energy (W) and noise (dB(A) at 1 m) of the fan at full duty."""

    pickup: Ratio = 0.83
    power: NotNegative = 25.0
    noise_level: NotNegative = 68.0


class SimulatedBattery(Frozen):
    """What everything draws from the battery: W, V, ohm, h, degrees Celsius, s."""

    resistance: NotNegative = 0.15
    idle_power: NotNegative = 5.3
    drive_power: NotNegative = 3.1
    drive_speed: Speed = 0.306
    stall_power: NotNegative = 15.0
    charge_hours: Annotated[float, Field(ge=0.01, le=48.0)] = 2.2
    ambient: Annotated[float, Field(ge=-20.0, le=60.0)] = 22.0
    heating: NotNegative = 0.4
    heating_time: Duration = 900.0
    taper_from: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.9
    """Share of the charge from which on charging becomes slower, evenly, down to ``taper_to``."""
    taper_to: Annotated[float, Field(gt=0.0, lt=1.0)] = 0.2
    """Share of the power that is left when the battery is full."""


class SimulatedLidar(Frozen):
    """Errors of the lidar.

    ``noise`` and ``noise_growth``
        Standard deviation of a range r that meets a surface squarely: m, and m for r = 1 m; it is
        noise + noise_growth r^2, as of a lidar that triangulates.
    ``grazing_noise``
        Share by which that deviation grows per unit of 1 / cos(angle to the normal) - 1.
    ``misses``
        Share of the beams that have no range, near or far.
    ``range_step``, ``angle_rounding``
        Ranges are rounded to such steps, m; a beam points up to half of so much, degrees, to either
        side of the angle that is told.
    ``spot``
        Width of a beam, degrees: at an edge its range lies between those of both sides.
    ``white_reach``
        How far white paint is seen, m, if met squarely; others by reflectivity and angle; 0: all.
    ``dark``, ``shiny``
        Shares of a home's surfaces: black ones, and those that are seen only head on.
    ``delay``
        s; from the end of a sweep until it has come over the line.
    """

    noise: Annotated[float, Field(ge=0.0, le=0.2)] = 0.003
    noise_growth: Annotated[float, Field(ge=0.0, le=0.02)] = 0.0016
    grazing_noise: NotNegative = 0.3
    misses: Ratio = 0.02
    range_step: NotNegative = 0.001
    angle_rounding: NotNegative = 0.5
    spot: NotNegative = 0.4
    white_reach: NotNegative = 10.0
    dark: Ratio = 0.1
    shiny: Ratio = 0.05
    delay: NotNegative = 0.0

    @property
    def is_simple(self) -> bool:
        """Whether there is nothing but noise and beams that are missed."""
        return not any(
            getattr(self, name) for name in type(self).model_fields if name not in _SIMPLE_ERRORS
        )


class SimulatedWheels(Frozen):
    """How wheels slip: shares of the way, and what varies, m/sqrt(m), over ``slip_length`` m.

    ``noise_level`` is that of the wheels alone, dB(A) at 1 m.
    """

    scale_error: NotNegative = 0.001
    slip: Ratio = 0.001
    carpet_slip: Ratio = 0.02
    slip_noise: NotNegative = 0.002
    slip_length: Length = 0.1
    blocked_slip: Ratio = 0.3
    noise_level: NotNegative = 45.0


class SimulatedGyro(Frozen):
    """Errors of gyro and accelerometer: rad/s, m/s2; walk rad/s/sqrt(s)."""

    noise: NotNegative = 0.0015
    bias: NotNegative = 0.0005
    bias_walk: NotNegative = 0.00002
    scale_error: NotNegative = 0.003
    acceleration_noise: NotNegative = 0.03
    most_acceleration: Positive = 19.6


class SimulatedWear(Frozen):
    """By how much worn parts are off at most, either way; a seed draws evenly within that.

    ``wheel`` and ``base`` are shares of each wheel's radius and of the distance between both,
    ``gyro`` a share of what the gyro tells; the lidar sits up to ``lidar_shift``, m, along either
    axis and ``lidar_turn``, degrees, off. ``carpet_pull`` is how far carpets carry the robot along
    their pile, m for each metre that its wheels roll there; the pile of all carpets of a home lies
    alike.
    """

    wheel: Annotated[float, Field(ge=0.0, le=0.1)] = 0.02
    base: Annotated[float, Field(ge=0.0, le=0.1)] = 0.02
    gyro: Annotated[float, Field(ge=0.0, le=0.1)] = 0.015
    lidar_shift: Annotated[float, Field(ge=0.0, le=0.1)] = 0.01
    lidar_turn: Annotated[float, Field(ge=0.0, le=5.0)] = 1.0
    carpet_pull: Annotated[float, Field(ge=0.0, le=0.1)] = 0.01


class SimulatedStation(Frozen):
    """How near to the docked pose the contacts touch, m and degrees; and how the bin is emptied."""

    position_tolerance: Length = 0.015
    angle_tolerance: Positive = 8.0
    emptying_time: Wait = 8.0
    """s; how long a station that empties the bin takes for that."""
    emptying_noise: NotNegative = 76.0
    """dB(A) at 1 m, while it empties the bin."""
    bag: Positive = 2500.0
    """g; what its bag takes."""


class SimulatedSurroundings(Frozen):
    """What is true of every home: how its surfaces give back a lidar's light, crumbs, and quiet.

    Reflectivities, 0..1, are those in the infrared.
    """

    patch: Length = 0.7
    """m; side of the squares in which surfaces are of one reflectivity."""
    black: Ratio = 0.04
    """Reflectivity of black leather, black lacquer, dark fabric."""
    dimmest: Ratio = 0.35
    """The least reflectivity of all else: wood and fabrics."""
    white: Annotated[float, Field(gt=0.0, le=1.0)] = 0.9
    """The largest: white paint."""
    movable: Ratio = 0.6
    """Reflectivity of what is no part of the home."""
    shiny_cosine: Ratio = 0.96
    """Cosine to the normal; a shiny surface is seen when it is met as squarely."""
    glass: Ratio = 0.5
    """Share of the beams that glass sends back where it is met squarely; all others pass."""
    glass_cosine: Ratio = 0.98
    """Cosine to the normal; glass is seen when it is met as squarely."""
    clear: Ratio = 0.8
    """Share of the light that is left, there and back, after a pane of glass or a mirror."""
    fading: NotNegative = 0.08
    """Share of the reach by which a faint echo comes and goes."""
    edge: Length = 0.10
    """m; a wide beam whose range differs by more from the last one's may lie on an edge."""
    crumb: Annotated[int, Field(gt=0, le=1_000_000)] = 2000
    """Micrograms; what falls at once from a source of dirt."""
    quiet: NotNegative = 20.0
    """dB(A) at 1 m; of a robot that stands in a quiet room."""

    in_order: ClassVar[tuple[str, ...]] = ("black < dimmest <= white",)


class SimulationConfig(Frozen):
    """All of ``configuration/simulation.yaml``; every part has the shipped file's values.

    ``sensors``: "noisy" ones have the errors given here, and wheels slip; "ideal" ones tell the
    truth, and wheels slip by faults only. The robot's ``condition`` is that in which it left the
    factory, or "worn": then wheels, gyro and lidar are off as ``wear`` says, with ideal sensors,
    too.
    """

    sensors: Sensors = "noisy"
    condition: Wheels = "factory"
    brush: SimulatedBrush = SimulatedBrush()
    fan: SimulatedFan = SimulatedFan()
    battery: SimulatedBattery = SimulatedBattery()
    lidar: SimulatedLidar = SimulatedLidar()
    wheels: SimulatedWheels = SimulatedWheels()
    gyro: SimulatedGyro = SimulatedGyro()
    wear: SimulatedWear = SimulatedWear()
    station: SimulatedStation = SimulatedStation()
    surroundings: SimulatedSurroundings = SimulatedSurroundings()


class SimulatedRobotConfig(RobotConfig):
    """A robot as it knows itself, and under ``simulation`` what is true of it beside."""

    simulation: SimulationConfig = SimulationConfig()

    def with_sensors(self, sensors: Sensors) -> SimulatedRobotConfig:
        """Return the same robot with sensors of that kind."""
        simulation = self.simulation.model_copy(update={"sensors": sensors})
        return self.model_copy(update={"simulation": simulation})

    def with_wheels(self, condition: Wheels) -> SimulatedRobotConfig:
        """Return the same robot as it left the factory, or worn."""
        simulation = self.simulation.model_copy(update={"condition": condition})
        return self.model_copy(update={SIMULATION: simulation})

    def with_emptying_station(self) -> SimulatedRobotConfig:
        """Return the same robot at a station that empties its bin."""
        station = self.station.model_copy(update={"empties": True})
        return self.model_copy(update={"station": station})

    def with_lidar(self, model: str) -> SimulatedRobotConfig:
        """Return the same robot with a lidar as sold, mounted as high; ConfigError if unknown."""
        found = lidar_file(model)
        mount = {"mount_height": self.lidar.mount_height, "mount_ahead": self.lidar.mount_ahead}
        known = {**found[LIDAR], "model": model, **mount}
        errors = validated(SimulatedLidar, found[SIMULATION], f"{model}: ")
        simulation = self.simulation.model_copy(update={LIDAR: errors})
        lidar = validated(LidarConfig, known, f"{model}: ")
        return self.model_copy(update={LIDAR: lidar, SIMULATION: simulation})

    @property
    def is_swept(self) -> bool:
        """Whether the lidar is simulated beam by beam: it turns, or has errors that need it."""
        lidar, errors = self.lidar, self.simulation.lidar
        return lidar.sweep_time > 0.0 or lidar.field < 360.0 or not errors.is_simple

    @model_validator(mode="after")
    def _scans_arrive_in_time(self) -> SimulatedRobotConfig:
        period = 1.0 / self.lidar.rate
        if self.simulation.lidar.delay > period + 1e-9:
            raise ValueError(f"expected simulation.lidar.delay of at most 1 / rate ({period:g} s)")
        return self


def pickup_share(brush: float, fan: float) -> float:
    """Return the share that one pass picks up, of those that brush and fan would alone: 0..1."""
    return 1.0 - (1.0 - brush) * (1.0 - fan)


def load_simulated_config(path: Path, simulation: Path) -> SimulatedRobotConfig:
    """Read a file like ``configuration/robot.yaml`` with its part ``simulation``, all of it.

    Where it has no such part, that is read from a file like ``configuration/simulation.yaml``.
    Raises :class:`ConfigError` with the reason.
    """
    raw = read_yaml(path)
    if isinstance(raw, dict):
        if SIMULATION not in raw:
            shipped = load_config(SimulationConfig, simulation)
            raw[SIMULATION] = shipped.model_dump(exclude_unset=True)
        raw = with_model(raw)
    return validated(SimulatedRobotConfig, raw, f"{path}: ", UNKNOWN)
