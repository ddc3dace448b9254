"""What Neatos of two ages keep and tell of themselves: versions, calibration, settings, counters.

Labels, order and spaces are those of real robots. Of a Botvac D5 and D6 with software 4.5.3:
vacuula/fang's issue 1, and ``reference-dump-botvac-d6.txt`` of chrisse1/neato-FHEM; of an XV-28
with software 3.4: the listing in brannonvann/neato. What each single robot has of its own, such as
serial numbers, is made up.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from roomba.emulators.neato.dialects import Model, Rows

DAYS: Final = ("Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat")
_BUTTONS: Final = ("BTN_SOFT_KEY", "BTN_SCROLL_UP", "BTN_START", "BTN_BACK", "BTN_SCROLL_DOWN")
_MORE_BUTTONS: Final = (
    "BTN_SPOT", "IR_BTN_HOME", "IR_BTN_SPOT", "IR_BTN_ECO", "IR_BTN_UP", "IR_BTN_DOWN",
    "IR_BTN_RIGHT", "IR_BTN_LEFT", "IR_BTN_START", "IR_BTN_LEFT_ARC", "IR_BTN_RIGHT_ARC",
)  # fmt: skip
_SEALED: Final = "00000000"
"""The code by which its maker would know the counters of a robot (made up)."""

_BOTVAC_VERSION: Final[Rows] = (
    "Component,Major,Minor,Build,Aux",
    "BaseID,0.0,0.0,0,0,",
    "BlowerType,1,BLOWER_ORIG,",
    "BrushMotorType,1,BRUSH_MOTOR_ORIG,",
    "BrushSpeed,1200,,",
    "BrushSpeedEco,800,,",
    "ChassisRev,1,,",
    "DropSensorType,1,DROP_SENSOR_ORIG,",
    "LCD Panel,0,0,0,",
    "LDS CPU,F2802x/c001,,",
    "LDS Serial,EMULATED,,",
    "LDS Software,V2.7.4,0000000000,",
    "LDSMotorType,2,LDS_MOTOR_MABUCHI,",
    "Locale,1,LOCALE_USA,",
    "MagSensorType,1,MAG_SENSOR_ORIG,",
    "MainBoard Serial Number,EMULATED,000000000000,",
    "MainBoard Version,4,,",
    "Model,BotVacD5Connected,905-0358,",
    "QAState,QA_STATE_APPROVED",
    "Serial Number,EMULATED,000000000000,P",
    "SideBrushPower,1500,,",
    "SideBrushType,2,SIDE_BRUSH_PRESENT,",
    "Software,4,5,3,189,0",
    "VacuumPwr,70,,",
    "VacuumPwrEco,60,,",
    "WallSensorType,1,WALL_SENSOR_ORIG,",
    "WheelPodType,1,WHEEL_POD_ORIG,",
)
_XV11_VERSION: Final[Rows] = (
    "Component,Major,Minor,Build",
    "ModelID,-1,XV11,",
    "ConfigID,1,,",
    "Serial Number,EMULATED,0000000,P",
    "Software,3,4,24079",
    "BatteryType,1,NIMH_12CELL,",
    "BlowerType,1,BLOWER_ORIG,",
    "BrushSpeed,1200,,",
    "BrushMotorType,1,BRUSH_MOTOR_ORIG,",
    "SideBrushType,1,SIDE_BRUSH_NONE,",
    "WheelPodType,1,WHEEL_POD_ORIG,",
    "DropSensorType,1,DROP_SENSOR_ORIG,",
    "MagSensorType,1,MAG_SENSOR_ORIG,",
    "WallSensorType,1,WALL_SENSOR_ORIG,",
    "Locale,1,LOCALE_USA,",
    "LDS Software,V2.6.15295,0000000000,",
    "LDS Serial,EMULATED,,",
    "LDS CPU,F2802x/c001,,",
    "MainBoard Vendor ID,505,,",
    "MainBoard Serial Number,000000000000000000000000,,",
    "BootLoader Software,18119,P,p",
    "MainBoard Software,23179,1,",
    "MainBoard Boot,16219,",
    "MainBoard Version,4,0,",
    "ChassisRev,2,,",
    "UIPanelRev,1,,",
)
_CALIBRATION: Final = ("LDSOffset,0", "XAccel,0", "YAccel,0", "ZAccel,0", "RTCOffset,0")
_BOTVAC_CALIBRATION: Final[Rows] = (
    "calibration file /emmc/calibration/wheel_sensor_calibration.txt does not exist",
    "Parameter,Value,DistanceInMM",
    *_CALIBRATION,
    "CleaningTestSurface,hard",
    "CleaningTestHardSpeed,100",
    "CleaningTestCarpetSpeed,100",
    "CleaningTestHardDistance,1200",
    "CleaningTestCarpetDistance,1200",
    "CleaningTestMode,2",
    "QAState,QA_STATE_APPROVED",
    "LeftDropSensor_CalibrationData,0",
    "RightDropSensor_CalibrationData,0",
    "WheelDropSensor_CalibrationData,0",
    "WallSensor_CalibrationData,0",
)
_XV11_CALIBRATION: Final[Rows] = (
    "Parameter,Value",
    *_CALIBRATION,
    "LCDContrast,17",
    *(f"{side}{end},-1" for side in ("RDrop", "LDrop", "Wall") for end in ("Min", "Mid", "Max")),
    "QAState,0",
    "CleaningTestSurface,carpet",
    "CleaningTestHardSpeed,200",
    "CleaningTestCarpetSpeed,100",
    "CleaningTestHardDistance,1200",
    "CleaningTestCarpetDistance,1200",
)
SETTINGS: Final[Rows] = (
    "Language, EL_NONE ",
    "ClickSounds, ON ",
    "LED, ON ",
    "Wall Enable, ON ",
    "Eco Mode, OFF ",
    "IntenseClean, OFF ",
    "WiFi, OFF ",
    "Melody Sounds, ON ",
    "Warning Sounds, ON ",
    "Bin Full Detect, ON ",
    "Filter Change Time (seconds), 43200 ",
    "Brush Change Time (seconds), 259200 ",
    "Dirt Bin Alert Reminder Interval (minutes), 90 ",
    "Current Dirt Bin Runtime is: 0",
    "Number of Cleanings where Dust Bin was Full is: 0",
    "Schedule is Disabled",
)
"""Of a Botvac; the days of a real one, which begin with bytes that are no letters, are left out."""


@dataclass(frozen=True, slots=True)
class Records:
    """What a model tells of itself: whole answers, with their headings."""

    version: Rows
    calibration: Rows
    buttons: Rows
    """None is pressed."""
    no_error: Rows
    """What GetErr tells where nothing is wrong."""
    has_labels: bool
    """Whether the counters of GetWarranty have names."""

    def warranty(self, cleaned: float) -> Rows:
        """Return the answer to GetWarranty, hexadecimal: it ``cleaned`` for so long, s."""
        seconds, cycles = f"{round(cleaned):08x}", "0000"
        if not self.has_labels:
            return [seconds, cycles, _SEALED]
        return [
            "Item,Value",
            f"CumulativeCleaningTimeInSecs,{seconds}",
            f"CumulativeBatteryCycles,{cycles}",
            f"ValidationCode,{_SEALED}",
        ]


def _buttons(*names: str) -> Rows:
    return ("Button Name,Pressed", *(f"{name},0" for name in names))


RECORDS: Final[Mapping[Model, Records]] = {
    Model.BOTVAC: Records(
        _BOTVAC_VERSION,
        _BOTVAC_CALIBRATION,
        _buttons(*_BUTTONS, *_MORE_BUTTONS),
        no_error=(
            "Error",
            "200 -  (UI_ALERT_INVALID)",
            "Alert",
            "200 -  (UI_ALERT_INVALID)",
            "USB state ",
            " NOT connected",
        ),
        has_labels=True,
    ),
    Model.XV11: Records(
        _XV11_VERSION, _XV11_CALIBRATION, _buttons(*_BUTTONS), no_error=(), has_labels=False
    ),
}


def schedule(day: int | None = None) -> Rows:
    """Return the answer to GetSchedule, of a ``day`` (0: Sunday) or of the week: nothing is set."""
    days = DAYS if day is None else DAYS[day : day + 1]
    return ["Schedule is Disabled", *(f"{name} 00:00 - None -" for name in days)]
