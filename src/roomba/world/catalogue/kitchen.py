"""Kitchen units, and the appliances that look like one of them."""

from __future__ import annotations

from roomba.world.catalogue.parts import FurnitureKind, Size, block, fronts
from roomba.world.home.home import Box

WORKTOP = 0.04
PLINTH = 0.10


def _base(size: Size, finish: str) -> list[Box]:
    """Plinth, carcass and worktop: what all units of a kitchen share."""
    return [
        block(
            (-size.front, size.front - 0.07), (-size.side, size.side), (0.0, PLINTH), "metal_dark"
        ),
        block(
            (-size.front, size.front - 0.02),
            (-size.side, size.side),
            (PLINTH, size.height - WORKTOP),
            finish,
        ),
        block(
            (-size.front, size.front + 0.01),
            (-size.side, size.side),
            (size.height - WORKTOP, size.height),
            "worktop",
        ),
    ]


def _counter(size: Size, finish: str) -> list[Box]:
    """A drawer above doors."""
    drawer = size.height - WORKTOP - 0.16
    return [
        *_base(size, finish),
        *fronts(size, (PLINTH, drawer), 0.5, finish, "steel"),
        *fronts(size, (drawer, size.height - WORKTOP), 0.5, finish, "steel", upright_handles=False),
    ]


def _sink_unit(size: Size, finish: str) -> list[Box]:
    """Doors, a steel basin sunk into the worktop, and a tap that stands behind it."""
    top, half = size.height, min(0.24, size.side - 0.05)
    tap = -size.front + 0.08
    return [
        *_base(size, finish),
        *fronts(size, (PLINTH, top - WORKTOP), 0.5, finish, "steel"),
        block((-0.16, 0.20), (-half, half), (top, top + 0.008), "steel"),
        block((-0.13, 0.17), (-half + 0.03, half - 0.03), (top, top + 0.010), "metal_dark"),
        block((tap - 0.02, tap + 0.02), (-0.02, 0.02), (top, top + 0.26), "steel"),
        block((tap - 0.02, tap + 0.20), (-0.015, 0.015), (top + 0.24, top + 0.27), "steel"),
    ]


def _stove(size: Size, finish: str) -> list[Box]:
    """An oven with a window, a handle and knobs, below a hob with four plates."""
    top, front = size.height, size.front
    side = size.side - 0.01
    plates = [
        block(
            (x - radius, x + radius),
            (y - radius, y + radius),
            (top + 0.012, top + 0.018),
            "metal_dark",
        )
        for x, y, radius in (
            (-0.12, -0.13, 0.09),
            (-0.12, 0.14, 0.07),
            (0.14, -0.14, 0.07),
            (0.14, 0.13, 0.09),
        )
    ]
    knobs = [
        block((front - 0.01, front + 0.02), (y - 0.02, y + 0.02), (top - 0.12, top - 0.08), "black")
        for y in (-0.21, -0.09, 0.09, 0.21)
    ]
    return [
        *_base(size, finish),
        block((front - 0.02, front - 0.008), (-side, side), (PLINTH + 0.01, top - 0.16), "steel"),
        block(
            (front - 0.008, front), (-side + 0.07, side - 0.07), (0.24, top - 0.30), "glass_dark"
        ),
        block(
            (front - 0.008, front + 0.03),
            (-side + 0.05, side - 0.05),
            (top - 0.23, top - 0.20),
            "metal",
        ),
        block((front - 0.02, front - 0.008), (-side, side), (top - 0.15, top - WORKTOP), "steel"),
        *knobs,
        block((-0.25, 0.26), (-side + 0.01, side - 0.01), (top, top + 0.012), "glass_dark"),
        *plates,
    ]


def _fridge(size: Size, finish: str) -> list[Box]:
    """A freezer below a fridge, long handles on the left."""
    front, side, split = size.front, size.side, size.height * 0.36
    doors = [
        block(
            (front - 0.03, front),
            (-side + 0.004, side - 0.004),
            (low + 0.005, high - 0.005),
            finish,
        )
        for low, high in ((0.06, split), (split, size.height))
    ]
    handles = [
        block((front, front + 0.035), (side - 0.08, side - 0.05), limits, "metal_dark")
        for limits in ((split - 0.36, split - 0.06), (split + 0.06, split + 0.56))
    ]
    return [
        block((-size.front, front - 0.06), (-side, side), (0.0, 0.06), "metal_dark"),
        block((-size.front, front - 0.03), (-side, side), (0.06, size.height), "grey"),
        *doors,
        *handles,
    ]


def _wall_cupboard(size: Size, finish: str) -> list[Box]:
    """Hangs: its bottom is 1.40 m above the floor, ``height`` is its own."""
    low, high = 1.40, 1.40 + size.height
    return [
        block((-size.front, size.front - 0.02), (-size.side, size.side), (low, high), finish),
        *fronts(size, (low, high), 0.5, finish, "steel"),
    ]


def _washing_machine(size: Size, finish: str) -> list[Box]:
    front, side, top = size.front, size.side, size.height
    return [
        block((-front, front - 0.02), (-side, side), (0.0, top), finish),
        block((front - 0.02, front - 0.015), (-side, side), (top - 0.14, top - 0.02), "grey"),
        block(
            (front - 0.015, front - 0.005),
            (side - 0.2, side - 0.04),
            (top - 0.11, top - 0.05),
            "white",
        ),
        block((front - 0.02, front - 0.01), (-0.21, 0.21), (0.21, 0.63), "metal"),
        block((front - 0.01, front), (-0.16, 0.16), (0.26, 0.58), "glass_dark"),
    ]


KITCHEN = {
    "kitchen_counter": FurnitureKind(Size(0.9, 0.6, 0.91), "cream", _counter),
    "sink_unit": FurnitureKind(Size(0.8, 0.6, 0.91), "cream", _sink_unit),
    "stove": FurnitureKind(Size(0.6, 0.6, 0.91), "steel", _stove),
    "fridge": FurnitureKind(Size(0.6, 0.65, 1.85), "steel", _fridge),
    "wall_cupboard": FurnitureKind(Size(0.9, 0.34, 0.65), "cream", _wall_cupboard),
    "washing_machine": FurnitureKind(Size(0.6, 0.6, 0.85), "white", _washing_machine),
}
"""Kitchen units and appliances by kind."""
