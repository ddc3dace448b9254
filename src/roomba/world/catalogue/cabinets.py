"""Tables and cabinets: desk, wardrobe, bookshelf, TV bench and the like."""

from __future__ import annotations

from roomba.world.catalogue.parts import FurnitureKind, Size, block, columns, fronts, legs
from roomba.world.home.home import Box

BOOK_COLOURS = ("red", "blue", "cream", "green", "orange", "grey", "yellow")


def _table(size: Size, wood: str) -> list[Box]:
    apron = 0.08
    inset = 0.04
    return [
        *legs(size, 0.05, size.height - 0.03, wood, inset=inset),
        block(
            (-size.front + 0.06, size.front - 0.06),
            (-size.side + 0.06, size.side - 0.06),
            (size.height - 0.03 - apron, size.height - 0.03),
            wood,
        ),
        block(
            (-size.front, size.front),
            (-size.side, size.side),
            (size.height - 0.03, size.height),
            wood,
        ),
    ]


def _coffee_table(size: Size, wood: str) -> list[Box]:
    top = size.height
    return [
        *_table(size, wood),
        block((-0.14, 0.06), (-0.28, -0.02), (top, top + 0.02), "cream"),
        block((-0.02, 0.10), (0.14, 0.26), (top, top + 0.10), "ceramic"),
    ]


def _desk(size: Size, wood: str) -> list[Box]:
    """The person sits at its front; the drawers are to the left, the screen is at the back."""
    drawers = (size.side - 0.42, size.side - 0.02)
    front, back, top = size.front, -size.front, size.height
    boxes = [
        block((back, front), (-size.side, -size.side + 0.03), (0.0, top - 0.03), "white"),
        block((back, front - 0.03), drawers, (0.04, top - 0.03), "white"),
        block((back + 0.03, front - 0.05), drawers, (0.0, 0.04), "grey"),
        block((back, front), (-size.side, size.side), (top - 0.03, top), wood),
        block((back + 0.18, back + 0.38), (-0.15, 0.15), (top, top + 0.015), "metal"),
        block((back + 0.20, back + 0.23), (-0.03, 0.03), (top, top + 0.20), "metal"),
        block((back + 0.23, back + 0.26), (-0.31, 0.31), (top + 0.12, top + 0.48), "screen"),
        block((front - 0.26, front - 0.12), (-0.22, 0.22), (top, top + 0.02), "cream"),
    ]
    height = (top - 0.07) / 3.0
    for row in range(3):
        low = 0.04 + row * height
        boxes.append(
            block(
                (front - 0.03, front - 0.01), drawers, (low + 0.006, low + height - 0.006), "white"
            )
        )
        middle = (drawers[0] + drawers[1]) / 2.0
        boxes.append(
            block(
                (front - 0.01, front + 0.01),
                (middle - 0.07, middle + 0.07),
                (low + height - 0.07, low + height - 0.055),
                "metal_dark",
            )
        )
    return boxes


def _cabinet(size: Size, finish: str, column: float, rows: int, handle: str) -> list[Box]:
    """A closed cabinet on a plinth: a carcass, and rows of doors or drawers."""
    plinth = 0.06
    boxes = [
        block(
            (-size.front, size.front - 0.05), (-size.side, size.side), (0.0, plinth), "metal_dark"
        ),
        block(
            (-size.front, size.front - 0.02),
            (-size.side, size.side),
            (plinth, size.height - 0.02),
            finish,
        ),
        block(
            (-size.front, size.front),
            (-size.side, size.side),
            (size.height - 0.02, size.height),
            finish,
        ),
    ]
    height = (size.height - 0.02 - plinth) / rows
    for row in range(rows):
        limits = (plinth + row * height, plinth + (row + 1) * height)
        boxes += fronts(size, limits, column, finish, handle, upright_handles=rows == 1)
    return boxes


def _nightstand(size: Size, wood: str) -> list[Box]:
    top = size.height
    return [
        *_cabinet(size, wood, 0.6, 2, "brass"),
        block((-0.05, 0.05), (-0.05, 0.05), (top, top + 0.02), "brass"),
        block((-0.012, 0.012), (-0.012, 0.012), (top + 0.02, top + 0.18), "brass"),
        block((-0.09, 0.09), (-0.09, 0.09), (top + 0.18, top + 0.34), "lamp_shade"),
    ]


def _wardrobe(size: Size, wood: str) -> list[Box]:
    return _cabinet(size, wood, 0.5, 1, "metal")


def _sideboard(size: Size, wood: str) -> list[Box]:
    return _cabinet(size, wood, 0.55, 1, "brass")


def _shoe_cabinet(size: Size, finish: str) -> list[Box]:
    top = size.height
    return [
        *_cabinet(size, finish, 0.8, 2, "metal"),
        block((-0.06, 0.06), (0.08, 0.22), (top, top + 0.05), "wood"),
    ]


def _bookshelf(size: Size, wood: str) -> list[Box]:
    """Open shelves with rows of books of seven colours; each row ends in a gap."""
    board = 0.025
    back, front = -size.front, size.front
    levels = max(2, round(size.height / 0.36))
    step = (size.height - board - 0.06) / levels
    boxes = [
        block((back, front), (-size.side, -size.side + board), (0.0, size.height), wood),
        block((back, front), (size.side - board, size.side), (0.0, size.height), wood),
        block((back, back + 0.01), (-size.side, size.side), (0.0, size.height), wood),
        block((back, front - 0.02), (-size.side, size.side), (0.0, 0.06), wood),
    ]
    for level in range(levels + 1):
        z = 0.06 + level * step
        boxes.append(block((back, front), (-size.side, size.side), (z, z + board), wood))
        if level == levels:
            break
        usable = Size(size.width - 2 * board, size.depth, size.height)
        for index, (right, left) in enumerate(columns(usable, 0.11)[: -1 - level % 2]):
            number = index * 3 + level * 5
            height = (0.62 + 0.05 * (number % 5)) * step
            boxes.append(
                block(
                    (back + 0.02, front - 0.04 - 0.01 * (number % 3)),
                    (right + 0.002, left - 0.002),
                    (z + board, z + height),
                    BOOK_COLOURS[number % len(BOOK_COLOURS)],
                )
            )
    return boxes


def _tv_bench(size: Size, wood: str) -> list[Box]:
    """A low bench with a television on it; ``height`` is that of the bench."""
    top = size.height
    half = min(0.62, size.side - 0.05)
    return [
        *_cabinet(size, wood, 0.5, 1, "metal_dark"),
        block((-0.12, 0.12), (-0.25, 0.25), (top, top + 0.02), "black"),
        block((-0.04, 0.0), (-0.05, 0.05), (top + 0.02, top + 0.10), "black"),
        block((-0.03, 0.0), (-half, half), (top + 0.08, top + 0.08 + 1.18 * half), "black"),
        block(
            (0.0, 0.006),
            (-half + 0.02, half - 0.02),
            (top + 0.10, top + 0.06 + 1.18 * half),
            "screen",
        ),
    ]


CABINETS = {
    "coffee_table": FurnitureKind(Size(1.1, 0.6, 0.42), "wood", _coffee_table),
    "dining_table": FurnitureKind(Size(1.5, 0.85, 0.75), "wood", _table),
    "table": FurnitureKind(Size(0.75, 0.75, 0.75), "wood_light", _table),
    "desk": FurnitureKind(Size(1.4, 0.7, 0.74), "wood_light", _desk),
    "nightstand": FurnitureKind(Size(0.45, 0.40, 0.48), "wood", _nightstand),
    "wardrobe": FurnitureKind(Size(2.0, 0.6, 2.1), "white", _wardrobe),
    "sideboard": FurnitureKind(Size(1.6, 0.42, 0.78), "wood", _sideboard),
    "shoe_cabinet": FurnitureKind(Size(0.9, 0.30, 0.95), "white", _shoe_cabinet),
    "bookshelf": FurnitureKind(Size(0.9, 0.32, 1.9), "wood_dark", _bookshelf),
    "tv_bench": FurnitureKind(Size(1.5, 0.40, 0.45), "wood_dark", _tv_bench),
}
"""Tables and cabinets by kind."""
