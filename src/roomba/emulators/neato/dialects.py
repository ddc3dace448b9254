"""How Neatos of two ages tell what they measure: the same things under other names.

Sources: OpenNeato's page of the serial protocol (Botvac D3 to D7); the labels that
mikeferguson/neato_robot reads (XV-11). What they keep of themselves is in ``records``.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from roomba.world.observation import Observation
from roomba.world.power import BatteryState

Rows = Sequence[str]
_FLOOR, _DEEP = 19, 200
"""mm, what the drop sensors tell over the floor, and beyond an edge."""
_FAR: Final = 255
"""mm; the wall sensor sees no wall."""
_STATION: Final = 20.0
"""V, of the station's contacts (assumed)."""
_WHEEL_RADIUS: Final = 36.0
"""mm (assumed); for the turns a minute alone."""


class Model(Enum):
    """A robot by how it speaks."""

    BOTVAC = "botvac"
    """Botvac Connected, D3 to D7."""
    XV11 = "xv11"
    """XV-11 and its like."""


@dataclass(frozen=True, slots=True)
class Wheel:
    """How far a wheel rolled, mm, and how fast it rolls, mm/s."""

    position: float
    speed: float

    @property
    def rpm(self) -> int:
        """Turns a minute."""
        return round(60.0 * self.speed / (2.0 * math.pi * _WHEEL_RADIUS))


@dataclass(frozen=True, slots=True)
class Power:
    """Turns a minute of the brush, % of the fan, mW of the side brush."""

    brush: int
    fan: int
    side_brush: int


class Dialect(ABC):
    """The rows of each answer, without its heading."""

    @abstractmethod
    def charger(self, battery: BatteryState) -> Rows:
        """Return the rows of the answer to GetCharger."""

    @abstractmethod
    def analog(self, seen: Observation, power: Power) -> Rows:
        """Return the rows of the answer to GetAnalogSensors."""

    @abstractmethod
    def digital(self, seen: Observation) -> Rows:
        """Return the rows of the answer to GetDigitalSensors."""

    @abstractmethod
    def motors(self, left: Wheel, right: Wheel, power: Power) -> Rows:
        """Return the rows of the answer to GetMotors."""


class Botvac(Dialect):
    """Botvac D3 to D7."""

    def charger(self, battery: BatteryState) -> Rows:
        """Return the newer firmware's labels."""
        return [
            *_fuel(battery),
            "ThermistorPresent,0",
            f"BattTempCAvg,{round(battery.temperature)}",
            f"VBattV,{battery.voltage:.2f}",
            f"VExtV,{_external(battery):.2f}",
            "Charger_mAH,0",
            "Discharge_mAH,0",
        ]

    def analog(self, seen: Observation, power: Power) -> Rows:
        """Return values with their units."""
        battery, (left, right) = seen.battery, _drops(seen)
        return [
            f"BatteryVoltage,mV,{round(1e3 * battery.voltage)},",
            f"BatteryCurrent,mA,{round(1e3 * battery.current)},",
            f"BatteryTemperature,mC,{round(1e3 * battery.temperature)},",
            f"ExternalVoltage,mV,{round(1e3 * _external(battery))},",
            f"AccelerometerX,mG,{round(1e3 * seen.acceleration / 9.81)},",
            "AccelerometerY,mG,0,",
            "AccelerometerZ,mG,1000,",
            f"VacuumCurrent,mA,{12 * power.fan},",
            f"SideBrushCurrent,mA,{power.side_brush // 15},",
            "MagSensorLeft,VAL,0,",
            "MagSensorRight,VAL,0,",
            f"WallSensor,mm,{_FAR},",
            f"DropSensorLeft,mm,{left},",
            f"DropSensorRight,mm,{right},",
        ]

    def digital(self, seen: Observation) -> Rows:
        """Return switches, with those of the lidar's tower."""
        return [
            f"SNSR_DC_JACK_IS_IN,{int(seen.battery.is_docked)}",
            *_switches(seen, "LLDSBIT,0", "RLDSBIT,0"),
        ]

    def motors(self, left: Wheel, right: Wheel, power: Power) -> Rows:
        """Return turns, loads, positions and speeds."""
        wheels = [
            row
            for name, wheel in (("LeftWheel", left), ("RightWheel", right))
            for row in (
                f"{name}_RPM,{wheel.rpm}",
                f"{name}_Load%,0",
                f"{name}_PositionInMM,{round(wheel.position)}",
                f"{name}_Speed,{round(wheel.speed)}",
            )
        ]
        return [
            f"Brush_RPM,{power.brush}",
            f"Brush_mA,{power.brush // 4}",
            f"Vacuum_RPM,{30 * power.fan}",
            f"Vacuum_mA,{12 * power.fan}",
            *wheels,
            f"SideBrush_mA,{power.side_brush // 15}",
        ]


class XV11(Dialect):
    """XV-11."""

    def charger(self, battery: BatteryState) -> Rows:
        """Return seventeen values."""
        temperature = round(battery.temperature)
        return [
            *_fuel(battery),
            "ThermistorPresent[0],0",
            "ThermistorPresent[1],0",
            f"BattTempCAvg[0],{temperature}",
            f"BattTempCAvg[1],{temperature}",
            f"VBattV,{battery.voltage:.2f}",
            f"VExtV,{_external(battery):.2f}",
            "Charger_mAH,0",
            "MaxPWM,65536",
        ]

    def analog(self, seen: Observation, power: Power) -> Rows:
        """Return sixteen values, with their units in their names."""
        battery, (left, right) = seen.battery, _drops(seen)
        temperature = round(battery.temperature)
        return [
            f"WallSensorInMM,{_FAR}",
            f"BatteryVoltageInmV,{round(1e3 * battery.voltage)}",
            f"LeftDropInMM,{left}",
            f"RightDropInMM,{right}",
            "RightMagSensor,0",
            "LeftMagSensor,0",
            "XTemp0InC,20",
            "XTemp1InC,20",
            f"VacuumCurrentInmA,{12 * power.fan}",
            f"ChargeVoltInmV,{round(1e3 * _external(battery))}",
            "NotConnected1,0",
            f"BatteryTemp1InC,{temperature}",
            "NotConnected2,0",
            f"CurrentInmA,{round(1e3 * battery.current)}",
            "NotConnected3,0",
            f"BatteryTemp0InC,{temperature}",
        ]

    def digital(self, seen: Observation) -> Rows:
        """Return eight switches."""
        return [f"SNSR_DC_JACK_CONNECT,{int(seen.battery.is_docked)}", *_switches(seen)]

    def motors(self, left: Wheel, right: Wheel, power: Power) -> Rows:
        """Return thirty values, most of which say nothing here."""
        wheels = [
            row
            for name, wheel in (("LeftWheel", left), ("RightWheel", right))
            for row in (
                f"{name}_MaxPWM,65536",
                f"{name}_PWM,0",
                f"{name}_mVolts,0",
                f"{name}_Encoder,0",
                f"{name}_PositionInMM,{round(wheel.position)}",
                f"{name}_RPM,{wheel.rpm}",
            )
        ]
        return [
            "Brush_MaxPWM,65536",
            "Brush_PWM,0",
            "Brush_mVolts,0",
            "Brush_Encoder,0",
            f"Brush_RPM,{power.brush}",
            "Vacuum_MaxPWM,65536",
            "Vacuum_PWM,0",
            f"Vacuum_CurrentInMA,{12 * power.fan}",
            "Vacuum_Encoder,0",
            f"Vacuum_RPM,{30 * power.fan}",
            *wheels,
            "Laser_MaxPWM,65536",
            "Laser_PWM,0",
            "Laser_mVolts,0",
            "Laser_Encoder,0",
            "Laser_RPM,0",
            "Charger_MaxPWM,65536",
            "Charger_PWM,0",
            "Charger_mAH,0",
        ]


DIALECTS: Final[dict[Model, Dialect]] = {Model.BOTVAC: Botvac(), Model.XV11: XV11()}


def accelerometer(seen: Observation) -> Rows:
    """Return the rows of the answer to GetAccel, which all of them have: of a robot that is level.

    Pitch is negative while it speeds up, as at a D6 that tells -2.33 degrees and 0.039 g.
    """
    ahead, up = seen.acceleration / 9.81, 1.0
    angles = {"Pitch": -math.degrees(math.atan2(ahead, up)), "Roll": 0.0}
    parts = {"X": ahead, "Y": 0.0, "Z": up, "Sum": math.hypot(ahead, up)}
    return [
        *(f"{name}InDegrees,{angle:6.2f}" for name, angle in angles.items()),
        *(f"{name}InG,{part:6.3f}" for name, part in parts.items()),
    ]


def _fuel(battery: BatteryState) -> Rows:
    return [
        f"FuelPercent,{round(100.0 * battery.level)}",
        "BatteryOverTemp,0",
        f"ChargingActive,{int(battery.is_charging)}",
        f"ChargingEnabled,{int(battery.is_docked)}",
        "ConfidentOnFuel,0",
        "OnReservedFuel,0",
        f"EmptyFuel,{int(battery.level <= 0.0)}",
        "BatteryFailure,0",
        f"ExtPwrPresent,{int(battery.is_docked)}",
    ]


def _switches(seen: Observation, left_tower: str = "", right_tower: str = "") -> Rows:
    bumper, wheels = seen.bumper, seen.wheels
    ahead = bumper.left and bumper.right
    rows = [
        "SNSR_DUSTBIN_IS_IN,1",
        f"SNSR_LEFT_WHEEL_EXTENDED,{int(wheels.dropped_left)}",
        f"SNSR_RIGHT_WHEEL_EXTENDED,{int(wheels.dropped_right)}",
        f"LSIDEBIT,{int(bumper.left and not ahead)}",
        f"LFRONTBIT,{int(ahead)}",
        left_tower,
        f"RSIDEBIT,{int(bumper.right and not ahead)}",
        f"RFRONTBIT,{int(ahead)}",
        right_tower,
    ]
    return [row for row in rows if row]


def _drops(seen: Observation) -> tuple[int, int]:
    cliff = seen.cliff
    left, right = cliff.left or cliff.front_left, cliff.right or cliff.front_right
    return _DEEP if left else _FLOOR, _DEEP if right else _FLOOR


def _external(battery: BatteryState) -> float:
    """Return the voltage at the contacts, V."""
    return _STATION if battery.is_docked else 0.0
