"""Building blocks of the catalogue: sizes, blocks, legs, and kinds made of them.

A piece is described in its own frame, m: the middle of its footprint is the origin, x points out
of its front, y to its left, z up from the floor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from roomba.world.home.home import Box

Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Size:
    """Outer measures of a piece, m: across its front, from front to back, and up."""

    width: float
    depth: float
    height: float

    @property
    def front(self) -> float:
        """x of the front; the back is at minus this."""
        return self.depth / 2.0

    @property
    def side(self) -> float:
        """y of the left side; the right one is at minus this."""
        return self.width / 2.0


@dataclass(frozen=True, slots=True)
class FurnitureKind:
    """An entry of the catalogue: default size, main material, and how it is built of both."""

    size: Size
    material: str
    build: Callable[[Size, str], list[Box]]


def block(x: Range, y: Range, z: Range, material: str) -> Box:
    """Return the upright cuboid between the given limits, low to high, m, in the piece's frame.

    Sizes that leave nothing between the limits give a box without extent, which the caller must
    refuse.
    """
    return Box(
        (x[0] + x[1]) / 2.0,
        (y[0] + y[1]) / 2.0,
        0.0,
        x[1] - x[0],
        y[1] - y[0],
        z[0],
        z[1],
        material,
    )


def post(x: float, y: float, thickness: float, z: Range, material: str) -> Box:
    """Return a square post around a point."""
    half = thickness / 2.0
    return block((x - half, x + half), (y - half, y + half), z, material)


def legs(size: Size, thickness: float, top: float, material: str, inset: float = 0.0) -> list[Box]:
    """Return four legs in the corners of a footprint, ``inset`` from its border, up to ``top``."""
    x = size.front - inset - thickness / 2.0
    y = size.side - inset - thickness / 2.0
    return [
        post(sign_x * x, sign_y * y, thickness, (0.0, top), material)
        for sign_x in (-1.0, 1.0)
        for sign_y in (-1.0, 1.0)
    ]


def columns(size: Size, wanted_width: float) -> list[Range]:
    """Return the y limits of equal columns, each about ``wanted_width`` wide: doors, drawers."""
    count = max(1, round(size.width / wanted_width))
    step = size.width / count
    return [(-size.side + i * step, -size.side + (i + 1) * step) for i in range(count)]


def fronts(
    size: Size,
    z: Range,
    wanted_width: float,
    material: str,
    handle: str,
    upright_handles: bool = True,
) -> list[Box]:
    """Return doors or drawer fronts side by side on the front, with gaps between, and handles.

    They reach 1 cm out of ``size`` minus 2 cm, so that a carcass of ``depth - 0.02`` shows gaps.
    """
    boxes: list[Box] = []
    gap = 0.006
    middle = (z[0] + z[1]) / 2.0
    for index, (right, left) in enumerate(columns(size, wanted_width)):
        boxes.append(
            block(
                (size.front - 0.02, size.front - 0.005),
                (right + gap, left - gap),
                (z[0] + gap, z[1] - gap),
                material,
            )
        )
        if upright_handles:
            y = left - 0.04 if index % 2 == 0 else right + 0.04
            reach = min(0.12, (z[1] - z[0]) / 4.0)
            handle_y, handle_z = (y - 0.008, y + 0.008), (middle - reach, middle + reach)
        else:
            y, reach = (right + left) / 2.0, min(0.09, (left - right) / 4.0)
            top = z[1] - min(0.05, (z[1] - z[0]) / 2.0)
            handle_y, handle_z = (y - reach, y + reach), (top - 0.008, top + 0.008)
        boxes.append(block((size.front - 0.005, size.front + 0.012), handle_y, handle_z, handle))
    return boxes
