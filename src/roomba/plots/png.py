"""Pictures as PNG files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2

from roomba.files.atomic import write_output
from roomba.plots.canvas import Picture


def write_png(path: Path, picture: Picture, parameters: Sequence[int] = ()) -> None:
    """Write pixels, RGB uint8 [height, width, 3], into a PNG file, whole or not at all.

    ``parameters`` are those of cv2.imencode. Raises OSError.
    """
    # Not by cv2.imwrite: a name that is no UTF-8 ends the process there.
    _, encoded = cv2.imencode(".png", picture[:, :, ::-1], parameters)
    try:
        write_output(path, encoded.tobytes())
    except OSError as error:
        raise OSError(f"{path}: cannot be written: {error.strerror}") from error
