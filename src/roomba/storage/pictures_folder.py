"""The robot's picture folder: the newest picture of each angle, written atomically."""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from roomba.errors import PictureError
from roomba.files.atomic import write_whole

ANGLES: Final = (-30, -15, 0, 15, 30)
"""Degrees; positive is to the left."""
FARTHEST_ANGLE: Final = 180.0
"""Degrees; an angle beyond this is no direction to look in."""
_FAST_COMPRESSION: Final = 1


def nearest_angle(degrees: float) -> int:
    """Return the angle of :data:`ANGLES` nearest to a wish; raises PictureError for no angle."""
    if not math.isfinite(degrees) or abs(degrees) > FARTHEST_ANGLE:
        raise PictureError(
            f"expected an angle from {-FARTHEST_ANGLE:g} to {FARTHEST_ANGLE:g} degrees, "
            f"got {degrees:g}"
        )
    return min(ANGLES, key=lambda angle: abs(angle - degrees))


class PictureFolder:
    """Pictures are uint8 [height, width, 3] RGB, kept as ``<angle>.png``."""

    def __init__(self, folder: Path) -> None:
        """Use ``folder``, made when the first picture is written."""
        self.folder = folder

    def path(self, angle: int) -> Path:
        """Return the file of an angle."""
        return self.folder / f"{angle}.png"

    def has(self, angle: int) -> bool:
        """Whether there is a picture of this angle."""
        return self.path(angle).exists()

    def write(self, angle: int, picture: NDArray[np.uint8]) -> None:
        """Replace the picture of an angle; the old one stays until the new one is whole."""
        path = self.path(angle)
        packed = io.BytesIO()
        image = Image.fromarray(np.ascontiguousarray(picture), "RGB")
        image.save(packed, "PNG", compress_level=_FAST_COMPRESSION)
        try:
            write_whole(path, packed.getvalue())
        except OSError as error:
            raise PictureError(f"{path}: cannot be written: {error.strerror}") from error

    def read(self, angle: int) -> NDArray[np.uint8]:
        """Return the picture of an angle; raises PictureError naming the file."""
        path = self.path(angle)
        try:
            with Image.open(path, formats=["PNG"]) as image:
                return np.array(image.convert("RGB"), np.uint8)
        except UnidentifiedImageError as error:
            size = path.stat().st_size
            raise PictureError(
                f"{path}: expected a PNG picture, found {size} other bytes"
            ) from error
        except (OSError, SyntaxError) as error:
            # Pillow calls some broken files a SyntaxError.
            raise PictureError(f"{path}: cannot be read: {error}") from error
