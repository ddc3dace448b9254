"""Checks a service that gives the picture of the nearest angle."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Final

import cv2
import numpy as np
import rospy
from cv_bridge import CvBridge
from roomba_robot.srv import TurnCamera

from roomba.commands.exercise.verdict import NotYetError, expect, judged
from roomba_ros.exercises.graph import OwnGraph

_SIZE: Final = (48, 64)
"""Pixels of a picture: height, width."""
COLOURS: Final = {
    -30: (200, 20, 80), -15: (20, 200, 100), 0: (20, 80, 220), 15: (200, 140, 20), 30: (60, 200, 99)
}  # fmt: skip
"""By angle, degrees: blue, green, red; with red and blue swapped no colour equals another one."""
_CHOSEN: Final = (0.0, 8.0, 7.0, -8.0, -22.4, -23.0, 22.4, -90.0, 400.0)
_DRAWN: Final = 6
_WIDE: Final = 45.0
"""degrees to each side; the angles that are asked for at random lie within."""


def asked() -> list[tuple[float, int]]:
    """Return the angles that are asked for, degrees, and those of the pictures that are nearest."""
    drawn = np.random.default_rng(2).uniform(-_WIDE, _WIDE, _DRAWN).round(1)
    angles = [*_CHOSEN, *(float(angle) for angle in drawn)]
    return [(one, min(COLOURS, key=lambda other: abs(other - one))) for one in angles]


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph, tempfile.TemporaryDirectory() as folder:
        for angle, colour in COLOURS.items():
            picture = np.full((*_SIZE, 3), colour, np.uint8)
            cv2.imwrite(str(Path(folder) / f"{angle}.png"), picture)
        graph.run_answer(file, "turn_camera_service_node", folder)
        graph.wait_for(lambda: graph.has_service("turn_camera"), 10.0, "a service turn_camera")
        turn = rospy.ServiceProxy("turn_camera", TurnCamera)
        questions = asked()
        for wish, angle in questions:
            try:
                image = turn(wish).image
            except rospy.ServiceException as error:
                graph.expect_running()
                raise NotYetError(f"asked for {wish:g} degrees it failed: {error}") from error
            expect(
                (image.height, image.width) == _SIZE,
                f"asked for {wish:g} degrees: expected a picture of {_SIZE[1]} x {_SIZE[0]} "
                f"pixels, got {image.width} x {image.height}",
            )
            came = tuple(int(value) for value in CvBridge().imgmsg_to_cv2(image, "bgr8")[0, 0])
            expect(
                came == COLOURS[angle],
                f"asked for {wish:g} degrees: expected the picture of {angle}, got {_which(came)}",
            )
    return f"{len(questions)} angles, each the nearest picture in its colours"


def _which(colour: tuple[int, ...]) -> str:
    for angle, own in COLOURS.items():
        if colour == own:
            return f"that of {angle}"
        if colour == own[::-1]:
            return f"that of {angle} with red and blue exchanged"
    return f"another one, of colour {colour}"


if __name__ == "__main__":
    sys.exit(judged(check))
