"""A Neato as a body of the brain: its answers become readings, wanted twists its commands.

One command at a time goes over the line. Each takes some 25 ms, and a scan half a second on a
serial line. :meth:`NeatoBody.serve` sends the one that is due; a thread of its own calls it again
and again.

No command drives a wheel farther ahead than the floor that the drop sensors have seen. Where too
little seen floor is left, the sensors are asked first, so that neither a scan nor a slow or dead
line leads over an edge. When they report an edge, the wheels are stopped at once.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Final

import numpy as np

from roomba.configuration.robot import STANDSTILL_WITHIN, RobotConfig
from roomba.drivers.line import LineError
from roomba.drivers.neato import answers
from roomba.drivers.neato.answers import AnswerError
from roomba.drivers.neato.conversation import Conversation, SilenceError
from roomba.drivers.neato.planned import PlannedWheels
from roomba.drivers.neato.questions import ANSWER, Question, UntoldError
from roomba.drivers.neato.seen_floor import SeenFloor
from roomba.drivers.neato.sweeps import SweepClock
from roomba.drivers.neato.wheels import (
    ENABLE,
    STOP,
    AheadLimit,
    WheelCommand,
    fastest_ahead,
    wheel_command,
)
from roomba.drivers.wheel_odometry import WheelOdometry
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.mission.inputs.senses import Battery
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.command import Command
from roomba.robot.readings import CliffReading, Readings, ScanReading

_SCAN_ANSWER_WAIT: Final = 1.5
"""s; the longest wait for the answer to GetLDSScan."""
_BEGINNING_WAIT: Final = 1.0
"""s; the longest wait for the answer to a command that takes the robot over."""
_GIVING_BACK_TRIES: Final = 3
"""Attempts to give the robot back: a radio that fails once may not fail again."""
_LONGEST_SILENCE: Final = 0.15
"""s; the robot is stopped when the newest wanted command is older than this."""
_DRIVE_HOLD: Final = 0.3
"""s for which a command lets the wheels go on, while other commands are on the line."""
_SCAN_HOLD: Final = 0.45
"""s; the same before a scan, which takes longer on a serial line."""
_DRIVE_REPEAT_PERIOD: Final = 0.05
"""s; from a command of the wheels to the next."""
_LONGEST_WITHOUT_SCAN_OR_CHARGE: Final = 10.0
"""s without a scan or the charge that are an error; meanwhile bumpers and drops are still told."""
_SCAN_PERIOD: Final = 0.1
"""s; shorter than a turn of the lidar, so that it is seen when each sweep ends."""
_SCAN_SHARE: Final = 0.5
"""The greatest share of the line's time for scans, where they take long."""
_BRIDGED_SCAN_SHARE: Final = 0.8
"""The same behind a bridge: it rests after each short answer, and scans would be too rare."""
_FASTEST_TURN_FOR_SCAN: Final = 0.3
"""rad/s; while the robot turns faster, no scan is asked for on a slow line."""
_SETTLING_TIME: Final = 0.4
"""s from such a turn to the next scan, so that its whole sweep is measured after the turn."""
_LONGEST_TURN_WITHOUT_SCAN: Final = 3.0
"""s without a scan, after which one is asked for even while the robot turns."""
_NO_FLOOR: Final = 0.06
"""m; where the floor is farther below a drop sensor, there is an edge."""
_SAME_TURN: Final = 0.05
"""Share by which the time of the lidar's turns may change while its model is kept."""
_BEEP: Final = "PlaySound SoundID 3"


class NeatoBody:
    """One robot on a line: a :class:`roomba.drivers.driver.Driver`."""

    def __init__(
        self, conversation: Conversation, now: Callable[[], float], config: RobotConfig
    ) -> None:
        """Talk by ``conversation``; ``now`` is the robot's clock, s, which never goes back."""
        self._line, self._now, self._config = conversation, now, config
        self._track = config.body.wheel_separation
        self._angles = np.arange(answers.BEAMS) * (2.0 * math.pi / answers.BEAMS)
        self._lock = threading.Lock()
        self._wanted, self._wanted_at = STANDSTILL, -math.inf
        self._power = (False, 0)
        self._beeps = False
        self._driven: tuple[bool, float] = (False, -math.inf)
        self._is_enabled = False
        self._power_told = (False, 0)
        self._odometry, self._planned = WheelOdometry(self._track), PlannedWheels()
        self._planned_when_told = self._planned.ways(0.0)
        self._turned_at = -math.inf
        self._touches = answers.Touches(False, False, False, False, True)
        self._drops = answers.Drops(0.0, 0.0)
        self._charge = answers.Charge(1.0, False, False)
        self._sweeps = SweepClock()
        self._lidar: LidarModel | None = None
        self._turn = 0.0
        self._scan: ScanReading | None = None
        self._newest_scan: ScanReading | None = None
        self._is_unanswered = False
        self._floor = SeenFloor(config.cliff)
        self._goes_ahead = False
        self._telling = 0.0
        self._scans = Question(
            "GetLDSScan", "its lidar", _SCAN_PERIOD, self._take_scan, _SCAN_ANSWER_WAIT
        )
        self._edges = Question("GetAnalogSensors", "its drop sensors", 0.1, self._take_drops)
        self._charger = Question("GetCharger", "its battery", 0.25, self._take_charge)
        self._questions = [
            Question("GetMotors", "its wheels", 0.05, self._take_motors),
            Question("GetDigitalSensors", "its bumpers", 0.1, self._take_touches),
            self._edges,
            self._scans,
            self._charger,
        ]

    def read(self) -> Readings:
        """Return what the robot told last; each scan is returned once."""
        with self._lock:
            scan, self._scan = self._scan, None
            touches, charge, drops = self._touches, self._charge, self._drops
            now = self._now()
            return Readings(
                now,
                self._pose_at(now),
                twist=self._odometry.twist,
                scan=scan,
                bumper_left=touches.bumper_left,
                bumper_right=touches.bumper_right,
                cliff=CliffReading(drops.left > _NO_FLOOR, False, False, drops.right > _NO_FLOOR),
                dropped_left=touches.dropped_left,
                dropped_right=touches.dropped_right,
                battery=Battery(charge.level, self._config.battery.capacity, charge.has_power),
            )

    def _pose_at(self, now: float) -> Pose:
        """Return the pose by the wheels' last answer, and by what they were told to do since."""
        if math.isnan(self._odometry.told_at):
            return Pose()
        # Added to the pose of the last answer is the way that was planned since then.
        before, after = self._planned_when_told, self._planned.ways(now)
        return self._odometry.after(after[0] - before[0], after[1] - before[1])

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""
        with self._lock:
            return self._newest_scan

    def act(self, command: Command) -> None:
        """Take the wanted command; it holds for 0.15 s, then the robot stands."""
        with self._lock:
            self._wanted, self._wanted_at = command.twist, self._now()
            fan = 0.0 if command.fan is None else command.fan
            is_cleaning = command.brush is None or command.brush > 0.0
            self._power = is_cleaning, round(100.0 * fan)

    def locate(self) -> None:
        """Let the robot beep as soon as the line is free."""
        with self._lock:
            self._beeps = True

    def begin(self) -> None:
        """Take the robot over and let its lidar turn; raises LineError, or UntoldError.

        Each question is asked once, so that a silent sensor is noticed. A scan is asked for only if
        there was one before: a lidar needs time to come up to its speed.
        """
        for command in ("TestMode On", "SetLDSRotation On", STOP):
            self._line.ask(command, _BEGINNING_WAIT)
        self._is_enabled, self._is_unanswered, self._goes_ahead = False, False, False
        self._power_told = (False, 0)
        with self._lock:
            self._odometry.stand()
        self._plan(None)
        for question in self._questions:
            if question is not self._scans or self._newest_scan is not None:
                question.require(self._line, self._now)
        self._scans.told_at = self._now()

    def end(self) -> None:
        """Let the robot stand, and give it back.

        After a command without an answer the others are left out. The robot is given back next, in
        several attempts if need be: until then its own buttons do nothing, and little time may be
        left.
        """
        for command in (STOP, *_AT_REST, "SetLDSRotation Off"):
            if not self._is_answered(command):
                break
        for _ in range(_GIVING_BACK_TRIES):
            if self._is_answered("TestMode Off"):
                break

    def _is_answered(self, command: str) -> bool:
        try:
            self._line.ask(command, ANSWER)
        except LineError:
            return False
        return True

    def serve(self) -> None:
        """Send the command that is due; raises LineError, after which :meth:`begin` is due.

        A single missing answer is passed over, and so is one that cannot be used.
        """
        try:
            self._serve()
            self._is_unanswered = False
        except SilenceError:
            if self._is_unanswered:
                raise
            self._is_unanswered = True
        self._require_answers()

    def _require_answers(self) -> None:
        """Stop the robot and raise UntoldError if what it must tell is missing for too long."""
        # While a scan is on the line nothing else is told.
        soon = STANDSTILL_WITHIN + self._scans.took
        try:
            for question in self._questions:
                may_wait = question is self._scans or question is self._charger
                question.check(self._now(), _LONGEST_WITHOUT_SCAN_OR_CHARGE if may_wait else soon)
        except UntoldError:
            self._is_answered(STOP)
            raise

    def _serve(self) -> None:
        if self._drive_is_due():
            others = max(each.took for each in self._questions if each is not self._scans)
            self._drive(_DRIVE_HOLD, others)
            return
        if self._takes_beep():
            self._line.ask(_BEEP, ANSWER)
            return
        question = max(self._questions, key=self._urgency)
        if question is self._scans:
            self._drive(_SCAN_HOLD, question.took)
        self._ask(question)
        if question is self._scans:
            share = _BRIDGED_SCAN_SHARE if self._line.is_bridged else _SCAN_SHARE
            question.period = max(_SCAN_PERIOD, question.took / share)

    def _urgency(self, question: Question) -> float:
        since = self._now() - question.asked_at
        is_blind = question is self._scans and question.period > _SCAN_PERIOD / _SCAN_SHARE
        is_blind = is_blind and since < _LONGEST_TURN_WITHOUT_SCAN
        if is_blind and (self._is_to_turn() or self._now() - self._turned_at < _SETTLING_TIME):
            # While a scan is on a slow line, the robot cannot tell how far it turned.
            return 0.0
        return question.urgency(self._now())

    def _is_to_turn(self) -> bool:
        return abs(self._wanted_now()[0].angular) > _FASTEST_TURN_FOR_SCAN

    def _ask(self, question: Question) -> None:
        try:
            question.ask(self._line, self._now)
        except AnswerError:
            # What a bad line garbled; it is asked again.
            return

    def _takes_beep(self) -> bool:
        with self._lock:
            beeps, self._beeps = self._beeps, False
            return beeps

    def _drive_is_due(self) -> bool:
        wants = self._wanted_now()[0] != STANDSTILL
        was_driving, at = self._driven
        return wants != was_driving or (wants and self._now() - at >= _DRIVE_REPEAT_PERIOD)

    def _wanted_now(self) -> tuple[Twist, tuple[bool, int]]:
        """Return the twist, and whether the brush turns and the fan's duty, %."""
        with self._lock:
            if self._now() - self._wanted_at > _LONGEST_SILENCE or self._wanted == STANDSTILL:
                return STANDSTILL, (False, 0)
            return self._wanted, self._power

    def _drive(self, hold: float, busy: float) -> None:
        """Tell the wheels to go on for ``hold`` s; what is asked next keeps the line ``busy`` s."""
        if fastest_ahead(self._wanted_now()[0], self._track) * hold > self._way_left():
            self._ask(self._edges)
        twist, power = self._wanted_now()
        with self._lock:
            now = self._odometry.twist
        half = 0.5 * self._track * now.angular
        moving = max(abs(now.linear - half), abs(now.linear + half))
        seconds = min(hold, busy + self._edges.took + self._telling)
        limit = AheadLimit(self._way_left(), seconds)
        command = wheel_command(twist, self._track, hold, moving, limit)
        if command is None:
            self._stop()
        else:
            if not self._is_enabled:
                self._line.ask(ENABLE, ANSWER)
                self._is_enabled = True
            self._line.ask(command.text, ANSWER)
            self._telling = self._line.took
            self._goes_ahead = max(command.left, command.right) > 0
            self._plan(command)
        self._driven = twist != STANDSTILL, self._now()
        self._set_power(power)

    def _way_left(self) -> float:
        """Return how far the wheels may roll ahead when they hear a command that is sent now, m."""
        return self._floor.left(self._now() + self._telling)

    def _stop(self) -> None:
        if self._is_enabled:
            self._line.ask(STOP, ANSWER)
            self._is_enabled = self._goes_ahead = False
            self._plan(None)

    def _plan(self, command: WheelCommand | None) -> None:
        at = self._heard_at()
        with self._lock:
            self._planned.take(at, command)
        way, speed = (0.0, 0.0) if command is None else (command.way, command.top_speed)
        self._floor.go(at, way, speed)

    def _set_power(self, power: tuple[bool, int]) -> None:
        """Switch brush and fan, where they change: they rest while the robot stands."""
        if power == self._power_told:
            return
        is_cleaning, fan = power
        on = f"SetMotor VacuumOn VacuumSpeed {fan}", "SetMotor BrushEnable Brush RPM 1200"
        for command in on if is_cleaning and fan > 0 else _AT_REST:
            self._line.ask(command, ANSWER)
        self._power_told = power

    def _heard_at(self) -> float:
        """When the newest answer began to come, s: its values are those of that time."""
        return self._now() - self._line.since_heard

    def _take_motors(self, lines: list[str]) -> None:
        positions, at = answers.wheel_positions_of(lines), self._heard_at()
        with self._lock:
            self._odometry.take(at, positions.left, positions.right)
            self._planned_when_told = self._planned.ways(at)
        if abs(self._odometry.twist.angular) > _FASTEST_TURN_FOR_SCAN:
            self._turned_at = at

    def _take_touches(self, lines: list[str]) -> None:
        touches = answers.touches_of(lines)
        with self._lock:
            self._touches = touches

    def _take_drops(self, lines: list[str]) -> None:
        drops, at = answers.drops_of(lines), self._heard_at() - self._edges.lateness
        has_edge = max(drops.left, drops.right) > _NO_FLOOR
        with self._lock:
            self._drops = drops
        self._floor.take(at, has_edge=has_edge)
        if has_edge and self._goes_ahead:
            self._stop()

    def _take_charge(self, lines: list[str]) -> None:
        charge = answers.charge_of(lines)
        with self._lock:
            self._charge = charge

    def _take_scan(self, lines: list[str]) -> None:
        told = answers.scan_of(lines)
        if told.rotation <= 0.0:
            raise AnswerError("expected a lidar that turns, got ROTATION_SPEED 0")
        before, turn = self._newest_scan, 1.0 / told.rotation
        is_other = before is None or not np.array_equal(before.ranges, told.ranges)
        ended = self._sweeps.ended(self._heard_at(), turn, is_other=is_other)
        if ended is None:
            return
        scan = ScanReading(ended - turn, told.ranges, self._lidar_turning(turn))
        with self._lock:
            self._scan = self._newest_scan = scan

    def _lidar_turning(self, turn: float) -> LidarModel:
        """Return the lidar's model for turns of ``turn`` s; kept while that hardly changes."""
        if self._lidar is None or abs(turn - self._turn) > _SAME_TURN * turn:
            lidar = self._config.lidar
            mount = Pose(lidar.mount_ahead, 0.0, 0.0)
            reach = lidar.min_range, lidar.max_range
            self._lidar = LidarModel(self._angles, *reach, mount, turn / answers.BEAMS)
            self._turn = turn
        return self._lidar


_AT_REST: Final = ("SetMotor VacuumOff", "SetMotor BrushDisable")
