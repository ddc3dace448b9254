"""Compiled contact of the round body: how near solid things are, and how far it can go.

Solid are the cells of the home (and all outside of it), walls free of them, moving things, round
things that were put down, and other robots of the same world.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.angles import wrapped
from roomba.compilation import inner_part, part
from roomba.world.engine.lidar.face_kernels import way_to_face
from roomba.world.engine.state.arrays import Row, Rows, Solid

PROBE_STEP: Final = 1e-3
"""m; step of the search for contact when something solid is nearer than the way to go."""
FARTHEST_LOOK: Final = 0.5
"""m; longer ways are looked at part by part."""
CONTACT_ERROR: Final = 1e-7
"""m; how exactly the place of contact is found."""
_TRIES: Final = 60
"""Iterations at most; false position needs two or three."""
CONTACT_GAP: Final = 1e-3
"""m; a bumper stays pressed until what it touches is farther away than this."""
BOTH_BUMPERS_ANGLE: Final = 0.3
"""rad; contact nearer to straight ahead than this presses both halves of the bumper."""
LEFT: Final = 1
RIGHT: Final = 2


@part
def arc(x: float, y: float, theta: float, length: float, turn: float) -> tuple[float, float]:
    """Return the point after ``length`` m of an arc that changes the heading by ``turn`` rad."""
    if abs(turn) < 1e-9:
        middle = theta + 0.5 * turn
        return x + length * math.cos(middle), y + length * math.sin(middle)
    radius = length / turn
    return (
        x + radius * (math.sin(theta + turn) - math.sin(theta)),
        y - radius * (math.cos(theta + turn) - math.cos(theta)),
    )


@part
def halves(dx: float, dy: float, theta: float) -> int:
    """Return which halves of the bumper something in a direction presses: LEFT | RIGHT."""
    angle = wrapped(math.atan2(dy, dx) - theta)
    if abs(angle) > 0.5 * math.pi:
        return 0
    pressed = LEFT if angle > -BOTH_BUMPERS_ANGLE else 0
    return pressed | RIGHT if angle < BOTH_BUMPERS_ANGLE else pressed


@inner_part
def near_cells(
    cells: Rows, home: Row, x: float, y: float, reach: float, touch: float, theta: float
) -> tuple[float, int]:
    """Return the distance to the nearest solid cell, at most ``reach``, and the bumper's halves.

    Halves are those that are pressed by what is not farther than ``touch``; -1 asks for none.
    """
    resolution = home.resolution
    u = (x - home.left) / resolution
    v = (y - home.bottom) / resolution
    around = reach / resolution
    nearest = around * around
    square_touch = touch * abs(touch) / (resolution * resolution)
    pressed = 0
    for row in range(math.floor(v - around), math.floor(v + around) + 1):
        dv = max(row - v, v - row - 1.0, 0.0)
        if dv * dv > max(nearest, square_touch):
            continue
        for column in range(math.floor(u - around), math.floor(u + around) + 1):
            inside = 0 <= row < home.rows and 0 <= column < home.columns
            if inside and not cells[home.cells_at + row * home.columns + column].solid:
                continue
            du = max(column - u, u - column - 1.0, 0.0)
            square = du * du + dv * dv
            nearest = min(nearest, square)
            if square <= square_touch:
                ahead = min(max(u, column), column + 1.0) - u
                aside = min(max(v, row), row + 1.0) - v
                pressed |= halves(ahead, aside, theta)
    return float(math.sqrt(nearest) * resolution), pressed


@inner_part
def near_faces(
    solid: Solid, home: Row, x: float, y: float, reach: float, touch: float, theta: float
) -> tuple[float, int]:
    """Return the distance to the nearest face, at most ``reach``, and the bumper's halves.

    Halves are those that are pressed by what is not farther than ``touch``; -1 asks for none.
    """
    nearest, pressed = reach, 0
    for index in range(home.faces_at, home.faces_end):
        to_x, to_y = way_to_face(solid.faces[index], x, y)
        away = math.hypot(to_x, to_y)
        nearest = min(nearest, away)
        if away <= touch:
            pressed |= halves(to_x, to_y, theta)
    return nearest, pressed


@inner_part
def near_things(
    solid: Solid, world: Row, x: float, y: float, reach: float, touch: float, theta: float
) -> tuple[float, int]:
    """Return what :func:`near_faces` does, for a world's moving things."""
    nearest, pressed = reach, 0
    for number in range(world.things_at, world.things_end):
        thing = solid.things[number]
        if thing.present == 0.0:
            continue
        cosine, sine = math.cos(thing.theta), math.sin(thing.theta)
        dx, dy = x - thing.x, y - thing.y
        ahead, aside = cosine * dx + sine * dy, cosine * dy - sine * dx
        for box in range(thing.boxes_at, thing.boxes_end):
            away, to_ahead, to_aside = way_to_box(solid.boxes[box], ahead, aside)
            nearest = min(nearest, away)
            if away <= touch:
                to_x = cosine * to_ahead - sine * to_aside
                pressed |= halves(to_x, sine * to_ahead + cosine * to_aside, theta)
    return nearest, pressed


@inner_part
def way_to_box(box: Row, x: float, y: float) -> tuple[float, float, float]:
    """Return the distance from a point of a thing's frame to a box of it, and the way there."""
    cosine, sine = math.cos(box.theta), math.sin(box.theta)
    dx, dy = x - box.x, y - box.y
    along, across = cosine * dx + sine * dy, cosine * dy - sine * dx
    to_along = min(max(along, -box.half_length), box.half_length) - along
    to_across = min(max(across, -box.half_width), box.half_width) - across
    return (
        math.hypot(to_along, to_across),
        cosine * to_along - sine * to_across,
        sine * to_along + cosine * to_across,
    )


@inner_part
def near_discs(
    solid: Solid,
    world: Row,
    robot: int,
    radius: float,
    x: float,
    y: float,
    reach: float,
    touch: float,
    theta: float,
) -> tuple[float, int]:
    """Return what :func:`near_faces` does, for round things and all other robots of the world."""
    nearest, pressed = reach, 0
    for number in range(world.discs_at, world.discs_end):
        dx, dy = solid.discs[number].x - x, solid.discs[number].y - y
        away = math.hypot(dx, dy) - solid.discs[number].radius
        nearest = min(nearest, max(away, 0.0))
        if away <= touch:
            pressed |= halves(dx, dy, theta)
    for other in range(world.robots_at, world.robots_end):
        if other == robot:
            continue
        dx, dy = solid.robots[other].x - x, solid.robots[other].y - y
        away = math.hypot(dx, dy) - radius
        nearest = min(nearest, max(away, 0.0))
        if away <= touch:
            pressed |= halves(dx, dy, theta)
    return nearest, pressed


@inner_part
def room_at(cells: Rows, home: Row, x: float, y: float) -> float:
    """Return a distance, m, within which nothing of the home is solid: a cheap lower bound."""
    u = (x - home.left) / home.resolution
    v = (y - home.bottom) / home.resolution
    column, row = math.floor(u), math.floor(v)
    if not (0 <= row < home.rows and 0 <= column < home.columns):
        return 0.0
    du, dv = u - column - 0.5, v - row - 0.5
    off_middle = math.sqrt(du * du + dv * dv) * home.resolution
    return float(cells[home.cells_at + row * home.columns + column].room - off_middle)


@part
def gap_at(
    solid: Solid, home: Row, world: Row, robot: int, radius: float, x: float, y: float, way: float
) -> float:
    """Return how far the robot's disc, at a place, is from what is solid; exact below ``way``, m.

    Negative when it overlaps something.
    """
    distance = radius + way
    if room_at(solid.cells, home, x, y) <= distance:
        distance, _ = near_cells(solid.cells, home, x, y, distance, -1.0, 0.0)
        if home.faces_end > home.faces_at:
            distance, _ = near_faces(solid, home, x, y, distance, -1.0, 0.0)
    if world.things_end > world.things_at:
        distance, _ = near_things(solid, world, x, y, distance, -1.0, 0.0)
    distance, _ = near_discs(solid, world, robot, radius, x, y, distance, -1.0, 0.0)
    return float(distance - radius)


@inner_part
def contact_share(
    solid: Solid,
    home: Row,
    world: Row,
    robot: int,
    radius: float,
    length: float,
    turn: float,
    least: float,
    bounds: tuple[float, float, float, float],
) -> float:
    """Return the share of an arc where the gap falls below ``least``, m, never past it.

    ``bounds``: a share before that place and one past it, and by how much the gap is above
    ``least`` at both. The share is found by false position (the Illinois method), which ends at
    once for a disc that leans on a wall.
    """
    body = solid.robots[robot]
    low, high, over_low, over_high = bounds
    weight, last = over_low, 0
    for _ in range(_TRIES):
        if over_low <= CONTACT_ERROR or (high - low) * abs(length) <= CONTACT_ERROR:
            break
        middle = low + (high - low) * weight / (weight - over_high)
        x, y = arc(body.x, body.y, body.theta, length * middle, turn * middle)
        over = gap_at(solid, home, world, robot, radius, x, y, PROBE_STEP) - least
        if over < 0.0:
            high, over_high = middle, over
            weight = 0.5 * weight if last < 0 else weight
            last = -1
        else:
            low, over_low, weight = middle, over, over
            over_high = 0.5 * over_high if last > 0 else over_high
            last = 1
    return low


@inner_part
def free_share(
    solid: Solid,
    home: Row,
    world: Row,
    robot: int,
    radius: float,
    length: float,
    turn: float,
) -> float:
    """Return the share of an arc, 0..1, that the robot can go before it touches something solid.

    A disc that already overlaps may go where the overlap does not grow.
    """
    body = solid.robots[robot]
    way = abs(length)
    done = 0.0
    x, y = body.x, body.y
    while done < 1.0 and way > 0.0:
        left = way * (1.0 - done)
        look = min(left, FARTHEST_LOOK) + PROBE_STEP
        gap = gap_at(solid, home, world, robot, radius, x, y, look)
        if gap > left:
            return 1.0
        step = min(1.0, done + max(gap - 1e-9, PROBE_STEP) / way)
        least = min(gap, 0.0)
        x, y = arc(body.x, body.y, body.theta, length * step, turn * step)
        probed = gap_at(solid, home, world, robot, radius, x, y, PROBE_STEP)
        if probed < least:
            bounds = done, step, gap - least, probed - least
            return contact_share(solid, home, world, robot, radius, length, turn, least, bounds)
        done = step
    return 1.0


@inner_part
def feel_bumper(solid: Solid, home: Row, world: Row, robot: int, radius: float) -> None:
    """Press and release the bumper's halves by what touches the front half of the disc.

    A half is pressed by a hit, and stays so while the contact lasts.
    """
    body = solid.robots[robot]
    pressed = LEFT | RIGHT if body.bumper_stuck > 0.0 else 0
    was_touching = body.hit > 0.0 or body.bumper_left > 0.0 or body.bumper_right > 0.0
    if pressed == 0 and was_touching:
        x, y, theta = body.x, body.y, body.theta
        touch = radius + CONTACT_GAP
        _, by_cells = near_cells(solid.cells, home, x, y, touch, touch, theta)
        _, by_faces = near_faces(solid, home, x, y, touch, touch, theta)
        _, by_things = near_things(solid, world, x, y, touch, touch, theta)
        _, by_discs = near_discs(solid, world, robot, radius, x, y, touch, touch, theta)
        pressed = by_cells | by_faces | by_things | by_discs
    body.bumper_left = 1.0 if pressed & LEFT else 0.0
    body.bumper_right = 1.0 if pressed & RIGHT else 0.0
