"""The floor of a run as SVG: map, coverage, path, station, and what was missed."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Sequence
from html import escape
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from roomba.client.protocol import MissedFloor
from roomba.history.report import words
from roomba.history.run import CellLayer, RunRecording

MAP_COLOURS: Final = ((0, 0, 0, 0), (252, 250, 245, 255), (112, 104, 94, 255))
"""RGBA of floor that is unknown, free and occupied."""
COVERAGE_COLOURS: Final = (
    (0, 0, 0, 0),
    (199, 231, 217, 255),
    (146, 207, 181, 255),
    (92, 178, 143, 255),
)
"""Not swept, once, twice, more often."""
_MARGIN: Final = 0.2
"""m around what is known."""
_JUMP: Final = 1.0
"""m between two rows of a trace; a robot that went farther was carried."""
_BELOW: Final = 0.22
"""m from the middle of a mark to that of its area."""


def floor_svg(recording: RunRecording, missed: Sequence[MissedFloor], title: str) -> str:
    """Return the picture, one unit a centimetre; the numbers are those of ``missed``, from 1."""
    left, bottom, right, top = _bounds(recording)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="{100 * left:.0f} '
        f'{-100 * top:.0f} {100 * (right - left):.0f} {100 * (top - bottom):.0f}">',
        f"<title>{escape(title)}</title>",
    ]
    for name, colours in (("map", MAP_COLOURS), ("coverage", COVERAGE_COLOURS)):
        if name in recording.layers:
            parts.append(_image(recording.layers[name], colours))
    parts += [_ring(ring) for room in recording.home.get("rooms", ()) for ring in room["rings"]]
    parts += _path(recording)
    parts += [
        _text("room", room["name"], *room["anchor"]) for room in recording.home.get("rooms", ())
    ]
    parts.append(_station(recording))
    parts += [_miss(number, miss) for number, miss in enumerate(missed, 1)]
    return "".join((*parts, "</svg>"))


def _bounds(recording: RunRecording) -> tuple[float, float, float, float]:
    """Return lowest x and y, highest x and y, m, of what is known and was driven."""
    found = [recording.trace[:, 1:3]] if len(recording.trace) else [np.zeros((1, 2))]
    layer = recording.layers.get("map")
    if layer is not None and layer.cells.any():
        rows, columns = np.nonzero(layer.cells)
        low = np.array([columns.min(), rows.min()])
        high = np.array([columns.max() + 1, rows.max() + 1])
        corner = np.array([layer.origin_x, layer.origin_y])
        found.append(corner + np.array([low, high]) * layer.resolution)
    points = np.concatenate(found)
    low, high = points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _image(layer: CellLayer, colours: tuple[tuple[int, ...], ...]) -> str:
    rows, columns = layer.cells.shape
    size = 100.0 * layer.resolution
    top = layer.origin_y + rows * layer.resolution
    return (
        f'<image x="{100 * layer.origin_x:.1f}" y="{-100 * top:.1f}" width="{columns * size:.1f}" '
        f'height="{rows * size:.1f}" preserveAspectRatio="none" '
        f'style="image-rendering:pixelated" href="{_png(layer.cells, colours)}"/>'
    )


def _png(cells: NDArray[np.uint8], colours: tuple[tuple[int, ...], ...]) -> str:
    """Return cells as an address that holds their picture, the highest row on top."""
    palette = np.array(colours, np.uint8)
    pixels = palette[np.minimum(cells, len(palette) - 1)][::-1]
    packed = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels), "RGBA").save(packed, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(packed.getvalue()).decode()


def _ring(ring: Sequence[Sequence[float]]) -> str:
    points = " ".join(f"{100 * x:.0f},{-100 * y:.0f}" for x, y in ring)
    return f'<polygon class="ring" points="{points}"/>'


def _path(recording: RunRecording) -> list[str]:
    """Return the way as lines, broken where the robot was carried."""
    points = recording.trace[:, 1:3].astype(np.float64)
    steps = np.hypot(*np.diff(points, axis=0).T) if len(points) > 1 else np.empty(0)
    pieces = np.split(points, np.nonzero(steps > _JUMP)[0] + 1)
    return [
        '<polyline class="way" points="'
        + " ".join(f"{100 * x:.0f},{-100 * y:.0f}" for x, y in piece.tolist())
        + '"/>'
        for piece in pieces
        if len(piece) > 1
    ]


def _station(recording: RunRecording) -> str:
    x, y, theta = recording.home.get("station", (0.0, 0.0, 0.0))
    x, y = 100 * (x + 0.15 * math.cos(theta)), -100 * (y + 0.15 * math.sin(theta))
    return f'<path class="station" d="M{x - 12:.0f} {y:.0f}h24M{x:.0f} {y - 12:.0f}v24"/>'


def _miss(number: int, miss: MissedFloor) -> str:
    """Return a mark, the same for any area: which cells were missed is not kept."""
    x, y = 100 * miss.x, -100 * miss.y
    return (
        f'<circle class="missed" cx="{x:.0f}" cy="{y:.0f}" r="12"/>'
        + _text("number", str(number), miss.x, miss.y)
        + _text("size", words.area(miss.area), miss.x, miss.y - _BELOW)
    )


def _text(kind: str, text: str, x: float, y: float) -> str:
    return f'<text class="{kind}" x="{100 * x:.0f}" y="{-100 * y:.0f}">{escape(text)}</text>'
