"""Reads pictures of floor plans, of bounded size: PGM by itself, PNG and others through Pillow."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path

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
_PGM_TOKEN = rb"(?:\s|#[^\n]*\n)+(\d{1,9})"
_PGM_HEADER = re.compile(rb"P([25])(?:%s)(?:%s)(?:%s)\s" % ((_PGM_TOKEN,) * 3))


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
    if content[:2] in (b"P2", b"P5"):
        grey = _read_pgm(path, content)
        return Image(grey, np.zeros(grey.shape, np.bool_))
    return _read_with_pillow(path, content)


def _read_pgm(path: Path, content: bytes) -> NDArray[np.float64]:
    header = _PGM_HEADER.match(content)
    if header is None:
        raise HomeError(
            f"{path}: expected a PGM header (P5 width height 255), got another; save anew"
        )
    width, height, highest = (int(number) for number in header.groups()[1:])
    if width == 0 or height == 0 or not 0 < highest < 65536:
        raise HomeError(f"{path}: expected a picture, got {width} x {height} px, grey to {highest}")
    _require_size(path, width, height)
    body = content[header.end() :]
    if header.group(1) == b"2":
        try:
            pixels = np.array(re.sub(rb"#[^\n]*", b"", body).split(), dtype=np.int64)
        except (ValueError, OverflowError):
            raise HomeError(f"{path}: expected numbers after the header, got other text") from None
    else:
        item = np.dtype(">u2" if highest > 255 else "u1")
        pixels = np.frombuffer(body[: len(body) // item.itemsize * item.itemsize], item)
    if pixels.size < width * height:
        raise HomeError(
            f"{path}: expected {width} x {height} = {width * height} pixels, got {pixels.size}; "
            "the file is cut short, copy it again"
        )
    grey = pixels[: width * height].reshape(height, width).astype(np.float64)
    if grey.min() < 0 or grey.max() > highest:
        raise HomeError(f"{path}: expected grey values from 0 to {highest}, got others")
    return grey * (255.0 / highest)


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
    try:
        picture = PIL.Image.open(io.BytesIO(content), formats=FORMATS)
        _require_size(path, *picture.size)
        return _decoded(picture)
    except (OSError, SyntaxError, ValueError, PIL.Image.DecompressionBombError) as error:
        raise HomeError(
            f"{path}: expected a PGM or PNG picture, got something else ({error}); convert it"
        ) from error


def _decoded(picture: PIL.Image.Image) -> Image:
    """Return a decoded picture. Raises ValueError for greys of more than 16 bits."""
    if picture.mode in ("I", "F") or picture.mode.startswith("I;16"):
        grey = np.asarray(picture, np.float64)
        if picture.mode == "F" or grey.min() < 0.0 or grey.max() > 65535.0:
            raise ValueError("greys of more than 16 bits")
        return Image(grey * (255.0 / 65535.0), np.zeros(grey.shape, np.bool_))
    pixels = np.asarray(picture.convert("RGBA"))
    return Image(pixels[..., :3].mean(axis=2), pixels[..., 3] == 0)
