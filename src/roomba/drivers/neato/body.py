"""A Neato as a body of the brain: what it tells becomes readings, what is wanted its commands.

One command at a time goes over the line, some 25 ms each and a scan half a second on a serial line.
:meth:`NeatoBody.serve` does the one that is due; a thread of its own calls it again and again.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from roomba.drivers.line import LineError
from roomba.drivers.neato import answers
from roomba.drivers.neato.answers import AnswerError
from roomba.drivers.neato.conversation import Conversation
from roomba.drivers.neato.wheels import ENABLE, STOP, wheel_command
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.mission.inputs.senses import Battery
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.command import Command
from roomba.robot.readings import CliffReading, Readings, ScanReading

_ANSWER: Final = 0.3
"""s; the longest wait for a short answer."""
_SCAN_ANSWER: Final = 1.5
_SILENT: Final = 0.15
"""s; the robot stands when what it is to do is older than this."""
_HOLD: Final = 0.3
"""s; that the wheels go on after a command, while others are on the line."""
_SCAN_HOLD: Final = 0.45
"""s; the same before a scan, which takes longer on a serial line."""


@dataclass(frozen=True, slots=True)
class NeatoModel:
    """What differs between the robots: lengths in m.

    ``track`` is how far the wheels are apart, ``mount`` the lidar's pose in the robot's frame, that
    begins between the wheels, ``nearest`` and ``farthest`` its ranges. A floor that is ``drop``
    below a drop sensor is none. ``capacity`` is the battery's, Wh.

    Sources: OpenNeato's page of the protocol (track, battery of a D5); mikeferguson/neato_robot
    (mount); ROS xv_11_laser_driver, and scans of a D-series robot that reach 5.7 m (ranges).
    """

    track: float = 0.248
    mount: Pose = field(default_factory=lambda: Pose(-0.1016, 0.0, 0.0))
    nearest: float = 0.06
    farthest: float = 6.0
    drop: float = 0.06
    capacity: float = 60.0


@dataclass(slots=True)
class _Due:
    """A question that is asked every ``period`` s, for the last time at ``last``, s."""

    command: str
    period: float
    take: Callable[[list[str]], None]
    within: float = _ANSWER
    last: float = -math.inf


class NeatoBody:
    """One robot on a line. ``trouble`` says what is wrong with the line, "" if nothing."""

    def __init__(
        self, conversation: Conversation, now: Callable[[], float], model: NeatoModel | None = None
    ) -> None:
        """Talk by ``conversation``; ``now`` is the robot's clock, s, which never goes back."""
        self._line, self._now, self._model = conversation, now, model or NeatoModel()
        self._angles = np.arange(answers.BEAMS) * (2.0 * math.pi / answers.BEAMS)
        self._lock = threading.Lock()
        self._wanted, self._wanted_at = STANDSTILL, -math.inf
        self._power = (False, 0)
        self._driven: tuple[bool, float] = (False, -math.inf)
        self._is_enabled = False
        self._fan_told = (False, 0)
        self.trouble = "not asked yet"
        self._pose, self._twist = Pose(), STANDSTILL
        self._wheels: tuple[float, answers.WheelPositions] | None = None
        self._touches = answers.Touches(False, False, False, False, True)
        self._drops = answers.Drops(0.0, 0.0)
        self._charge = answers.Charge(1.0, False, False)
        self._scan: ScanReading | None = None
        self._scan_asked = 0.0
        self._due = [
            _Due("GetMotors", 0.05, self._take_motors),
            _Due("GetDigitalSensors", 0.1, self._take_touches),
            _Due("GetAnalogSensors", 0.2, self._take_drops),
            _Due("GetLDSScan", 0.25, self._take_scan, _SCAN_ANSWER),
            _Due("GetCharger", 5.0, self._take_charge),
        ]

    # ---------------------------------------------------------------- the brain's side

    def read(self) -> Readings:
        """Return what the robot told last; a scan once."""
        with self._lock:
            scan, self._scan = self._scan, None
            touches, charge, drops = self._touches, self._charge, self._drops
            deep = self._model.drop
            return Readings(
                self._now(),
                self._pose,
                self._twist,
                None,
                scan,
                touches.bumper_left,
                touches.bumper_right,
                CliffReading(drops.left > deep, False, False, drops.right > deep),
                touches.dropped_left,
                touches.dropped_right,
                battery=Battery(charge.level, self._model.capacity, charge.has_power),
            )

    def act(self, command: Command) -> None:
        """Take what is wanted; it holds for 0.15 s, then the robot stands."""
        with self._lock:
            self._wanted, self._wanted_at = command.twist, self._now()
            fan = 0.0 if command.fan is None else command.fan
            is_cleaning = command.brush is None or command.brush > 0.0
            self._power = is_cleaning, round(100.0 * fan)

    # ---------------------------------------------------------------- the line's side

    def begin(self) -> None:
        """Take the robot over and let its lidar turn; raises LineError."""
        self._line.ask("TestMode On", 2.0)
        self._line.ask("SetLDSRotation On", 2.0)
        self._line.ask(STOP, 2.0)
        self._is_enabled, self._wheels = False, None
        self.trouble = ""

    def end(self) -> None:
        """Let the robot stand, and give it back."""
        for command in (STOP, "SetMotor VacuumOff", "SetLDSRotation Off", "TestMode Off"):
            try:
                self._line.ask(command, _ANSWER)
            except LineError:
                continue

    def serve(self) -> None:
        """Send the command that is due; raises LineError, after which :meth:`begin` is due."""
        try:
            if self._drive_is_due():
                self._drive(_HOLD)
                return
            question = max(self._due, key=lambda due: (self._now() - due.last) / due.period)
            if question.command == "GetLDSScan":
                self._drive(_SCAN_HOLD)
            question.last = self._scan_asked = self._now()
            self._take(question)
        except LineError as error:
            self.trouble, self._twist = str(error), STANDSTILL
            raise
        self.trouble = ""

    def _take(self, question: _Due) -> None:
        try:
            lines = self._line.ask(question.command, question.within)
            question.take(lines)
        except AnswerError:
            # What a bad line garbled; it is asked again at its time.
            return

    def _drive_is_due(self) -> bool:
        with self._lock:
            is_silent = self._now() - self._wanted_at > _SILENT
            wants = self._wanted != STANDSTILL and not is_silent
        was_driving, at = self._driven
        return wants != was_driving or (wants and self._now() - at >= 0.1)

    def _drive(self, seconds: float) -> None:
        with self._lock:
            is_silent = self._now() - self._wanted_at > _SILENT
            twist, power = (STANDSTILL if is_silent else self._wanted), self._power
            now, half = self._twist, 0.5 * self._model.track * self._twist.angular
        moving = max(abs(now.linear - half), abs(now.linear + half))
        command = wheel_command(twist, self._model.track, seconds, moving)
        if command is None:
            if self._is_enabled:
                self._line.ask(STOP, _ANSWER)
                self._is_enabled = False
        else:
            if not self._is_enabled:
                self._line.ask(ENABLE, _ANSWER)
                self._is_enabled = True
            self._line.ask(command.text, _ANSWER)
        self._driven = twist != STANDSTILL, self._now()
        self._set_power(power if twist != STANDSTILL else (False, 0))

    def _set_power(self, power: tuple[bool, int]) -> None:
        """Switch brush and fan, where they change: they rest while the robot stands."""
        if power == self._fan_told:
            return
        is_cleaning, fan = power
        if is_cleaning and fan > 0:
            self._line.ask(f"SetMotor VacuumOn VacuumSpeed {fan}", _ANSWER)
            self._line.ask("SetMotor BrushEnable Brush RPM 1200", _ANSWER)
        else:
            self._line.ask("SetMotor VacuumOff", _ANSWER)
            self._line.ask("SetMotor BrushDisable", _ANSWER)
        self._fan_told = power

    # ---------------------------------------------------------------- what came

    def _take_motors(self, lines: list[str]) -> None:
        positions, now = answers.wheel_positions_of(lines), self._now()
        before, self._wheels = self._wheels, (now, positions)
        if before is None:
            return
        left, right = positions.left - before[1].left, positions.right - before[1].right
        way, turn = 0.5 * (left + right), (right - left) / self._model.track
        passed = max(now - before[0], 1e-3)
        with self._lock:
            arc = Pose(way * math.cos(0.5 * turn), way * math.sin(0.5 * turn), turn)
            self._pose = self._pose.compose(arc)
            self._twist = Twist(way / passed, turn / passed)

    def _take_touches(self, lines: list[str]) -> None:
        touches = answers.touches_of(lines)
        with self._lock:
            self._touches = touches

    def _take_drops(self, lines: list[str]) -> None:
        drops = answers.drops_of(lines)
        with self._lock:
            self._drops = drops

    def _take_charge(self, lines: list[str]) -> None:
        charge = answers.charge_of(lines)
        with self._lock:
            self._charge = charge

    def _take_scan(self, lines: list[str]) -> None:
        scan = answers.scan_of(lines)
        if scan.rotation <= 0.0:
            return
        sweep = 1.0 / scan.rotation
        model = self._model
        lidar = LidarModel(
            self._angles, model.nearest, model.farthest, model.mount, sweep / answers.BEAMS
        )
        with self._lock:
            self._scan = ScanReading(self._scan_asked - sweep, scan.ranges, lidar)
