"""Pictures as PNG files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2

from roomba.plots.canvas import Picture


def write_png(path: Path, picture: Picture, parameters: Sequence[int] = ()) -> None:
    """Write pixels, RGB uint8 [height, width, 3], into a PNG file; raises OSError.

    ``parameters`` are those of cv2.imwrite.
    """
    if not cv2.imwrite(str(path), picture[:, :, ::-1], parameters):
        raise OSError(f"{path}: cannot be written")
