"""Plants, lamps and small things, and what is part of a wall: windows, pictures, the front door."""

from __future__ import annotations

from roomba.world.catalogue.parts import FurnitureKind, Size, block, post
from roomba.world.home.home import Box

PROUD = 0.004
"""m; how far a fixture stands out of its wall: seen, yet too thin to make a floor cell solid."""


def _plant(size: Size, pot: str) -> list[Box]:
    """A pot, a stem, and a crown of blocks that narrows upwards."""
    radius = min(size.front, size.side)
    low = 0.30 + 0.1 * (size.height - 0.30)
    boxes = [
        post(0.0, 0.0, 1.30 * radius, (0.0, 0.26), pot),
        post(0.0, 0.0, 1.45 * radius, (0.26, 0.31), pot),
        post(0.0, 0.0, 1.30 * radius, (0.31, 0.312), "soil"),
        post(0.0, 0.0, 0.05, (0.31, size.height * 0.7), "wood_dark"),
    ]
    crown = (
        (0.0, 0.0, 1.3, 0.25, 0.70, "leaf"),
        (0.45, 0.25, 1.0, 0.10, 0.50, "leaf_light"),
        (-0.40, 0.35, 1.0, 0.20, 0.62, "leaf"),
        (-0.20, -0.45, 1.05, 0.00, 0.45, "leaf_light"),
        (0.35, -0.40, 0.95, 0.30, 0.75, "leaf"),
        (0.0, 0.05, 0.8, 0.70, 1.00, "leaf_light"),
    )
    span = size.height - low
    for x, y, width, bottom, top, leaf in crown:
        boxes.append(
            post(
                x * radius,
                y * radius,
                width * radius,
                (low + bottom * span, low + top * span),
                leaf,
            )
        )
    return boxes


def _lamp(size: Size, metal: str) -> list[Box]:
    shade = min(size.front, size.side)
    return [
        post(0.0, 0.0, 0.28, (0.0, 0.03), metal),
        post(0.0, 0.0, 0.03, (0.03, size.height - 0.28), metal),
        post(0.0, 0.0, 2.0 * shade, (size.height - 0.30, size.height), "lamp_shade"),
    ]


def _box(size: Size, finish: str) -> list[Box]:
    top = size.height
    return [
        block((-size.front, size.front), (-size.side, size.side), (0.0, top), finish),
        block((-size.front, size.front), (-0.025, 0.025), (top, top + 0.002), "cream"),
    ]


def _toy(size: Size, colour: str) -> list[Box]:
    """A toy lorry: load, cabin, wheels."""
    front, side, top = size.front, size.side, size.height
    wheels = [
        block((x - 0.03, x + 0.03), (y - 0.01, y + 0.01), (0.0, 0.06), "black")
        for x in (-0.6 * front, 0.6 * front)
        for y in (-side + 0.01, side - 0.01)
    ]
    return [
        *wheels,
        block((-front, front), (-side + 0.01, side - 0.01), (0.03, 0.07), "grey"),
        block((-front, 0.3 * front), (-side, side), (0.07, 0.75 * top), colour),
        block((0.4 * front, front), (-side, side), (0.07, top), "yellow"),
        block(
            (front - 0.03, front + 0.002),
            (-side + 0.02, side - 0.02),
            (0.65 * top, 0.9 * top),
            "glass_dark",
        ),
    ]


def _bag(size: Size, fabric: str) -> list[Box]:
    front, side, top = size.front, size.side, size.height * 0.75
    return [
        block((-front, front), (-side, side), (0.0, top), fabric),
        block((front, front + 0.04), (-0.6 * side, 0.6 * side), (0.04, 0.55 * top), fabric),
        block((-0.015, 0.015), (0.3 * side, 0.4 * side), (top, size.height), "black"),
        block((-0.015, 0.015), (-0.4 * side, -0.3 * side), (top, size.height), "black"),
        block(
            (-0.015, 0.015), (-0.4 * side, 0.4 * side), (size.height - 0.02, size.height), "black"
        ),
    ]


def _waste_bin(size: Size, finish: str) -> list[Box]:
    front, side, top = size.front, size.side, size.height
    return [
        block((-front, front), (-side, side), (0.0, top - 0.05), finish),
        block(
            (-front - 0.01, front + 0.01), (-side - 0.01, side + 0.01), (top - 0.05, top), "black"
        ),
        block((front, front + 0.05), (-0.05, 0.05), (0.0, 0.03), "black"),
    ]


def _shoes(size: Size, colour: str) -> list[Box]:
    boxes: list[Box] = []
    for y in (-0.5 * size.side, 0.5 * size.side):
        half = 0.4 * size.side
        boxes += [
            block((-size.front, size.front), (y - half, y + half), (0.0, 0.03), "white"),
            block((-size.front, size.front), (y - half, y + half), (0.03, 0.06), colour),
            block((-size.front, 0.0), (y - half, y + half), (0.06, size.height), colour),
        ]
    return boxes


def _coat_rack(size: Size, wood: str) -> list[Box]:
    """A board with coats on it, 0.75 m and more above the floor."""
    back, front, top = -size.front, size.front, size.height
    coats = [
        block((back + 0.02, front), (y - 0.16, y + 0.16), (top - length, top - 0.12), fabric)
        for y, length, fabric in (
            (-0.5 * size.side, 0.95, "fabric_green"),
            (0.5 * size.side, 0.80, "fabric_red"),
        )
    ]
    return [block((back, back + 0.02), (-size.side, size.side), (top - 0.12, top), wood), *coats]


def _window(size: Size, frame: str) -> list[Box]:
    """In a wall as thick as ``depth``, its front the wall's face; sill at 0.9 m, own ``height``."""
    low, high, face = 0.9, 0.9 + size.height, size.front
    behind = (-size.front, face + PROUD)
    glass = (-size.front, face + PROUD / 2.0)
    side = size.side
    boxes = [
        block(glass, (-side + 0.05, side - 0.05), (low + 0.05, high - 0.05), "glass"),
        block(behind, (-side, side), (high - 0.05, high), frame),
        block((-size.front, face + 0.08), (-side - 0.03, side + 0.03), (low, low + 0.05), frame),
        block(behind, (side - 0.05, side), (low, high), frame),
        block(behind, (-side, -side + 0.05), (low, high), frame),
    ]
    if size.width > 0.9:
        boxes.append(block(behind, (-0.03, 0.03), (low, high), frame))
    return boxes


def _front_door(size: Size, wood: str) -> list[Box]:
    """A shut door in a wall as thick as ``depth``, its front the wall's inner face."""
    face, side, top = size.front, size.side, size.height
    behind = (-size.front, face + PROUD)
    leaf = (-size.front, face + PROUD / 2.0)
    panels = [
        block((-size.front, face + 0.75 * PROUD), y, z, "wood_dark")
        for y in ((0.06, side - 0.16), (-side + 0.16, -0.06))
        for z in ((0.20, 0.85), (1.05, top - 0.25))
    ]
    return [
        block(leaf, (-side + 0.06, side - 0.06), (0.0, top - 0.06), wood),
        *panels,
        block(behind, (side - 0.06, side), (0.0, top), "door_frame"),
        block(behind, (-side, -side + 0.06), (0.0, top), "door_frame"),
        block(behind, (-side, side), (top - 0.06, top), "door_frame"),
        block((face, face + 0.05), (side - 0.24, side - 0.11), (1.00, 1.03), "steel"),
    ]


def _picture(size: Size, frame: str) -> list[Box]:
    """Hangs with its middle 1.5 m above the floor."""
    back, front, side = -size.front, size.front, size.side
    low, high = 1.5 - size.height / 2.0, 1.5 + size.height / 2.0
    middle = low + 0.45 * size.height
    inner = (-side + 0.04, side - 0.04)
    return [
        block((back, front), (-side, side), (low, high), frame),
        block((back, front + 0.002), inner, (middle, high - 0.04), "blue"),
        block((back, front + 0.002), inner, (low + 0.04, middle), "leaf"),
        block(
            (back, front + 0.003),
            (0.1 * side, 0.5 * side),
            (middle + 0.05, middle + 0.14),
            "yellow",
        ),
    ]


def _low(size: Size, finish: str) -> list[Box]:
    """A cable or a sill: what lies along the floor."""
    return [block((-size.front, size.front), (-size.side, size.side), (0.0, size.height), finish)]


THINGS = {
    "cable": FurnitureKind(Size(0.6, 0.06, 0.05), "black", _low),
    "sill": FurnitureKind(Size(0.8, 0.05, 0.05), "wood_dark", _low),
    "plant": FurnitureKind(Size(0.42, 0.42, 1.2), "pot", _plant),
    "lamp": FurnitureKind(Size(0.36, 0.36, 1.6), "metal_dark", _lamp),
    "box": FurnitureKind(Size(0.40, 0.30, 0.28), "cardboard", _box),
    "toy": FurnitureKind(Size(0.14, 0.30, 0.16), "red", _toy),
    "bag": FurnitureKind(Size(0.32, 0.18, 0.42), "fabric_red", _bag),
    "waste_bin": FurnitureKind(Size(0.26, 0.26, 0.55), "steel", _waste_bin),
    "shoes": FurnitureKind(Size(0.24, 0.28, 0.11), "blue", _shoes),
    "coat_rack": FurnitureKind(Size(0.9, 0.16, 1.75), "wood", _coat_rack),
    "window": FurnitureKind(Size(1.4, 0.2, 1.25), "white", _window),
    "front_door": FurnitureKind(Size(1.0, 0.2, 2.08), "wood", _front_door),
    "picture": FurnitureKind(Size(0.7, 0.03, 0.5), "wood_light", _picture),
}
"""Things and fixtures of walls by kind."""

LOW_KINDS = frozenset({"cable", "sill"})
"""Kinds that the lidar looks over and the body does not pass: what is only felt."""

FIXTURES = frozenset({"window", "front_door", "picture"})
"""Kinds that are part of a wall: what stands there is a wall still."""
