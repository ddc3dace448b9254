"""The commands that are sent to a Create 2."""

from __future__ import annotations

import math

import pytest

from roomba.drivers.create2 import commands
from roomba.drivers.create2.open_interface import OpenMode
from roomba.geometry import Twist

TRACK = 0.235


@pytest.mark.parametrize(
    ("twist", "sent"),
    [
        (Twist(0.2, 0.0), [145, 0, 200, 0, 200]),
        (Twist(-0.1, 0.0), [145, 255, 156, 255, 156]),
        (Twist(0.0, 1.0), [145, 0, 118, 255, 138]),
        (Twist(0.5, 2.0), [145, 1, 244, 0, 180]),
        (Twist(), [145, 0, 0, 0, 0]),
    ],
)
def test_a_twist_is_two_speeds_right_before_left(twist: Twist, sent: list[int]) -> None:
    assert list(commands.drive(twist, TRACK)) == sent


def test_a_twist_that_is_no_number_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        commands.drive(Twist(math.nan, 0.0), TRACK)


def test_duties_are_of_127() -> None:
    assert list(commands.power(1.0, 0.5)) == [144, 127, 76, 64]
    assert list(commands.power(0.0, 2.0)) == [144, 0, 0, 127]


def test_modes_streams_and_songs() -> None:
    assert [commands.into(mode)[0] for mode in OpenMode] == [173, 128, 131, 132]
    assert list(commands.stream([7, 43])) == [148, 2, 7, 43]
    assert list(commands.silence()) == [150, 0]
    song = commands.song()
    assert (song[:3], len(song)) == (bytes([140, 0, 4]), 11)
    assert pytest.approx(60 / 64) == commands.SONG_TIME
    assert list(commands.play()) == [141, 0]
