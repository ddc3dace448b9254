"""A Create 2 in a simulated home: what it does when it is told to, and what it answers."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Mapping
from typing import Final

from roomba.drivers.create2.open_interface import (
    BAUDS,
    FORMATS,
    HEADER,
    Opcode,
    OpenMode,
    Packet,
    checked,
    format_of,
    is_known,
    packets_of,
)
from roomba.emulators.create2.instructions import Instruction
from roomba.emulators.create2.sensing import SensingContext, encoder_angles, sensed
from roomba.emulators.create2.songs import Songs
from roomba.emulators.create2.wheels import RequestedWheels
from roomba.emulators.living import STEP
from roomba.world.simulator import Simulator

_SIDE_BRUSH, _VACUUM, _MAIN_BRUSH = 1, 2, 4
"""Bits of the command MOTORS."""
_MOST_DUTY: Final = 127
_MOST_BODY: Final = 255
"""Bytes between a frame's length and its checksum."""
_GREETING: Final = b"bl-start\r\nmade-up Create 2\r\n"
"""What it says when it begins anew; a real one tells its firmware."""
_OBEYING: Final = frozenset({OpenMode.SAFE, OpenMode.FULL})
_MOTORS: Final = frozenset(
    {
        Opcode.DRIVE,
        Opcode.DRIVE_DIRECT,
        Opcode.DRIVE_PWM,
        Opcode.MOTORS,
        Opcode.PWM_MOTORS,
        Opcode.LEDS,
        Opcode.SCHEDULING_LEDS,
        Opcode.DIGIT_LEDS_RAW,
        Opcode.DIGIT_LEDS_ASCII,
        Opcode.PLAY,
    }
)
"""Commands that do nothing outside safe and full mode."""


SLEEPS_AFTER: Final = 300.0
"""s of passive mode after which a real one falls asleep."""


class Create2Robot:
    """The robot: :meth:`do` obeys an instruction, :meth:`advance` lets time pass.

    ``mode``, ``leds`` (the last command of each kind) and ``songs`` are as of now; ``baud`` is the
    rate of its line, ``streamed`` what it tells without being asked while ``is_streaming``.
    ``is_asleep``: it hears nothing until :meth:`pull_brc` or :meth:`press_button` wakes it.
    """

    def __init__(
        self, simulator: Simulator, baud: int = BAUDS[-1], sleeps_after: float = math.inf
    ) -> None:
        """Live in the body of ``simulator``, which it drives; its line begins at ``baud``.

        It falls asleep after ``sleeps_after`` s of passive mode; a real one after
        :data:`SLEEPS_AFTER`.
        """
        self.simulator = simulator
        self.seen = simulator.observe()
        self._first_baud, self._sleeps_after = baud, sleeps_after
        self._passive_for, self._brc_is_low = 0.0, False
        self._actions: dict[Opcode, Callable[[bytes], bytes]] = {
            Opcode.RESET: self._reset,
            Opcode.START: lambda data: self._into(OpenMode.PASSIVE),
            Opcode.BAUD: self._change_baud,
            Opcode.CONTROL: lambda data: self._into(OpenMode.SAFE),
            Opcode.SAFE: lambda data: self._into(OpenMode.SAFE),
            Opcode.FULL: lambda data: self._into(OpenMode.FULL),
            Opcode.STOP: lambda data: self._into(OpenMode.OFF),
            Opcode.DRIVE: self._drive,
            Opcode.DRIVE_DIRECT: self._drive_direct,
            Opcode.DRIVE_PWM: self._drive_pwm,
            Opcode.MOTORS: self._motors,
            Opcode.PWM_MOTORS: self._pwm_motors,
            Opcode.SONG: self._song,
            Opcode.PLAY: self._play,
            Opcode.SENSORS: lambda data: self._answer(data),
            Opcode.QUERY_LIST: lambda data: self._answer(data[1:]),
            Opcode.STREAM: self._stream,
            Opcode.TOGGLE_STREAM: self._toggle_stream,
        }
        for program in (Opcode.POWER, Opcode.SPOT, Opcode.CLEAN, Opcode.MAX, Opcode.SEEK_DOCK):
            # The robot's own programs are not emulated: it goes to passive mode and stands.
            self._actions[program] = lambda data: self._into(OpenMode.PASSIVE)
        self._begin_anew()

    def _begin_anew(self) -> None:
        self.mode, self.baud, self.is_asleep = OpenMode.OFF, self._first_baud, False
        self.wheels = RequestedWheels(self.simulator.config.body.wheel_separation)
        self.leds: dict[Opcode, bytes] = {}
        self.songs = Songs()
        self.streamed: bytes = b""
        self.is_streaming = False
        self._zero = encoder_angles(self.seen)
        self._way = self._turn = 0.0
        self._brush = self._vacuum = 0.0
        self.simulator.set_power(brush=0.0, fan=0.0)

    def advance(self) -> None:
        """Let one step of the world pass."""
        before = self.seen
        self.simulator.set_power(brush=self._brush, fan=self._vacuum)
        self.simulator.advance(self.wheels.twist, STEP, 1)
        self.seen = self.simulator.observe()
        self.songs.advance(STEP)
        self._way += self.seen.odometry_twist.linear * STEP
        self._turn += self.seen.odometry.theta - before.odometry.theta
        self._turn = math.remainder(self._turn, 2.0 * math.pi)
        if self.mode is OpenMode.SAFE and self._is_unsafe():
            self._into(OpenMode.PASSIVE)
        self._grow_tired()

    def _grow_tired(self) -> None:
        """Fall asleep after a while in passive mode, also when it is told something meanwhile."""
        self._passive_for = self._passive_for + STEP if self.mode is OpenMode.PASSIVE else 0.0
        if self._passive_for >= self._sleeps_after:
            self._into(OpenMode.OFF)
            self.is_asleep = True

    def pull_brc(self, *, is_low: bool) -> None:
        """Pull the pin BRC low, or let it go: a falling edge wakes it, or keeps it awake."""
        if is_low and not self._brc_is_low:
            self.press_button()
        self._brc_is_low = is_low

    def press_button(self) -> None:
        """Press CLEAN for a moment: the robot wakes, and its time in passive mode begins anew."""
        self.is_asleep, self._passive_for = False, 0.0

    def _is_unsafe(self) -> bool:
        """Whether safe mode ends: a drop, a charger, or a cliff towards which it can come.

        It may back off from a cliff, in a curve that is no narrower than the robot.
        """
        twist, seen = self.wheels.twist, self.seen
        radius = self.simulator.config.body.radius
        backs_off = twist.linear < 0.0 and abs(twist.linear) >= abs(twist.angular) * radius
        is_moving = twist.linear != 0.0 or twist.angular != 0.0
        at_cliff = seen.cliff.any and is_moving and not backs_off
        return seen.wheels.dropped or seen.battery.is_docked or at_cliff

    def do(self, told: Instruction) -> bytes:
        """Do what it is told, if its mode allows; return the answer."""
        if self.is_asleep:
            return b""
        if self.mode is OpenMode.OFF and told.opcode not in (Opcode.START, Opcode.RESET):
            return b""
        if told.opcode in _MOTORS and self.mode not in _OBEYING:
            return b""
        action = self._actions.get(told.opcode)
        if action is not None:
            return action(told.data)
        self.leds[told.opcode] = told.data
        return b""

    def _into(self, mode: OpenMode) -> bytes:
        """Change the mode; motors rest where they do not obey."""
        if mode not in _OBEYING:
            self.wheels.halt()
            self._brush = self._vacuum = 0.0
        if mode is OpenMode.OFF:
            self.is_streaming = False
        self.mode = mode
        return b""

    def _reset(self, data: bytes) -> bytes:
        self._begin_anew()
        return _GREETING

    def _change_baud(self, data: bytes) -> bytes:
        if data[0] < len(BAUDS):
            self.baud = BAUDS[data[0]]
        return b""

    def _drive(self, data: bytes) -> bytes:
        self.wheels.drive(*struct.unpack(">hh", data))
        return b""

    def _drive_direct(self, data: bytes) -> bytes:
        self.wheels.drive_direct(*struct.unpack(">hh", data))
        return b""

    def _drive_pwm(self, data: bytes) -> bytes:
        self.wheels.drive_pwm(*struct.unpack(">hh", data))
        return b""

    def _motors(self, data: bytes) -> bytes:
        self._brush = float(bool(data[0] & _MAIN_BRUSH))
        self._vacuum = float(bool(data[0] & _VACUUM))
        return b""

    def _pwm_motors(self, data: bytes) -> bytes:
        main, _side, vacuum = struct.unpack("bbB", data)
        self._brush = min(1.0, abs(main) / _MOST_DUTY)
        self._vacuum = min(1.0, vacuum / _MOST_DUTY)
        return b""

    def _song(self, data: bytes) -> bytes:
        self.songs.keep(data[0], data[2:])
        return b""

    def _play(self, data: bytes) -> bytes:
        self.songs.play(data[0])
        return b""

    def _stream(self, data: bytes) -> bytes:
        self.streamed = _fitting(packet for packet in data[1:] if is_known(packet))
        self.is_streaming = bool(self.streamed)
        return b""

    def _toggle_stream(self, data: bytes) -> bytes:
        self.is_streaming = bool(data[0]) and bool(self.streamed)
        return b""

    def frame(self) -> bytes:
        """Return the next frame of its stream."""
        told = self._told(self.streamed)
        body = b"".join(bytes([number]) + _packed(number, told) for number in self.streamed)
        return checked(bytes([HEADER, len(body)]) + body)

    def _answer(self, numbers: Iterable[int]) -> bytes:
        known = [number for number in numbers if is_known(number)]
        told = self._told(known)
        return b"".join(_packed(number, told) for number in known)

    def _told(self, numbers: Iterable[int]) -> Mapping[int, int]:
        """Return all packets; distance and angle begin anew if they are among ``numbers``."""
        station = self.simulator.pose.inverse().compose(self.simulator.home.station)
        about = SensingContext(self.simulator.config, self._zero, station)
        told = dict.fromkeys(FORMATS, 0)
        told.update(sensed(self.seen, self.simulator.ranges, about))
        told.update(
            {
                Packet.DISTANCE: round(1e3 * self._way),
                Packet.ANGLE: round(math.degrees(self._turn)),
                Packet.MODE: self.mode,
                Packet.SONG_NUMBER: self.songs.number,
                Packet.SONG_PLAYING: int(self.songs.is_playing),
                Packet.STREAM_PACKETS: len(self.streamed),
                Packet.REQUESTED_VELOCITY: self.wheels.velocity,
                Packet.REQUESTED_RADIUS: self.wheels.radius,
                Packet.REQUESTED_RIGHT: self.wheels.right,
                Packet.REQUESTED_LEFT: self.wheels.left,
            }
        )
        asked = {packet for number in numbers for packet in packets_of(number)}
        if Packet.DISTANCE in asked:
            self._way -= 1e-3 * told[Packet.DISTANCE]
        if Packet.ANGLE in asked:
            self._turn -= math.radians(told[Packet.ANGLE])
        return told


def _fitting(numbers: Iterable[int]) -> bytes:
    """Return the first packets, as many as a frame has room for: one byte tells its length."""
    kept, size = bytearray(), 0
    for number in numbers:
        size += 1 + format_of(number).size
        if size > _MOST_BODY:
            break
        kept.append(number)
    return bytes(kept)


def _packed(number: int, told: Mapping[int, int]) -> bytes:
    return format_of(number).pack(*(told[packet] for packet in packets_of(number)))
