"""Reads pictures of floor plans through Pillow: PGM, PNG and others, of bounded size."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import PIL.Image
from numpy.typing import NDArray

from roomba.errors import HomeError
from roomba.files.bounded import read_bytes
from roomba.files.kept import SealError, unsealed
from roomba.grid import MOST_CELLS

PNG_BEGIN = b"\x89PNG\r\n\x1a\n"
FORMATS = ("PNG", "PPM", "BMP", "GIF", "JPEG", "TIFF", "WEBP")
"""What Pillow may read: other formats run programs, or describe what is to be drawn."""
PNG_END = b"IEND\xaeB`\x82"
_LFS_BEGIN: Final = b"version https://git-lfs"
_CUT_SHORT: Final = ("truncated", "not enough image data", "Reached EOF")
"""What Pillow says of a picture whose end is missing."""
_PNM_HEAD: Final = re.compile(rb"P[2356]" + 3 * rb"(?:\s|#[^\r\n]*[\r\n])+(\d+)")
"""How a PGM or PPM begins: its third number is the value of white."""
_WHITE: Final = 255
"""The value of white in most pictures, and in :class:`Image`."""


@dataclass(frozen=True, slots=True, eq=False)
class Image:
    """Grey values 0..255 as float64 [height, width], row 0 at the top, and where it is clear."""

    grey: NDArray[np.float64]
    transparent: NDArray[np.bool_]


def read_image(path: Path) -> Image:
    """Read a picture; colours are averaged. Raises :class:`HomeError` with file and reason."""
    try:
        content = unsealed(read_bytes(path))
    except SealError as error:
        raise HomeError(f"{path}: {error}") from error
    except OSError as error:
        raise HomeError(f"expected a picture at {path}, got: {error.strerror or error}") from error
    return _read_with_pillow(path, content)


def is_picture(path: Path) -> bool:
    """Whether a file begins as a picture that :func:`read_image` reads."""
    try:
        PIL.Image.open(io.BytesIO(read_bytes(path)), formats=FORMATS)
    except PIL.Image.DecompressionBombError:
        return True
    except (OSError, SyntaxError, ValueError):
        return False
    return True


def _require_size(path: Path, width: int, height: int) -> None:
    """Refuse a picture that would take the memory before it is unpacked."""
    if width * height > MOST_CELLS:
        raise HomeError(
            f"{path}: expected at most {MOST_CELLS} pixels, got {width} x {height} = "
            f"{width * height}; cut it to the home, or make its cells larger"
        )


def _read_with_pillow(path: Path, content: bytes) -> Image:
    if content.startswith(PNG_BEGIN) and PNG_END not in content[-64:]:
        raise HomeError(f"{path}: expected a whole PNG, got one that is cut short; copy it again")
    if not content:
        raise HomeError(f"{path}: expected a picture, got an empty file")
    if content.startswith(_LFS_BEGIN):
        raise HomeError(
            f"{path}: expected a picture, got a pointer of Git LFS to one; fetch it by git lfs pull"
        )
    try:
        picture = PIL.Image.open(io.BytesIO(content), formats=FORMATS)
        _require_size(path, *picture.size)
        return _decoded(picture, _white_of(content))
    except PIL.Image.DecompressionBombError as error:
        raise HomeError(
            f"{path}: expected at most {MOST_CELLS} pixels, got a larger picture ({error}); cut it "
            "to the home, or make its cells larger"
        ) from error
    except PIL.UnidentifiedImageError as error:
        raise HomeError(
            f"{path}: expected a PGM or PNG picture, got something else; convert it"
        ) from error
    except (OSError, SyntaxError, ValueError) as error:
        if any(words in str(error) for words in _CUT_SHORT):
            raise HomeError(
                f"{path}: expected a whole picture, got one that is cut short ({error}); copy it "
                "again"
            ) from error
        raise HomeError(
            f"{path}: expected a PGM or PNG picture, got something else ({error}); convert it"
        ) from error


def _white_of(content: bytes) -> int:
    """Return which value is white in a file; more than 8 bits count as 8."""
    head = _PNM_HEAD.match(content)
    return min(int(head[3]), _WHITE) if head else _WHITE


def _as_map_server(grey: NDArray[np.uint8], white: int) -> NDArray[np.float64]:
    """Return greys 0..255 as map_server reads them from a file whose white is ``white``.

    SDL_image, which map_server uses, rounds down, and Pillow to the nearest: so 205 of 254, the
    grey by which map_saver says "unknown", stays 205.
    """
    greys: NDArray[np.float64] = np.rint(grey * (white / _WHITE)) * _WHITE // white
    return greys


def _decoded(picture: PIL.Image.Image, white: int) -> Image:
    """Return a decoded picture. Raises ValueError for greys of more than 16 bits."""
    if picture.mode in ("I", "F") or picture.mode.startswith("I;16"):
        grey = np.asarray(picture, np.float64)
        if picture.mode == "F" or grey.min() < 0.0 or grey.max() > 65535.0:
            raise ValueError("greys of more than 16 bits")
        return Image(grey * (255.0 / 65535.0), np.zeros(grey.shape, np.bool_))
    if picture.mode == "L" and "transparency" not in picture.info:
        grey = _as_map_server(np.asarray(picture), white)
        return Image(grey, np.zeros(grey.shape, np.bool_))
    pixels = np.asarray(picture.convert("RGBA"))
    return Image(_as_map_server(pixels[..., :3], white).mean(axis=2), pixels[..., 3] == 0)
