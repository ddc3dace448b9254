"""Compiled last steps of a picture: painted columns become rows of pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.world.camera.kernels.colour import GREEN, RED_BLUE
from roomba.world.camera.kernels.compilation import INLINE, INNER, KERNEL
from roomba.world.camera.scene.arrays import STRIP

BLOCK = 16
"""Columns that are turned into rows together: they fit into the nearest cache."""
TURNED = 8
"""Columns of a strip that are turned into rows together."""
TWO = np.uint32(2)


@compiled(**KERNEL)
def develop(
    colours: NDArray[np.uint32], tone: NDArray[np.uint8], picture: NDArray[np.uint8]
) -> None:
    """Turn painted columns [width, height] into an RGB picture [height, width, 3], toned."""
    height, width, _ = picture.shape
    for low in range(0, width, BLOCK):
        for row in range(height):
            for column in range(low, min(low + BLOCK, width)):
                colour = int(colours[column, row])
                picture[row, column, 0] = tone[colour & 255]
                picture[row, column, 1] = tone[(colour >> 8) & 255]
                picture[row, column, 2] = tone[(colour >> 16) & 255]


@compiled(**INNER)
def shrink(colours: NDArray[np.uint32], halved: NDArray[np.uint32]) -> None:
    """Average two painted columns, [2, 2 n], over 2 x 2 samples into one, [n]."""
    for row in range(halved.shape[0]):
        one = np.uint32(colours[0, 2 * row])
        two = np.uint32(colours[0, 2 * row + 1])
        three = np.uint32(colours[1, 2 * row])
        four = np.uint32(colours[1, 2 * row + 1])
        # Red and blue are added in one sum: the eight free bits between them take the carry.
        red_blue = (one & RED_BLUE) + (two & RED_BLUE) + (three & RED_BLUE) + (four & RED_BLUE)
        green = (one & GREEN) + (two & GREEN) + (three & GREEN) + (four & GREEN)
        halved[row] = ((red_blue >> TWO) & RED_BLUE) | ((green >> TWO) & GREEN)


@compiled(**INLINE)
def turn(
    columns: NDArray[np.float32 | np.uint32],
    last: int,
    rows: NDArray[np.float32 | np.uint32],
    begin: int,
) -> None:
    """Copy the columns of a strip into rows, down to before row ``last``.

    ``columns`` is [STRIP, rows]; they become the columns of ``rows`` from ``begin`` on.
    """
    for first in range(0, STRIP, TURNED):
        for at_row in range(last):
            row = np.uint64(at_row)
            for i in range(first, first + TURNED):
                rows[row, np.uint64(begin + i)] = columns[np.uint64(i), row]


@compiled(**INLINE)
def write_pixels(colours: NDArray[np.uint32], pixels: NDArray[np.uint8]) -> None:
    """Write packed colours [STRIP] as red, green and blue, a byte each."""
    for i in range(STRIP):
        colour = colours[i]
        pixels[3 * i] = colour & 255
        pixels[3 * i + 1] = (colour >> 8) & 255
        pixels[3 * i + 2] = (colour >> 16) & 255
