"""Commands, byte by byte."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.drivers.create2.open_interface import Opcode
from roomba.emulators.create2.instructions import Instruction, InstructionReader


@pytest.mark.parametrize(
    ("sent", "opcode", "data"),
    [
        ([128], Opcode.START, []),
        ([137, 255, 56, 1, 244], Opcode.DRIVE, [255, 56, 1, 244]),
        ([149, 2, 7, 13], Opcode.QUERY_LIST, [2, 7, 13]),
        ([148, 0], Opcode.STREAM, [0]),
        ([140, 3, 2, 60, 16, 62, 16], Opcode.SONG, [3, 2, 60, 16, 62, 16]),
        ([167, *range(15)], Opcode.SCHEDULE, list(range(15))),
    ],
)
def test_a_command_is_whole_with_its_last_byte(
    sent: list[int], opcode: Opcode, data: list[int]
) -> None:
    reader = InstructionReader()
    for byte in sent[:-1]:
        assert reader.take(bytes([byte])) == []
    assert reader.take(bytes(sent[-1:])) == [Instruction(opcode, bytes(data))]


def test_bytes_that_begin_no_command_are_passed_over() -> None:
    reader = InstructionReader()
    told = reader.take(bytes([0, 5, 255, 131, 0, 0, 145, 0, 1, 0, 2, 173]))
    assert [each.opcode for each in told] == [Opcode.SAFE, Opcode.DRIVE_DIRECT, Opcode.STOP]


def test_after_any_bytes_zeros_bring_it_back_into_step() -> None:
    reader, random = InstructionReader(), np.random.default_rng(2)
    reader.take(random.bytes(10_000))
    reader.take(bytes(512))
    assert reader.take(bytes([131])) == [Instruction(Opcode.SAFE)]
