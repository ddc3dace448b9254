"""A serial line belongs to one program."""

from __future__ import annotations

import contextlib

import pytest

from roomba.drivers.line import LineError, SerialLine
from roomba.emulators.pseudo_terminal import PseudoTerminal


def test_a_line_that_another_one_has_open_is_refused_until_it_is_closed() -> None:
    with contextlib.closing(PseudoTerminal()) as terminal:
        first = SerialLine(terminal.name, 115_200)
        with pytest.raises(LineError, match="a line that another program has open; end that one"):
            SerialLine(terminal.name, 115_200)
        first.close()
        SerialLine(terminal.name, 115_200).close()


def test_a_line_that_there_is_not_is_refused_with_what_to_do() -> None:
    with pytest.raises(LineError, match="Is it plugged in and switched on"):
        SerialLine("/dev/no-such-line", 115_200)
