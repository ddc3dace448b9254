"""Bathroom fittings."""

from __future__ import annotations

from roomba.world.catalogue.parts import FurnitureKind, Size, block, post
from roomba.world.home.home import Box


def _toilet(size: Size, finish: str) -> list[Box]:
    """Cistern at the back, bowl and lid before it."""
    back, front, side = -size.front, size.front, size.side
    return [
        block((back + 0.05, front - 0.16), (-0.11, 0.11), (0.0, 0.20), finish),
        block((back + 0.17, front - 0.06), (-0.15, 0.15), (0.14, 0.36), finish),
        block((back + 0.17, front), (-side, side), (0.34, 0.40), finish),
        block((back + 0.19, front - 0.01), (-side + 0.01, side - 0.01), (0.40, 0.43), "white"),
        block((back, back + 0.17), (-side - 0.01, side + 0.01), (0.38, size.height), finish),
        block(
            (back + 0.06, back + 0.11), (-0.04, 0.04), (size.height, size.height + 0.012), "steel"
        ),
    ]


def _washbasin(size: Size, finish: str) -> list[Box]:
    """A basin on a small cabinet, its tap, and a mirror above."""
    back, front, side, top = -size.front, size.front, size.side, size.height
    return [
        block((back, front - 0.08), (-side + 0.04, side - 0.04), (0.0, 0.06), "metal_dark"),
        block((back, front - 0.04), (-side + 0.02, side - 0.02), (0.06, top - 0.14), "wood_light"),
        block(
            (front - 0.04, front - 0.02), (-0.005, side - 0.03), (0.08, top - 0.16), "wood_light"
        ),
        block(
            (front - 0.04, front - 0.02), (-side + 0.03, -0.011), (0.08, top - 0.16), "wood_light"
        ),
        block((front - 0.02, front), (0.03, 0.05), (0.4, 0.6), "steel"),
        block((front - 0.02, front), (-0.05, -0.03), (0.4, 0.6), "steel"),
        block((back, front), (-side, side), (top - 0.14, top), finish),
        block(
            (back + 0.12, front - 0.05), (-side + 0.06, side - 0.06), (top, top + 0.004), "water"
        ),
        block((back + 0.04, back + 0.08), (-0.02, 0.02), (top, top + 0.16), "steel"),
        block((back + 0.04, back + 0.18), (-0.015, 0.015), (top + 0.13, top + 0.16), "steel"),
        block((back, back + 0.02), (-side + 0.02, side - 0.02), (1.15, 1.95), "glass"),
    ]


def _bathtub(size: Size, finish: str) -> list[Box]:
    """Panelled to the floor, with a tap at its right end; the water is seen from above only."""
    front, side, top = size.front, size.side, size.height
    rim = 0.07
    return [
        block((-front, front), (-side, side), (0.0, top - 0.04), "white"),
        block((-front, -front + rim), (-side, side), (top - 0.04, top), finish),
        block((front - rim, front), (-side, side), (top - 0.04, top), finish),
        block((-front + rim, front - rim), (side - 0.12, side), (top - 0.04, top), finish),
        block((-front + rim, front - rim), (-side, -side + 0.12), (top - 0.04, top), finish),
        block(
            (-front + rim, front - rim),
            (-side + 0.12, side - 0.12),
            (top - 0.04, top - 0.03),
            "water",
        ),
        block((-0.03, 0.03), (-side + 0.02, -side + 0.06), (top, top + 0.16), "steel"),
        block((-0.015, 0.015), (-side + 0.02, -side + 0.20), (top + 0.13, top + 0.16), "steel"),
    ]


def _shower(size: Size, finish: str) -> list[Box]:
    """A raised tray with glass on its left, a rail and a rose at the back."""
    back, front, side = -size.front, size.front, size.side
    return [
        block((back, front), (-side, side), (0.0, 0.14), finish),
        block((back, front), (side - 0.015, side), (0.14, size.height), "glass"),
        post(front - 0.02, side - 0.02, 0.03, (0.14, size.height), "steel"),
        block((back + 0.03, back + 0.05), (-0.012, 0.012), (0.9, 2.1), "steel"),
        block((back + 0.05, back + 0.30), (-0.012, 0.012), (2.06, 2.09), "steel"),
        block((back + 0.22, back + 0.42), (-0.10, 0.10), (2.02, 2.05), "steel"),
        block((-0.05, 0.05), (-0.05, 0.05), (0.14, 0.144), "steel"),
    ]


def _towel_radiator(size: Size, finish: str) -> list[Box]:
    """Hangs on the wall from 0.3 m up, a towel over it."""
    back, front, side = -size.front, size.front, size.side
    bars = [
        block((back, front), (-side, side), (z / 100.0, z / 100.0 + 0.03), finish)
        for z in range(32, round(size.height * 100), 14)
    ]
    return [
        block((back, front - 0.02), (side - 0.03, side), (0.3, size.height), finish),
        block((back, front - 0.02), (-side, -side + 0.03), (0.3, size.height), finish),
        *bars,
        block((back, front + 0.02), (-side + 0.06, side - 0.10), (0.62, 1.12), "fabric_blue"),
    ]


BATHROOM = {
    "toilet": FurnitureKind(Size(0.38, 0.66, 0.78), "ceramic", _toilet),
    "washbasin": FurnitureKind(Size(0.75, 0.48, 0.86), "ceramic", _washbasin),
    "bathtub": FurnitureKind(Size(1.7, 0.75, 0.56), "ceramic", _bathtub),
    "shower": FurnitureKind(Size(0.9, 0.9, 2.0), "ceramic", _shower),
    "towel_radiator": FurnitureKind(Size(0.5, 0.08, 1.3), "white", _towel_radiator),
}
"""Bathroom fittings by kind."""
