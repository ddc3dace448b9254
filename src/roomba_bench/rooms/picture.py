"""True rooms, ours and the baseline's side by side, for looking at."""

from __future__ import annotations

import colorsys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from roomba.grid import UNKNOWN
from roomba_bench.rooms.truth import KnownRooms, RoomLabels, overlaps

Pixels = NDArray[np.uint8]

_PANEL = 640
"""Pixels; a panel is enlarged by the least whole number that makes it this wide or high."""
_CAPTION = 18
_WALL, _UNKNOWN, _NO_ROOM, _PAPER = (0, 0, 0), (110, 110, 110), (235, 235, 235), (255, 255, 255)
_GOLDEN = 0.618034
"""Of a turn between the hues of successive rooms, so that neighbours differ."""


def write_picture(path: Path, known: KnownRooms, found: Mapping[str, RoomLabels]) -> None:
    """Write a PNG: a panel of the true rooms and one of each segmentation, by its name.

    A segment has the colour of the room that it has most in common with; further segments of the
    same room have colours of their own.
    """
    scale = max(1, -(-_PANEL // max(known.map.frame.shape)))
    panels = {f"true: {known.count} rooms": _coloured(known, known.labels, scale)}
    for name, labels in found.items():
        alike = _like_rooms(known, labels)
        count = np.unique(alike).size - 1
        panels[f"{name}: {count} rooms"] = _coloured(known, alike, scale)
    rows, columns = known.map.frame.shape
    width, height = columns * scale + 8, rows * scale + _CAPTION
    beside = rows > 0.8 * columns
    size = (width * len(panels), height) if beside else (width, height * len(panels))
    picture = Image.new("RGB", size, _PAPER)
    pen = ImageDraw.Draw(picture)
    for index, (caption, pixels) in enumerate(panels.items()):
        x, y = (index * width, 0) if beside else (0, index * height)
        pen.text((x + 4, y + 3), f"{known.name}, {caption}", fill=_WALL)
        picture.paste(Image.fromarray(pixels), (x, y + _CAPTION))
    path.parent.mkdir(parents=True, exist_ok=True)
    picture.save(path)


def _like_rooms(known: KnownRooms, labels: RoomLabels) -> RoomLabels:
    """Return the labels renumbered by the true rooms that they overlap most."""
    common = overlaps(known, labels)
    number = np.zeros(common.shape[1], np.int64)
    taken: set[int] = set()
    fresh = known.count
    for segment in 1 + np.argsort(-common[:, 1:].max(axis=0, initial=0), kind="stable"):
        room = int(common[1:, segment].argmax()) + 1 if known.count else 0
        if common[room, segment] == 0 or room in taken:
            fresh += 1
            room = fresh
        taken.add(room)
        number[segment] = room
    number[np.bincount(labels.ravel(), minlength=number.size) == 0] = 0
    alike: RoomLabels = number[labels]
    return alike


def _coloured(known: KnownRooms, labels: RoomLabels, scale: int) -> Pixels:
    hues = (np.arange(1, int(labels.max(initial=0)) + 1) * _GOLDEN) % 1.0
    colours = [colorsys.hsv_to_rgb(hue, 0.45, 0.95) for hue in hues.tolist()]
    palette = np.array([np.array(_NO_ROOM) / 255.0, *colours]) * 255.0
    pixels = palette.astype(np.uint8)[labels]
    pixels[known.map.solid] = _WALL
    pixels[known.map.values == UNKNOWN] = _UNKNOWN
    enlarged: Pixels = np.kron(pixels[::-1], np.ones((scale, scale, 1), np.uint8))
    return enlarged
