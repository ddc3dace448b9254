"""A Create 2 as a body of the brain: its stream becomes readings, commands become wheel speeds.

The Open Interface has no time-out: the robot obeys its last drive command for ever. So the driver
sends a command twenty times a second. :mod:`roomba.drivers.create2.dead_man` stops the robot when
the driver dies, and its safe mode stops it where a wheel drops or the floor ends. When its cable is
pulled while it drives, only safe mode can stop it. A thread of its own calls
:meth:`Create2Body.serve` again and again.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Final, Protocol

from roomba.configuration.robot import RobotConfig
from roomba.drivers.create2 import commands
from roomba.drivers.create2.dead_man import PADDING as LONG_PADDING
from roomba.drivers.create2.dead_man import STOP, DeadManSwitch, Switch
from roomba.drivers.create2.frames import FrameReader
from roomba.drivers.create2.obedience import DisobeyedError, Obedience
from roomba.drivers.create2.odometry import EncoderOdometry
from roomba.drivers.create2.open_interface import OpenMode, Packet
from roomba.drivers.create2.telling import ALL, FAST, SLOW, Create2State, state_of
from roomba.drivers.create2.waking import BrcPin, PinLine
from roomba.drivers.lidars.reader import LidarReader
from roomba.drivers.line import Line, LineError, SerialLine
from roomba.geometry import STANDSTILL, Twist
from roomba.mission.inputs.senses import Battery
from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading

BAUDS: Final = (115_200, 19_200)
"""Baud rates to try: the usual one, and the slower one of a robot that was told to use it."""
_LEAST_BAUD_FOR_ALL: Final = 57_600
"""Baud, from which on all packets come in each frame."""
_SEND_PERIOD: Final = 0.05
"""s, between two commands."""
_LONGEST_SILENCE: Final = 0.15
"""s; the robot is stopped when the newest command, or the newest frame, is older than this."""
_FRAME_WAIT: Final = 0.5
"""s without a frame, after which the line counts as gone."""
_FIRST_FRAME_WAIT: Final = 0.5
"""s, for the first frame at each rate."""
_COMMANDS_PER_SLOW_LIST: Final = 5
"""On a slow line, after one command in so many the slow list is streamed, not the fast one."""


class RobotLine(Line, PinLine, Protocol):
    """The robot's line: data, and the pin that wakes the robot."""


class Create2Body:
    """One robot on a serial port. ``trouble`` says what is wrong with the line, "" if nothing."""

    def __init__(
        self,
        port: str,
        now: Callable[[], float],
        config: RobotConfig,
        *,
        lidar: LidarReader | None = None,
        opened: Callable[[str, int], RobotLine] = SerialLine,
        switch: Switch | None = None,
    ) -> None:
        """Be about to drive the robot of ``config`` on ``port``; nothing is opened yet.

        ``now`` is the robot's clock, s, which times the readings. It never goes back, but may stand
        while the line is gone, so waits are timed by the computer's clock. ``lidar`` is one on a
        line of its own, read from :meth:`begin` to :meth:`end`; ``opened`` opens a port.
        """
        self._port, self._now, self._config = port, now, config
        self._lidar, self._opened = lidar, opened
        self._switch = switch or DeadManSwitch(port)
        self._line: RobotLine | None = None
        self._pin = BrcPin(time.monotonic)
        self._lock = threading.Lock()
        self._wanted, self._wanted_at = Command(), -math.inf
        self._sings_until, self._is_to_sing = -math.inf, False
        self._lists: tuple[tuple[Packet, ...], ...] = (ALL,)
        self._reader = FrameReader(self._lists)
        self._odometry = EncoderOdometry(config)
        self._obedience = Obedience(config.body.wheel_separation)
        self._twist = STANDSTILL
        self._told: dict[int, int] = {}
        self._state = Create2State()
        self._heard = self._due = -math.inf
        self._sent = 0
        self._given: ScanReading | None = None
        self.trouble = "not asked yet"

    def read(self) -> Readings:
        """Return what the robot told last; each scan is returned once."""
        scan = self.newest_scan()
        with self._lock:
            is_new = scan is not None and scan is not self._given
            self._given = scan
            state, odometry = self._state, self._odometry
            return Readings(
                self._now(),
                odometry.pose,
                twist=odometry.twist,
                scan=scan if is_new else None,
                bumper_left=state.bumper_left,
                bumper_right=state.bumper_right,
                cliff=state.cliff,
                dropped_left=state.dropped_left,
                dropped_right=state.dropped_right,
                beams=state.beams,
                battery=Battery(state.level, self._config.battery.capacity, state.has_power),
                grains=state.grains,
                wall=state.wall,
            )

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""
        return None if self._lidar is None else self._lidar.newest()

    def act(self, command: Command) -> None:
        """Take the wanted command; it holds for 0.15 s, then the robot stands.

        Raises ValueError for a twist that is not finite.
        """
        if not command.twist.is_finite:
            raise ValueError(f"expected a finite twist, got {command.twist}")
        with self._lock:
            self._wanted, self._wanted_at = command, time.monotonic()

    def locate(self) -> None:
        """Play a few notes."""
        with self._lock:
            self._is_to_sing = True

    def begin(self) -> None:
        """Open the line and take the robot over, which stands then; raises LineError."""
        self._let_go()
        if not (self._is_found() or (self._is_woken() and self._is_found())):
            raise LineError(
                f"expected a Create 2 on {self._port}, got no answer at "
                f"{' or '.join(map(str, BAUDS))} baud. Is it switched on (CLEAN lights up)?"
            )
        self._pin.forget()
        self._obedience.forget()
        self._twist = STANDSTILL
        self._switch.start()
        if self._lidar is not None:
            self._lidar.start()
        self.trouble = ""

    def _is_found(self) -> bool:
        """Whether the robot answers at one of the rates."""
        return any(self._answers(baud) for baud in BAUDS)

    def _is_woken(self) -> bool:
        """Wake the robot by the line's pin; return whether the line has one."""
        line = self._opened(self._port, BAUDS[0])
        try:
            return self._pin.wake(line)
        finally:
            line.close()

    def serve(self) -> None:
        """Take what comes, and send what is due; raises LineError, after which begin() is due."""
        try:
            if self._line is None:
                raise LineError("expected begin() before serve()")
            self._take(self._line.read(max(0.001, min(_SEND_PERIOD, self._due - time.monotonic()))))
            now = time.monotonic()
            if now - self._heard > _FRAME_WAIT:
                raise LineError(f"expected a frame each 15 ms, got none for {_FRAME_WAIT:g} s")
            if self._obedience.is_lost(now, self._twist, self._odometry.twist):
                raise DisobeyedError("its wheels do not turn as they are told")
            if now >= self._due:
                self._due = now + _SEND_PERIOD
                self._send(self._line, now)
                self._pin.keep_awake(self._line, may_sleep=self._state.mode is OpenMode.PASSIVE)
        except LineError as error:
            with self._lock:
                self._odometry.pause()
                self.trouble = str(error)
            self._let_go()
            raise

    def end(self) -> None:
        """Let the robot stand, give it back, and let go of the line."""
        line = self._line
        if line is not None:
            try:
                line.write(STOP + commands.silence() + commands.into(OpenMode.PASSIVE))
                line.write(commands.into(OpenMode.OFF))
            except LineError as error:
                self.trouble = str(error)
        self._let_go()
        if self._lidar is not None:
            self._lidar.stop()

    def _let_go(self) -> None:
        """Let go of the line; the dead man's switch stops the robot once more, if it can."""
        with self._lock:
            self._odometry.pause()
        self._switch.end()
        line, self._line = self._line, None
        if line is not None:
            line.close()

    def _answers(self, baud: int) -> bool:
        """Open the line at ``baud`` and ask for the stream; return whether a frame comes."""
        self._lists = (ALL,) if baud >= _LEAST_BAUD_FOR_ALL else (FAST, SLOW)
        self._reader = FrameReader(self._lists)
        self._line = self._opened(self._port, baud)
        try:
            self._line.discard()
            self._line.write(LONG_PADDING + commands.into(OpenMode.PASSIVE))
            self._line.write(commands.song() + commands.stream(self._lists[0]))
            self._due, until = time.monotonic(), time.monotonic() + _FIRST_FRAME_WAIT
            self._heard = -math.inf
            while not math.isfinite(self._heard) and time.monotonic() < until:
                self._take(self._line.read(_SEND_PERIOD))
        except LineError:
            self._let_go()
            raise
        if not math.isfinite(self._heard):
            self._let_go()
            return False
        return True

    def _take(self, data: bytes) -> None:
        for told in self._reader.take(data):
            self._heard, now = time.monotonic(), self._now()
            with self._lock:
                self._told.update(told)
                self._state = state_of(self._told)
                if Packet.LEFT_ENCODER in told:
                    self._odometry.take(now, told[Packet.LEFT_ENCODER], told[Packet.RIGHT_ENCODER])

    def _send(self, line: Line, now: float) -> None:
        with self._lock:
            fresh = now - min(self._wanted_at, self._heard) <= _LONGEST_SILENCE
            wanted = self._wanted if fresh else Command()
            sings, self._is_to_sing = self._is_to_sing, False
            state = self._state
        if sings:
            self._sings_until = now + commands.SONG_TIME
        twist = _allowed(wanted.twist, state)
        mode = self._mode_for(twist, state, now)
        data = commands.PADDING
        if mode is not state.mode:
            data += commands.into(mode)
        if mode is not OpenMode.PASSIVE:
            data += commands.drive(twist, self._config.body.wheel_separation)
            data += commands.power(*self._duties(wanted, twist))
        if sings:
            data += commands.play()
        # Until the robot hears this command it obeys the one before: either of them may move it.
        if not self._switch.tell(twist != STANDSTILL or self._twist != STANDSTILL):
            raise LineError("its dead man's switch ended, and nothing else stops a robot for long")
        line.write(data + self._next_list())
        self._twist = twist

    def _mode_for(self, twist: Twist, state: Create2State, now: float) -> OpenMode:
        """Return the mode: safe off the station, passive to charge, full to leave or to sing there.

        With a dropped wheel it is passive everywhere.
        """
        if state.dropped_left or state.dropped_right:
            return OpenMode.PASSIVE
        if not state.has_power:
            return OpenMode.SAFE
        # With a charger safe mode ends at once, and passive mode alone charges.
        leaves = twist != STANDSTILL or now < self._sings_until
        return OpenMode.FULL if leaves else OpenMode.PASSIVE

    def _duties(self, wanted: Command, twist: Twist) -> tuple[float, float]:
        """Return the duties of brush and fan, which rest while the robot stands."""
        if twist == STANDSTILL:
            return 0.0, 0.0
        brush = self._config.brush.duty if wanted.brush is None else wanted.brush
        return brush, self._config.fan.duty if wanted.fan is None else wanted.fan

    def _next_list(self) -> bytes:
        """Return the command that streams the other list, if there are two and a change is due."""
        if len(self._lists) == 1:
            return b""
        self._sent = (self._sent + 1) % _COMMANDS_PER_SLOW_LIST
        if self._sent > 1:
            return b""
        fast, slow = self._lists
        return commands.stream(slow if self._sent == 0 else fast)


def _allowed(twist: Twist, state: Create2State) -> Twist:
    """Return ``twist`` where it is allowed, else standstill.

    With a dropped wheel or a cable nothing is driven, at a cliff nothing ahead, and on the station
    only what backs off it.
    """
    is_blocked = (
        state.dropped_left
        or state.dropped_right
        or state.has_cable
        or (twist.linear > 0.0 and state.cliff.any)
        or (twist.linear >= 0.0 and state.has_power)
    )
    return STANDSTILL if is_blocked else twist
