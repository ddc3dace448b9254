"""Compiled scan of a robot in its world: walls, moving things, round things and other robots."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats32
from roomba.compilation import any_order_part, inner_part
from roomba.world.engine.lidar.light_kernels import Eye, Surroundings, lidar_at, look_through
from roomba.world.engine.lidar.projection import (
    ScanBuffers,
    begin_scan,
    end_scan,
    scan_disc,
    scan_segment,
    scan_walls,
)
from roomba.world.engine.state.arrays import Edges, Row, Rows, Solid
from roomba.world.engine.state.random_kernels import add_noise, next_bits

_SLACK: Final = 1e-9
"""s; a scan is due when the time is as near to it as this."""


@inner_part
def is_scan_due(world: Row, body: Row, period: float) -> bool:
    """Tell whether it is time for a scan, and set the next time; missed scans are left out."""
    late = world.time - body.next_scan + _SLACK
    if late < 0.0:
        return False
    body.next_scan += (math.floor(late / period) + 1.0) * period
    return True


@inner_part
def scan(
    solid: Solid,
    edges: Edges,
    home: Row,
    world: Row,
    robot: int,
    numbers: Row,
    quantiles: Floats32,
    buffers: ScanBuffers,
    ranges: Floats32,
) -> None:
    """Fill the robot's row of ``ranges`` with what its lidar measures now."""
    body = solid.robots[robot]
    body.scans += 1
    body.scan_stamp = world.time
    if body.lidar_blocked > 0.0:
        for beam in range(ranges.shape[1]):
            ranges[robot, beam] = np.float32(math.inf)
        return
    eye = lidar_at(body, numbers, body.x, body.y, body.theta)
    x, y = np.float32(eye[0] - home.left), np.float32(eye[1] - home.bottom)
    theta = begin_scan(buffers.rays, buffers.fan, eye[2], numbers.max_range)
    scan_walls(buffers, edges, home, x, y, theta)
    beams = ranges.shape[1]
    scan_faces(solid.faces, home, eye[0], eye[1], buffers.fan, beams, theta)
    scan_things(solid, world, eye, buffers.fan, beams, theta, numbers.lidar_height)
    scan_round_things(solid, world, robot, eye, buffers.fan, beams, theta, numbers.radius)
    end_scan(buffers.fan, ranges, robot, numbers.min_range, numbers.max_range)
    bits = next_bits(body) if numbers.noisy > 0.0 else np.uint64(0)
    if home.faces_end > home.clear_at:
        around = Surroundings(solid, home, world, robot, numbers, quantiles)
        look_through(around, ranges, np.uint32(bits & np.uint64(0xFFFFFFFF)))
    if numbers.noisy > 0.0:
        key = np.uint32(bits >> np.uint64(32))
        sigma, misses = np.float32(numbers.range_noise), np.float32(numbers.misses)
        add_noise(ranges, robot, key, quantiles, sigma, misses)


@any_order_part
def scan_faces(
    faces: Rows, home: Row, x: float, y: float, fan: Floats32, beams: int, theta: np.float32
) -> None:
    """Put the faces of walls that are free of the grid into the depth buffer, but for clear ones.

    The lidar is at ``x``, ``y``, m, map frame.
    """
    for index in range(home.faces_at, home.clear_at):
        face = faces[index]
        scan_segment(
            fan,
            beams,
            face.right_x - x,
            face.right_y - y,
            face.left_x - x,
            face.left_y - y,
            theta,
        )


@any_order_part
def scan_things(
    solid: Solid,
    world: Row,
    eye: Eye,
    fan: Floats32,
    beams: int,
    theta: np.float32,
    height: float,
) -> None:
    """Put the boxes of moving things that reach the lidar's height into the depth buffer."""
    for number in range(world.things_at, world.things_end):
        thing = solid.things[number]
        if thing.present == 0.0:
            continue
        cosine, sine = math.cos(thing.theta), math.sin(thing.theta)
        for index in range(thing.boxes_at, thing.boxes_end):
            box = solid.boxes[index]
            if box.bottom <= height < box.top:
                x = thing.x - eye[0] + cosine * box.x - sine * box.y
                y = thing.y - eye[1] + sine * box.x + cosine * box.y
                scan_box(fan, beams, box, x, y, thing.theta + box.theta, theta)


@any_order_part
def scan_box(
    fan: Floats32, beams: int, box: Row, x: float, y: float, turn: float, theta: np.float32
) -> None:
    """Put the sides of a box, its middle as seen from the robot, into the depth buffer."""
    cosine, sine = math.cos(turn), math.sin(turn)
    along_x, along_y = cosine * box.half_length, sine * box.half_length
    across_x, across_y = -sine * box.half_width, cosine * box.half_width
    for _ in range(4):
        # One side after the other, clockwise, so that a side's right end comes first from outside.
        x0, y0 = x + along_x + across_x, y + along_y + across_y
        x1, y1 = x + along_x - across_x, y + along_y - across_y
        scan_segment(fan, beams, x0, y0, x1, y1, theta)
        along_x, along_y, across_x, across_y = -across_x, -across_y, along_x, along_y


@any_order_part
def scan_round_things(
    solid: Solid,
    world: Row,
    robot: int,
    eye: Eye,
    fan: Floats32,
    beams: int,
    theta: np.float32,
    radius: float,
) -> None:
    """Put round things and other robots, discs of ``radius`` m, into the depth buffer."""
    for number in range(world.discs_at, world.discs_end):
        disc = solid.discs[number]
        scan_disc(fan, beams, disc.x - eye[0], disc.y - eye[1], disc.radius, theta)
    for number in range(world.robots_at, world.robots_end):
        if number != robot:
            other = solid.robots[number]
            scan_disc(fan, beams, other.x - eye[0], other.y - eye[1], radius, theta)
