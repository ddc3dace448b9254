"""The commands that a made-up Neato of each age knows.

Sources: OpenNeato's page of the serial protocol and neato-FHEM's listing of a Botvac D6 (Botvac D3
to D7); the programmer's manual of the XV-11, and the listing of an XV-28 in brannonvann/neato.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.words import Grammar

_MOTOR_FLAGS: Final = (
    "Brush", "VacuumOn", "VacuumOff", "RWheelDisable", "RWheelEnable", "LWheelDisable",
    "LWheelEnable", "BrushDisable", "BrushEnable", "SideBrushEnable", "SideBrushDisable",
    "SideBrushOn", "SideBrushOff",
)  # fmt: skip
_MOTOR_VALUES: Final = (
    "LWheelDist", "RWheelDist", "Speed", "Accel", "RPM", "VacuumSpeed", "SideBrushPower",
)  # fmt: skip
_SHARED: Final = (
    Grammar("Help"),
    Grammar("Clean", ("House", "Spot", "Stop"), ("Width", "Height")),
    Grammar("GetAccel"),
    Grammar("GetVersion"),
    Grammar("GetButtons"),
    Grammar("GetCalInfo"),
    Grammar("GetCharger"),
    Grammar("GetAnalogSensors", ("raw", "stats")),
    Grammar("GetDigitalSensors"),
    Grammar("GetMotors", ("Brush", "Vacuum", "LeftWheel", "RightWheel", "Laser", "Charger")),
    Grammar("GetLDSScan"),
    Grammar("GetState"),
    Grammar("GetErr", ("Clear",)),
    Grammar("GetTime"),
    Grammar("GetWarranty"),
    Grammar("TestMode", ("On", "Off")),
    Grammar("SetLDSRotation", ("On", "Off")),
    Grammar("SetMotor", _MOTOR_FLAGS, _MOTOR_VALUES),
    Grammar("SetLED", ("BacklightOn", "BacklightOff", "ButtonAmber", "ButtonGreen", "LEDRed",
                       "LEDGreen", "ButtonAmberDim", "ButtonGreenDim", "ButtonOff")),
    Grammar("PlaySound", ("Stop",), ("SoundID",)),
)  # fmt: skip
GRAMMARS: Final[Mapping[Model, Sequence[Grammar]]] = {
    Model.BOTVAC: (*_SHARED, Grammar("GetUserSettings")),
    Model.XV11: (*_SHARED, Grammar("GetSchedule", (), ("Day",))),
}
"""By the model. A D6 has no GetSchedule, an XV-28 no GetUserSettings."""
