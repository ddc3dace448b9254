"""Furniture on a plan, seen from above: its boxes, rounded as the real things are, with shadows."""

from __future__ import annotations

import cv2
import numpy as np

from roomba.plots.canvas import WHITE, Canvas, Colour, mixed, rounded, softened
from roomba.world.catalogue import FIXTURES
from roomba.world.catalogue.furniture import STATION_KIND
from roomba.world.home.home import Box, Furniture, Home, MovingKind
from roomba.world.home.materials import MATERIALS
from roomba.world.home.raster import footprint

INK: Colour = (70, 66, 64)
SHADOW: Colour = (60, 48, 40)
HANGING = 0.7
"""m; what begins above this hangs over the floor and is drawn as an outline with a tint."""

ROUNDNESS: dict[tuple[str, str], float] = {
    ("stove", "metal_dark"): 1.0,
    ("toilet", "ceramic"): 0.75,
    ("toilet", "white"): 0.95,
    ("washbasin", "water"): 0.9,
    ("bathtub", "water"): 0.85,
    ("coffee_table", "ceramic"): 1.0,
    ("nightstand", "lamp_shade"): 1.0,
    ("washing_machine", "metal"): 0.5,
    ("bed", "linen"): 0.12,
    ("office_chair", "fabric_blue"): 0.5,
}
"""Share of the half width that corners are rounded by, where the boxes stand for round things."""
ROUND_KINDS = frozenset({"plant", "lamp", "waste_bin", "stool"})


def draw_shadows(canvas: Canvas, home: Home) -> None:
    """Darken the floor beside furniture, softly, towards the lower right."""
    mask = canvas.mask()
    for piece in _pieces(home):
        for box in piece.boxes:
            if box.bottom < HANGING and box.top > 0.08:
                shift = min(0.06, 0.02 + 0.05 * box.top)
                outline = rounded(footprint(box), _radius(piece, box))
                canvas.fill_mask(mask, [(x + shift, y - shift) for x, y in outline])
    soft = softened(mask, 0.035 * canvas.scale)
    canvas.blend(SHADOW, (soft * 0.34).astype(np.uint8))


def draw_furniture(canvas: Canvas, home: Home) -> None:
    """Draw every piece, the low ones first, and what hangs above last."""
    pieces = _pieces(home)
    standing = [p for p in pieces if min(box.bottom for box in p.boxes) < HANGING]
    hanging = [p for p in pieces if min(box.bottom for box in p.boxes) >= HANGING]
    for piece in sorted(standing, key=_height):
        for box in sorted(piece.boxes, key=lambda box: box.top):
            _draw_box(canvas, piece, box)
    for piece in hanging:
        _draw_hanging(canvas, piece)


def pieces_at_first(home: Home) -> list[Furniture]:
    """Return all furniture, and what moves as a piece where it stands before its first move."""
    moving = (t for t in home.moving if t.is_present and t.kind is not MovingKind.DOOR)
    return [*home.furniture, *(Furniture(t.name, "", t.pose, t.first_boxes, True) for t in moving)]


def _pieces(home: Home) -> list[Furniture]:
    pieces = pieces_at_first(home)
    return [p for p in pieces if p.kind not in FIXTURES and p.kind != STATION_KIND]


def _height(piece: Furniture) -> float:
    """Return the height of a piece's widest part, m: a chair's seat goes under the table."""
    return max(piece.boxes, key=lambda box: box.length * box.width).top


def _radius(piece: Furniture, box: Box) -> float:
    half = min(box.length, box.width) / 2.0
    if piece.kind in ROUND_KINDS:
        return 0.98 * half
    roundness = ROUNDNESS.get((piece.kind, box.material))
    if roundness is not None:
        return 0.98 * roundness * half
    soft = MATERIALS[box.material].texture == "fabric"
    return min(0.06 if soft else 0.015, 0.6 * half)


def _draw_box(canvas: Canvas, piece: Furniture, box: Box) -> None:
    material = MATERIALS[box.material]
    colour = mixed(material.rgb, WHITE, 0.22)
    outline = rounded(footprint(box), _radius(piece, box))
    canvas.fill(outline, colour)
    if min(box.length, box.width) > 0.02:
        canvas.line(outline, mixed(colour, INK, 0.45), 0.008, closed=True)


def _draw_hanging(canvas: Canvas, piece: Furniture) -> None:
    """A tint and an outline: the floor below is free."""
    mask = canvas.mask()
    for box in piece.boxes:
        canvas.fill_mask(mask, rounded(footprint(box), 0.01))
    canvas.blend(WHITE, (mask * 0.25).astype(np.uint8))
    # Only the contour of all boxes together: what hangs there matters little.
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(canvas.pixels, contours, -1, mixed(INK, WHITE, 0.45), 2, cv2.LINE_AA)
