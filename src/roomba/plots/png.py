"""Pictures as PNG files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2

from roomba.plots.canvas import Picture


def write_png(path: Path, picture: Picture, parameters: Sequence[int] = ()) -> None:
    """Write pixels, RGB uint8 [height, width, 3], into a PNG file; raises OSError.

    ``parameters`` are those of cv2.imencode.
    """
    # Not by cv2.imwrite: a name that is no UTF-8 ends the process there.
    _, encoded = cv2.imencode(".png", picture[:, :, ::-1], parameters)
    try:
        path.write_bytes(encoded.tobytes())
    except OSError as error:
        raise OSError(f"{path}: cannot be written: {error.strerror}") from error
