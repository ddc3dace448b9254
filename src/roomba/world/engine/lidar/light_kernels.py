"""Compiled light of one beam: what it meets first, on the way through glass and by mirrors.

A beam meets a cell of the home, a face of a wall that is free of the grid, or something that moves;
that gives back enough light for a range, or does not. Metres, map frame.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats32
from roomba.compilation import inner_part, part
from roomba.trigonometry import sine_cosine
from roomba.world.engine.lidar.face_kernels import mirrored, ray_to_faces
from roomba.world.engine.lidar.ray_kernels import ray_to_cells, ray_to_movable
from roomba.world.engine.state.arrays import Row, Solid
from roomba.world.engine.state.random_kernels import hashed
from roomba.world.home.surface import Finish

CELL: Final = -1
MOVABLE: Final = -2
"""What a beam met, if it was no face."""
MOST_LEGS: Final = 8
"""A beam ends after so many panes and mirrors."""
_INTO: Final = 0.01
"""m; a little inside of what was met: its face may lie on the border of two patches."""
_UNIT_20: Final = 1.0 / (1 << 20)
_NEVER: Final = -1e-12
"""Reflectivity of a shiny surface without a matt share; below 0, as that of all shiny ones."""
_SHINY, _GLASS, _MIRROR = float(Finish.SHINY), float(Finish.GLASS), float(Finish.MIRROR)
_LOW = float(Finish.LOW)

Eye = tuple[float, float, float]
"""Where a lidar is and looks, map frame: x, y, m, and theta, rad."""


class Surroundings(NamedTuple):
    """Where a robot's lidar measures, and by which numbers."""

    solid: Solid
    home: Row
    world: Row
    robot: int
    numbers: Row
    quantiles: Floats32
    """See :func:`~roomba.world.engine.state.random_kernels.normal_quantiles`."""


class Met(NamedTuple):
    """What a beam met: after which way, m, how squarely, what, where, and how much light is left.

    ``what`` is a face's number, or one of the constants above; ``x`` and ``y`` lie a little inside.
    """

    way: float
    facing: float
    what: int
    x: float
    y: float
    light: float


@inner_part
def reflectivity(x: float, y: float, numbers: Row) -> float:
    """Return the share of light that the home gives back at a place, as :func:`is_seen` takes it.

    It is the same for each robot and run: the place alone decides, m from the grid's corner.
    """
    column, row = math.floor(x / numbers.patch), math.floor(y / numbers.patch)
    bits = hashed(np.uint32(column * 73856093 + row * 19349663 + 12345))
    chance = float(bits >> np.uint32(12)) * _UNIT_20
    if chance < numbers.dark:
        return float(numbers.black)
    if chance < numbers.dark + numbers.shiny:
        return _NEVER
    share = float(bits & np.uint32(4095)) / 4096.0
    return float(numbers.dimmest + (numbers.white - numbers.dimmest) * share)


@inner_part
def is_seen(found: float, facing: float, reflected: float, numbers: Row, fading: float) -> bool:
    """Tell whether enough light comes back: reflectivity times cosine over squared range decides.

    White paint met squarely is seen from ``white_reach``; ``fading`` is a normal random number.
    A shiny surface has its matt share as a number below 0, and is always seen when met squarely.
    """
    if reflected < 0.0:
        if facing > numbers.shiny_cosine:
            return True
        reflected = -reflected
    reach = numbers.white_reach * math.sqrt(reflected / numbers.white * facing)
    return bool(found < reach * (1.0 + numbers.fading * fading))


@part
def ray_at(around: Surroundings, x: float, y: float, angle: float, chance: float) -> Met:
    """Return what a ray meets, through glass and by mirrors; ``chance`` of 0..1 is the beam's own.

    A ray that a mirror sent on can meet the robot itself.
    """
    sine, cosine = sine_cosine(angle)
    reach = around.numbers.max_range
    cell = ray_to_cells(around.solid.squares, around.home, x, y, cosine, sine, reach)
    return ray_with_cell(around, x, y, cosine, sine, chance, cell)


@part
def ray_with_cell(
    around: Surroundings,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    chance: float,
    cell: tuple[float, float],
) -> Met:
    """Return what :func:`ray_at` does; ``cell``: way, m, to the nearest solid cell, and facing."""
    home = around.home
    if home.faces_end > home.faces_at:
        return ray_among_faces(around, x, y, cosine, sine, chance, cell)
    found, facing, what = meet(around, x, y, cosine, sine, cell, around.robot)
    into = found + _INTO
    return Met(found, facing, what, x + into * cosine, y + into * sine, 1.0)


@inner_part
def meet(
    around: Surroundings,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    cell: tuple[float, float],
    viewer: int,
) -> tuple[float, float, int]:
    """Return way, m, facing and kind, CELL or MOVABLE, of what a ray meets first.

    ``cell`` is the way to the nearest solid cell, m, and its facing. All that moves can be met but
    the robot ``viewer``.
    """
    solid, numbers = around.solid, around.numbers
    found, facing = cell
    nearer, square = ray_to_movable(
        solid,
        around.world,
        viewer,
        x,
        y,
        cosine,
        sine,
        numbers.lidar_height,
        numbers.radius,
    )
    if nearer < found:
        return nearer, square, MOVABLE
    return found, facing, CELL


@inner_part
def ray_among_faces(
    around: Surroundings,
    x: float,
    y: float,
    cosine: float,
    sine: float,
    chance: float,
    cell: tuple[float, float],
) -> Met:
    """Return what a ray meets in a home with walls that are free of its grid."""
    solid, home, numbers = around.solid, around.home, around.numbers
    gone, light, left, viewer = 0.0, 1.0, -1, around.robot
    for _ in range(MOST_LEGS):
        found, facing, what = meet(around, x, y, cosine, sine, cell, viewer)
        finish = 0.0
        nearer, square, index = ray_to_faces(
            solid.faces, home.faces_at, home.faces_end, x, y, cosine, sine, left
        )
        if nearer < found:
            found, facing, what = nearer, square, index
            finish = solid.faces[index].finish
        is_back = finish == _GLASS and facing > numbers.glass_cosine and chance < numbers.glass
        if finish < _GLASS or is_back:
            into = found + _INTO
            end_x, end_y = x + into * cosine, y + into * sine
            return Met(gone + found, facing, what, end_x, end_y, light)
        x, y, gone, left = x + found * cosine, y + found * sine, gone + found, what
        if finish != _LOW:
            light *= numbers.clear
        if finish == _MIRROR:
            cosine, sine = mirrored(solid.faces[what], cosine, sine)
            viewer = -1
        reach = numbers.max_range - gone
        cell = ray_to_cells(solid.squares, home, x, y, cosine, sine, reach)
    return Met(math.inf, 1.0, CELL, x, y, 0.0)


@inner_part
def given_back(around: Surroundings, met: Met) -> float:
    """Return the share of light that what a beam met gives back, as :func:`is_seen` takes it."""
    solid, home, numbers = around.solid, around.home, around.numbers
    if met.what == MOVABLE:
        return float(numbers.movable)
    if met.what >= 0 and solid.faces[met.what].reflectivity >= 0.0:
        share = solid.faces[met.what].reflectivity
        return float(-share if solid.faces[met.what].finish == _SHINY else share)
    x, y = met.x - home.left, met.y - home.bottom
    if met.what == CELL:
        column, row = math.floor(x / home.resolution), math.floor(y / home.resolution)
        if 0 <= row < home.rows and 0 <= column < home.columns:
            code = int(solid.cells[home.cells_at + row * home.columns + column].surface)
            if code > 100:
                return -0.01 * (code - 100)
            if code > 0:
                return 0.01 * code
    return reflectivity(x, y, numbers)


@inner_part
def is_echo(around: Surroundings, met: Met, fading: float) -> bool:
    """Tell whether enough light comes back from what a ray met (see :func:`ray_at`)."""
    if met.what >= 0 and around.solid.faces[met.what].finish == _GLASS:
        return True
    shared = given_back(around, met) * met.light
    return is_seen(met.way, met.facing, shared, around.numbers, fading)


@part
def lidar_at(body: Row, numbers: Row, x: float, y: float, theta: float) -> Eye:
    """Return the pose of the lidar of a body that is at a pose."""
    if numbers.worn == 0.0 and numbers.lidar_ahead == 0.0:
        return x, y, theta
    cosine, sine = math.cos(theta), math.sin(theta)
    ahead = numbers.lidar_ahead + body.lidar_x
    return (
        x + cosine * ahead - sine * body.lidar_y,
        y + sine * ahead + cosine * body.lidar_y,
        theta + body.lidar_turn,
    )


@inner_part
def look_through(around: Surroundings, ranges: Floats32, key: np.uint32) -> None:
    """Measure anew those beams of a scan that meet glass, a mirror or a low face first.

    ``key`` decides by chance which of them glass sends back.
    """
    home, numbers = around.home, around.numbers
    body = around.solid.robots[around.robot]
    eye = lidar_at(body, numbers, body.x, body.y, body.theta)
    beams = ranges.shape[1]
    for beam in range(beams):
        angle = eye[2] + beam * (2.0 * math.pi / beams)
        cosine, sine = math.cos(angle), math.sin(angle)
        way, _, _ = ray_to_faces(
            around.solid.faces, home.clear_at, home.faces_end, eye[0], eye[1], cosine, sine, -1
        )
        if way < ranges[around.robot, beam]:
            chance = 1.0
            if numbers.noisy > 0.0:
                bits = hashed(np.uint32(key + np.uint32(beam) * np.uint32(0x9E3779B9)))
                chance = float(bits >> np.uint32(12)) * _UNIT_20
            found = ray_at(around, eye[0], eye[1], angle, chance).way
            if found < numbers.min_range:
                found = -math.inf
            elif found >= numbers.max_range:
                found = math.inf
            ranges[around.robot, beam] = np.float32(found)
