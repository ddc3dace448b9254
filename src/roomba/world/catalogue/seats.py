"""Seats and beds: sofa, armchair, chairs, bed."""

from __future__ import annotations

from roomba.world.catalogue.parts import FurnitureKind, Size, block, columns, legs, post
from roomba.world.home.home import Box


def _sofa(size: Size, fabric: str) -> list[Box]:
    arm, back, seat = 0.18, 0.20, 0.42
    cushions = [
        block(
            (-size.front + back, size.front),
            (right + 0.005, left - 0.005),
            (0.26, seat),
            fabric,
        )
        for right, left in columns(Size(size.width - 2 * arm, size.depth, seat), 0.75)
    ]
    pillows = [
        block(
            (-size.front + back, -size.front + back + 0.14),
            (y - 0.21, y + 0.21),
            (seat, seat + 0.30),
            pillow,
        )
        for y, pillow in (
            (size.side - arm - 0.24, "fabric_mustard"),
            (-size.side + arm + 0.24, "linen"),
        )
    ]
    return [
        *legs(size, 0.05, 0.06, "wood_dark", inset=0.04),
        block((-size.front, size.front), (-size.side, size.side), (0.06, 0.26), fabric),
        block(
            (-size.front, -size.front + back), (-size.side, size.side), (0.26, size.height), fabric
        ),
        block((-size.front, size.front), (size.side - arm, size.side), (0.26, 0.60), fabric),
        block((-size.front, size.front), (-size.side, -size.side + arm), (0.26, 0.60), fabric),
        *cushions,
        *pillows,
    ]


def _armchair(size: Size, fabric: str) -> list[Box]:
    arm, back, seat = 0.12, 0.16, 0.42
    return [
        *legs(size, 0.05, 0.16, "wood", inset=0.02),
        block((-size.front, size.front), (-size.side, size.side), (0.16, 0.28), fabric),
        block(
            (-size.front + back, size.front),
            (-size.side + arm, size.side - arm),
            (0.28, seat),
            fabric,
        ),
        block(
            (-size.front, -size.front + back), (-size.side, size.side), (0.28, size.height), fabric
        ),
        block((-size.front, size.front), (size.side - arm, size.side), (0.28, 0.58), fabric),
        block((-size.front, size.front), (-size.side, -size.side + arm), (0.28, 0.58), fabric),
    ]


def _chair(size: Size, wood: str) -> list[Box]:
    seat, leg = 0.45, 0.035
    back = (-size.front, -size.front + leg)
    return [
        *legs(size, leg, seat - 0.03, wood),
        block((-size.front, size.front), (-size.side, size.side), (seat - 0.03, seat), wood),
        block(back, (size.side - leg, size.side), (seat, size.height), wood),
        block(back, (-size.side, -size.side + leg), (seat, size.height), wood),
        block(back, (-size.side, size.side), (size.height - 0.10, size.height), wood),
        block(back, (-size.side, size.side), (size.height - 0.24, size.height - 0.17), wood),
    ]


def _stool(size: Size, wood: str) -> list[Box]:
    return [
        *legs(size, 0.035, size.height - 0.03, wood),
        block(
            (-size.front, size.front),
            (-size.side, size.side),
            (size.height - 0.03, size.height),
            wood,
        ),
    ]


def _office_chair(size: Size, fabric: str) -> list[Box]:
    half = 0.27
    seat_x = (-0.22, 0.24)
    return [
        block((-half, half), (-0.03, 0.03), (0.05, 0.09), "metal_dark"),
        block((-0.03, 0.03), (-half, half), (0.05, 0.09), "metal_dark"),
        *(
            post(x, y, 0.05, (0.0, 0.06), "black")
            for x, y in ((half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half))
        ),
        post(0.0, 0.0, 0.06, (0.09, 0.42), "metal"),
        block(seat_x, (-0.23, 0.23), (0.42, 0.50), fabric),
        block((-0.27, -0.22), (-0.03, 0.03), (0.46, 0.66), "metal_dark"),
        block((-0.30, -0.24), (-0.22, 0.22), (0.60, size.height), fabric),
        block((-0.12, 0.12), (0.25, 0.30), (0.64, 0.67), "black"),
        block((-0.12, 0.12), (-0.30, -0.25), (0.64, 0.67), "black"),
    ]


def _bed(size: Size, wood: str) -> list[Box]:
    """Head at the back (x negative); the frame stands high enough to be cleaned under."""
    head, foot = -size.front, size.front
    pillows = [
        block((head + 0.10, head + 0.50), (right + 0.06, left - 0.06), (0.52, 0.62), "linen")
        for right, left in columns(size, 0.8)
    ]
    return [
        *legs(size, 0.07, 0.18, wood),
        block((head, foot), (-size.side, size.side), (0.18, 0.32), wood),
        block((head, head + 0.05), (-size.side, size.side), (0.32, size.height), wood),
        block(
            (head + 0.05, foot - 0.02), (-size.side + 0.02, size.side - 0.02), (0.32, 0.52), "linen"
        ),
        block(
            (head + 0.62, foot - 0.01),
            (-size.side + 0.01, size.side - 0.01),
            (0.36, 0.56),
            "fabric_blue",
        ),
        *pillows,
    ]


SEATS = {
    "sofa": FurnitureKind(Size(2.1, 0.9, 0.82), "fabric_grey", _sofa),
    "armchair": FurnitureKind(Size(0.78, 0.80, 0.84), "fabric_mustard", _armchair),
    "chair": FurnitureKind(Size(0.44, 0.46, 0.88), "wood_light", _chair),
    "stool": FurnitureKind(Size(0.36, 0.36, 0.46), "wood_light", _stool),
    "office_chair": FurnitureKind(Size(0.60, 0.60, 1.02), "fabric_blue", _office_chair),
    "bed": FurnitureKind(Size(1.6, 2.05, 0.95), "wood", _bed),
}
"""Seats and beds by kind."""
