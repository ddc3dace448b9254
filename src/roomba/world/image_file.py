"""Reads pictures of floor plans: PGM by itself, PNG and others through OpenCV."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.errors import HomeError

PNG_BEGIN = b"\x89PNG\r\n\x1a\n"
PNG_END = b"IEND\xaeB`\x82"
_PGM_TOKEN = rb"(?:\s|#[^\n]*\n)+(\d+)"
_PGM_HEADER = re.compile(rb"P([25])(?:%s)(?:%s)(?:%s)\s" % ((_PGM_TOKEN,) * 3))


@dataclass(frozen=True, slots=True, eq=False)
class Image:
    """Grey values 0..255 as float64 [height, width], row 0 at the top, and where it is clear."""

    grey: NDArray[np.float64]
    transparent: NDArray[np.bool_]


def read_image(path: Path) -> Image:
    """Read a picture; colours are averaged. Raises :class:`HomeError` with file and reason."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise HomeError(f"expected a picture at {path}, got: {error.strerror or error}") from error
    if content[:2] in (b"P2", b"P5"):
        grey = _read_pgm(path, content)
        return Image(grey, np.zeros(grey.shape, np.bool_))
    return _read_with_opencv(path, content)


def _read_pgm(path: Path, content: bytes) -> NDArray[np.float64]:
    header = _PGM_HEADER.match(content)
    if header is None:
        raise HomeError(
            f"{path}: expected a PGM header (P5 width height 255), got another; save anew"
        )
    width, height, highest = (int(number) for number in header.groups()[1:])
    if width == 0 or height == 0 or not 0 < highest < 65536:
        raise HomeError(f"{path}: expected a picture, got {width} x {height} px, grey to {highest}")
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


def _read_with_opencv(path: Path, content: bytes) -> Image:
    if content.startswith(PNG_BEGIN) and PNG_END not in content[-64:]:
        raise HomeError(f"{path}: expected a whole PNG, got one that is cut short; copy it again")
    if not content:
        raise HomeError(f"{path}: expected a picture, got an empty file")
    try:
        decoded = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        decoded = None
    if decoded is None or decoded.dtype not in (np.uint8, np.uint16):
        raise HomeError(f"{path}: expected a PGM or PNG picture, got something else; convert it")
    pixels = decoded.astype(np.float64) * (255.0 / np.iinfo(decoded.dtype).max)
    if pixels.ndim == 2:
        return Image(pixels, np.zeros(pixels.shape, np.bool_))
    has_alpha = pixels.shape[2] in (2, 4)
    colours = pixels[..., :-1] if has_alpha else pixels
    transparent = pixels[..., -1] == 0.0 if has_alpha else np.zeros(pixels.shape[:2], np.bool_)
    return Image(colours.mean(axis=2), np.asarray(transparent, np.bool_))
