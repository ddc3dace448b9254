"""Commands as they come over the line, byte by byte."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from roomba.drivers.create2.open_interface import Opcode

_LENGTHS: Final = {
    Opcode.BAUD: 1,
    Opcode.DRIVE: 4,
    Opcode.MOTORS: 1,
    Opcode.LEDS: 3,
    Opcode.PLAY: 1,
    Opcode.SENSORS: 1,
    Opcode.PWM_MOTORS: 3,
    Opcode.DRIVE_DIRECT: 4,
    Opcode.DRIVE_PWM: 4,
    Opcode.TOGGLE_STREAM: 1,
    Opcode.SCHEDULING_LEDS: 2,
    Opcode.DIGIT_LEDS_RAW: 4,
    Opcode.DIGIT_LEDS_ASCII: 4,
    Opcode.BUTTONS: 1,
    Opcode.SCHEDULE: 15,
    Opcode.SET_DAY_TIME: 3,
}
"""Bytes of data after the opcode; an opcode that is neither here nor in ``_COUNTED`` has none."""
_COUNTED: Final = {Opcode.STREAM: (0, 1), Opcode.QUERY_LIST: (0, 1), Opcode.SONG: (1, 2)}
"""The place after the opcode of the byte that counts the items, and the bytes of an item."""
_OPCODES: Final = frozenset(int(opcode) for opcode in Opcode)


@dataclass(frozen=True, slots=True)
class Instruction:
    """A command that came whole."""

    opcode: Opcode
    data: bytes = b""


class InstructionReader:
    """Makes instructions of bytes; a byte that begins none is passed over."""

    def __init__(self) -> None:
        self._came = b""

    def take(self, data: bytes) -> list[Instruction]:
        """Return the instructions that are whole by now."""
        self._came += data
        whole: list[Instruction] = []
        while self._came:
            if self._came[0] not in _OPCODES:
                self._came = self._came[1:]
                continue
            opcode = Opcode(self._came[0])
            end = self._end_of(opcode)
            if end is None or len(self._came) < end:
                break
            whole.append(Instruction(opcode, self._came[1:end]))
            self._came = self._came[end:]
        return whole

    def _end_of(self, opcode: Opcode) -> int | None:
        """Return the length of the instruction that begins the buffer, bytes; None: not known."""
        if opcode not in _COUNTED:
            return 1 + _LENGTHS.get(opcode, 0)
        place, item = _COUNTED[opcode]
        if len(self._came) <= 1 + place:
            return None
        return 2 + place + item * self._came[1 + place]
