"""A Neato in a simulated home: what it answers to each command, and how it moves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from roomba.configuration.robot import TimingConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.emulators.neato.cleaning import OwnCleaning
from roomba.emulators.neato.dialects import DIALECTS, Model, Power, Wheel, accelerometer
from roomba.emulators.neato.drive import WheelDrive
from roomba.emulators.neato.grammars import GRAMMARS
from roomba.emulators.neato.records import DAYS, RECORDS, SETTINGS, schedule
from roomba.emulators.neato.words import CommandError, Words, understood
from roomba.world.simulator import Simulator

STEP: Final = TimingConfig().world_step
"""s of the world; commands come between two."""
_NEWLINE: Final = "\r\n"
_WIDTH: Final = 0.34
"""m; how wide the body of a D5 is, which has the shape of a D."""
_LEAST_RPM: Final = 500
_USUAL_VACUUM: Final = 90
"""%, of VacuumOn without VacuumSpeed."""
_MOST_RPM: Final = 10_000
_SWEEPING: Final = Power(brush=1200, fan=70, side_brush=1500)
"""While it cleans by itself; of a D5."""


def made_up(config: SimulatedRobotConfig) -> SimulatedRobotConfig:
    """Return a Neato's configuration for a world that knows round bodies alone.

    A disc around the real body, which has the shape of a D, would be wider than that body is. The
    made-up body is a disc as wide as the D.
    """
    body = config.body.model_copy(update={"diameter": _WIDTH})
    return config.model_copy(update={"body": body})


class NeatoRobot:
    """The robot: :meth:`answer` what is asked, :meth:`advance` lets time pass.

    ``seen`` is what was observed after the last step, ``cleaning`` what the robot does by itself.
    ``sound`` is the number of the sound that it plays.
    """

    def __init__(self, simulator: Simulator, model: Model = Model.BOTVAC) -> None:
        """Live in the body of ``simulator``, which it drives, and speak as ``model`` does."""
        self.simulator, self.model = simulator, model
        self._rows, self._kept, self._grammars = DIALECTS[model], RECORDS[model], GRAMMARS[model]
        self.drive = WheelDrive(simulator.config.body.wheel_separation)
        self.cleaning = OwnCleaning(self.drive)
        self.is_testing = self.is_turning = False
        self.sound: int | None = None
        self._brush_rpm = self._vacuum = self._side_brush = 0
        self._has_brush = False
        self._answers: dict[str, Callable[[Words], str]] = {
            "Help": self._help,
            "Clean": self._clean,
            "GetAccel": lambda words: _lines("Label,Value", *accelerometer(self.seen)),
            "GetVersion": lambda words: _lines(*self._kept.version),
            "GetButtons": lambda words: _lines(*self._kept.buttons),
            "GetCalInfo": lambda words: _lines(*self._kept.calibration),
            "GetUserSettings": lambda words: _lines(*SETTINGS),
            "GetSchedule": self._schedule,
            "GetWarranty": lambda words: _lines(*self._kept.warranty(self.cleaning.seconds)),
            "GetCharger": self._charger,
            "GetAnalogSensors": self._analog,
            "GetDigitalSensors": self._digital,
            "GetMotors": self._motors,
            "GetLDSScan": self._scan,
            "GetState": self._state,
            "GetErr": lambda words: _lines(*self._kept.no_error),
            "GetTime": lambda words: "Sunday 0:00:00",
            "TestMode": self._test_mode,
            "SetLDSRotation": self._lds_rotation,
            "SetMotor": self._set_motor,
            "SetLED": lambda words: "",
            "PlaySound": self._play,
        }
        self._cleans = {
            "Start": OwnCleaning.press_start,
            "House": OwnCleaning.clean_house,
            "Spot": OwnCleaning.clean_spot,
            "Stop": OwnCleaning.stop,
        }
        self.advance()

    def advance(self) -> None:
        """Let one step of the world pass."""
        self._power()
        self.simulator.advance(self.drive.next(STEP), STEP, 1)
        self.seen = self.simulator.observe()
        if self.seen.wheels.dropped:
            self.drive.halt()
        self.cleaning.steer(self.seen, STEP)

    def answer(self, line: str) -> str:
        """Return what the robot says to a line, its echo and its end included."""
        try:
            words = understood(line, self._grammars)
            said = self._answers[words.name](words)
        except CommandError as error:
            said = str(error)
        return f"{line}{_NEWLINE}{said}{_NEWLINE if said else ''}\x1a"

    def clean(self, do: Callable[[OwnCleaning], None]) -> None:
        """Begin, pause or end a clean of its own; in the test mode that does nothing."""
        if not self.is_testing:
            do(self.cleaning)

    def _help(self, words: Words) -> str:
        return _lines("Help Strlen = 1024", *(grammar.name for grammar in self._grammars))

    def _clean(self, words: Words) -> str:
        """Do what a press of its button does."""
        kinds = words.flags or {"Start"}
        if len(kinds) > 1:
            raise CommandError("Choose only 1 of House,Spot,Stop")
        self.clean(self._cleans[next(iter(kinds))])
        return ""

    def _schedule(self, words: Words) -> str:
        day = words.values.get("Day")
        if day is not None and not 0 <= day < len(DAYS):
            raise CommandError(f"expected a Day from 0 to {len(DAYS) - 1}")
        return _lines(*schedule(day))

    def _charger(self, words: Words) -> str:
        return _lines("Label,Value", *self._rows.charger(self.seen.battery))

    def _analog(self, words: Words) -> str:
        head = "SensorName,Unit,Value," if self.model is Model.BOTVAC else "SensorName,Value"
        return _lines(head, *self._rows.analog(self.seen, self._power_now))

    def _digital(self, words: Words) -> str:
        return _lines("Digital Sensor Name, Value", *self._rows.digital(self.seen))

    def _motors(self, words: Words) -> str:
        radius = self.simulator.config.body.wheel_diameter / 2.0
        wheels, twist = self.seen.wheels, self.seen.odometry_twist
        half = 0.5 * self.drive.track * twist.angular
        left = Wheel(1e3 * wheels.left * radius, 1e3 * (twist.linear - half))
        right = Wheel(1e3 * wheels.right * radius, 1e3 * (twist.linear + half))
        return _lines("Parameter,Value", *self._rows.motors(left, right, self._power_now))

    @property
    def _power_now(self) -> Power:
        if self.cleaning.phase.is_running:
            return _SWEEPING
        return Power(self._brush_rpm, self._vacuum, self._side_brush)

    def _scan(self, words: Words) -> str:
        ranges = self.simulator.ranges
        is_turning = self.is_turning or self.cleaning.phase.is_running
        rows = []
        for angle in range(360):
            found = float(ranges[angle]) if is_turning else np.inf
            if np.isfinite(found):
                rows.append(f"{angle},{round(1e3 * found)},{round(2000.0 / (1.0 + found))},0")
            else:
                rows.append(f"{angle},0,0,{_NO_ECHO}")
        rotation = self.simulator.config.lidar.rate if is_turning else 0.0
        return _lines(
            "AngleInDegrees,DistInMM,Intensity,ErrorCodeHEX",
            *rows,
            f"ROTATION_SPEED,{rotation:.2f}",
        )

    def _state(self, words: Words) -> str:
        testing = "UIMGR_STATE_TESTMODE", "ST_T_Test"
        ui, state = testing if self.is_testing else self.cleaning.phase.value
        return _lines(f"Current UI State is: {ui}", f"Current Robot State is: {state}")

    def _test_mode(self, words: Words) -> str:
        self.is_testing = "On" in words.flags
        self.cleaning.end()
        if not self.is_testing:
            self.drive.halt()
            self._brush_rpm = self._vacuum = self._side_brush = 0
            self.is_turning = False
        return ""

    def _lds_rotation(self, words: Words) -> str:
        self._require_test_mode()
        self.is_turning = "On" in words.flags
        return ""

    def _set_motor(self, words: Words) -> str:
        self._require_test_mode()
        flags, values = words.flags, words.values
        if (not flags and not values) or (values.keys() == {"VacuumSpeed"} and not flags):
            raise CommandError("No recognizable parameters")
        if "LWheelDisable" in flags or "RWheelDisable" in flags:
            self.drive.is_enabled = False
            self.drive.halt()
        if "LWheelEnable" in flags or "RWheelEnable" in flags:
            self.drive.is_enabled = True
        self._set_brushes(words)
        if values.keys() & {"LWheelDist", "RWheelDist", "Speed"}:
            if not {"LWheelDist", "RWheelDist", "Speed"} <= values.keys():
                raise CommandError("LWheelDist, RWheelDist and Speed are all required")
            self.drive.go(
                values["LWheelDist"], values["RWheelDist"], values["Speed"], values.get("Accel")
            )
        return ""

    def _set_brushes(self, words: Words) -> None:
        flags, values = words.flags, words.values
        if "VacuumOff" in flags:
            self._vacuum = 0
        if "VacuumOn" in flags:
            self._vacuum = max(1, min(100, values.get("VacuumSpeed", _USUAL_VACUUM)))
        if "BrushEnable" in flags:
            self._has_brush = True
        if "BrushDisable" in flags:
            self._has_brush, self._brush_rpm = False, 0
        if "Brush" in flags and self._has_brush:
            rpm = values.get("RPM", 1200)
            self._brush_rpm = max(_LEAST_RPM, min(_MOST_RPM, rpm)) if rpm > 0 else 0
        if "SideBrushOff" in flags or "SideBrushDisable" in flags:
            self._side_brush = 0
        if "SideBrushOn" in flags:
            self._side_brush = values.get("SideBrushPower", 1500)

    def _play(self, words: Words) -> str:
        self.sound = None if "Stop" in words.flags else words.values.get("SoundID", 0)
        return ""

    def _require_test_mode(self) -> None:
        if not self.is_testing:
            raise CommandError("TestMode must be on to use this command.")

    def _power(self) -> None:
        power = self._power_now
        self.simulator.set_power(brush=min(1.0, power.brush / 1200.0), fan=0.01 * power.fan)


_NO_ECHO: Final = "8035"
"""The error of a beam that met nothing, hexadecimal."""


def _lines(*lines: str) -> str:
    return _NEWLINE.join(lines)
