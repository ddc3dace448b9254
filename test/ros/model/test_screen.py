"""A window dump of X becomes a picture, in either order of bytes."""

import struct

import numpy as np
import pytest

from roomba.errors import RoombaError
from roomba_ros.model.screen import decoded

COLOURS = np.array([[[250, 20, 3], [0, 1, 2]], [[9, 8, 7], [60, 70, 80]]], np.uint8)


def dump(order: int, bits: int = 32) -> bytes:
    """Return a dump of 2 by 2 pixels, whose lines have one pixel more that does not count."""
    words = [108, 7, 2, 24, 2, 2, 0, order, 32, order, 32, bits, 12, 4, 0, 0, 0, 8, 3, 3]
    header = struct.pack(">25I", *words, 2, 2, 0, 0, 0) + b"a name\0\0"
    pixels = np.zeros((2, 3, 4), np.uint8)
    pixels[:, :2, slice(2, None, -1) if order == 0 else slice(1, None)] = COLOURS
    return header + b"\0" * 36 + pixels.tobytes()


@pytest.mark.parametrize("order", [0, 1])
def test_it_is_a_picture(order: int) -> None:
    picture = decoded(dump(order))
    assert picture.shape == (2, 2, 3)
    assert np.array_equal(picture, COLOURS)


@pytest.mark.parametrize("broken", [b"", dump(0)[:120], dump(0, bits=16)])
def test_what_is_none_is_refused(broken: bytes) -> None:
    with pytest.raises(RoombaError, match="expected a window dump"):
        decoded(broken)
