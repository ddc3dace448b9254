"""Checks ``drive(pose, path, speed)``, which drives a simulated robot along paths."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Final

import shapely

from roomba.commands.exercise.verdict import expect, function_of, judged
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

_DT: Final = 0.05
"""s between two commands."""
_SPEED: Final = 0.3
"""m/s."""
_FASTEST_TURN: Final = 20.0
"""rad/s; a larger number must be degrees. This robot reaches a fifth of it."""
_ASIDE: Final = 0.10
"""m; the robot may be no farther off its path."""
_NEAR: Final = 0.05
"""m; from the end of the path."""
_PATHS: Final = (
    ("straight on", [(-2.0, -1.0), (1.5, -1.0)]),
    ("around a corner", [(-2.0, -1.0), (0.0, -1.0), (0.0, 1.0)]),
    ("a zigzag", [(-1.5, -1.0), (-0.5, 0.0), (0.5, -1.0), (1.5, 0.0)]),
    ("back again", [(-1.0, 0.5), (1.0, 0.5), (1.0, 0.9), (-1.0, 0.9)]),
)


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    drive = function_of(file, "drive")
    home = load_home("empty", HOMES)
    x, y = home.frame.centre_of(home.frame.rows // 2, home.frame.columns // 2)
    worst = 0.0
    # Each path stays one list for the whole drive, and no two lists have the same identity.
    paths = {name: [(x + right, y + up) for right, up in corners] for name, corners in _PATHS}
    for name, path in paths.items():
        end, line = path[-1], shapely.LineString(path)
        first = math.atan2(path[1][1] - path[0][1], path[1][0] - path[0][0])
        robot = Simulator(home, seed=1, start=Pose(*path[0], first))
        most = 10.0 + 3.0 * line.length / _SPEED
        while robot.time < most:
            pose = robot.pose
            speed, turning = drive((pose.x, pose.y, pose.theta), path, _SPEED)
            expect(
                math.isfinite(speed) and math.isfinite(turning),
                f"{name}: expected a finite speed and turning, got {speed}, {turning}",
            )
            expect(speed <= 1.01 * _SPEED, f"{name}: {speed:.2f} m/s is above {_SPEED} m/s")
            expect(
                abs(turning) <= _FASTEST_TURN,
                f"{name}: {turning:.0f} rad/s is more than any robot turns; are these degrees?",
            )
            if speed == 0.0 and turning == 0.0:
                break
            robot.step(Twist(float(speed), float(turning)), _DT)
            aside = float(line.distance(shapely.Point(robot.pose.x, robot.pose.y)))
            worst = max(worst, aside)
            expect(
                aside <= _ASIDE,
                f"{name}: after {robot.time:.1f} s it is {aside:.2f} m off its path, at "
                f"({robot.pose.x - x:.2f}, {robot.pose.y - y:.2f}); {_ASIDE} m are allowed",
            )
        off = robot.pose.distance_to(*end)
        expect(
            robot.time < most,
            f"{name}: it has not told the robot to stand after {most:.0f} s, at "
            f"({robot.pose.x - x:.2f}, {robot.pose.y - y:.2f}), {off:.2f} m from the end",
        )
        expect(off <= _NEAR, f"{name}: it stands {off:.2f} m from the end; {_NEAR} m are allowed")
    return f"{len(_PATHS)} paths, at most {100.0 * worst:.1f} cm off them"


if __name__ == "__main__":
    sys.exit(judged(check))
