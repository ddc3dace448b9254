"""Checks ``matched_pose(...)``: scans of a simulated lidar, with a first guess a bit off."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

import numpy as np

from roomba.commands.exercise.verdict import expect, function_of, judged
from roomba.configuration.body import BodyConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.grid import OCCUPIED
from roomba.world.home.raster import where_body_fits
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

_SCANS: Final = 20
_OFF: Final = (0.12, 0.12, 0.08)
"""m, m, rad; the most by which the first guess is off."""
_PLACE, _HEADING = 0.02, 0.01
"""m, rad; how near to the truth the median result must be."""
_WORST: Final = 0.06
"""m; the worst error of a result that passes."""
_PERSON, _HIDDEN = 0.7, 40
"""m; how near a person stands, and how many beams of each scan the person hides."""
_STAND: Final = 0.3
"""s that the robot stands, until there is a scan."""


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    match = function_of(file, "matched_pose")
    home, random = load_home("studio", HOMES), np.random.default_rng(7)
    frame, solid = home.frame, home.map.values == OCCUPIED
    places = np.argwhere(where_body_fits(frame, home.solid, BodyConfig().diameter / 2.0 + 0.1))
    away, turned = [], []
    for number in range(_SCANS):
        row, column = places[int(random.integers(len(places)))]
        x, y = frame.centre_of(int(row), int(column))
        robot = Simulator(home, seed=number, start=Pose(x, y, float(random.uniform(-3.1, 3.1))))
        robot.step(Twist(0.0, 0.0), _STAND)
        ranges = robot.ranges.astype(np.float64)
        angles = np.arange(len(ranges)) * 2.0 * np.pi / len(ranges)
        ranges[ranges >= robot.config.lidar.max_range] = np.inf
        hidden = (int(random.integers(len(ranges))) + np.arange(_HIDDEN)) % len(ranges)
        ranges[hidden] = np.minimum(ranges[hidden], _PERSON)
        truth, off = robot.pose, random.uniform(-1.0, 1.0, 3) * _OFF
        guess = (truth.x + off[0], truth.y + off[1], truth.theta + off[2])
        origin = (frame.origin_x, frame.origin_y)
        came = match(ranges, angles, solid.copy(), frame.resolution, origin, guess)
        found = [float(value) for value in came]
        expect(bool(np.isfinite(found).all()), f"scan {number + 1}: expected numbers, got {came}")
        away.append(truth.distance_to(found[0], found[1]))
        turned.append(abs(wrap_angle(found[2] - truth.theta)))
    place, heading, worst = float(np.median(away)), float(np.median(turned)), max(away)
    expect(place <= _PLACE, f"it is {place:.3f} m off in the median, expected {_PLACE} m or less")
    expect(heading <= _HEADING, f"it is {heading:.3f} rad off, expected {_HEADING} rad or less")
    expect(
        worst <= _WORST,
        f"scan {int(np.argmax(away)) + 1} is {worst:.2f} m off, the worst one; "
        f"{_WORST} m are allowed",
    )
    return f"{_SCANS} scans, {place:.3f} m and {heading:.4f} rad off in the median"


if __name__ == "__main__":
    sys.exit(judged(check))
