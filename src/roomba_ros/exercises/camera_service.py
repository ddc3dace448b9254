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
_COLOURS: Final = {
    -30: (200, 20, 20), -15: (20, 200, 20), 0: (20, 20, 200), 15: (200, 200, 20), 30: (20, 200, 200)
}  # fmt: skip
"""By angle, degrees: blue, green, red."""
_ASKED: Final = ((0.0, 0), (8.0, 15), (7.0, 0), (-90.0, -30), (22.4, 15), (400.0, 30))
"""Angles that are asked for, and those of the pictures that are nearest."""


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph, tempfile.TemporaryDirectory() as folder:
        for angle, colour in _COLOURS.items():
            picture = np.full((*_SIZE, 3), colour, np.uint8)
            cv2.imwrite(str(Path(folder) / f"{angle}.png"), picture)
        graph.run_answer(file, "turn_camera_service_node", folder)
        try:
            rospy.wait_for_service("turn_camera", 10.0)
        except rospy.ROSException as error:
            raise NotYetError("expected a service turn_camera, there is none") from error
        turn = rospy.ServiceProxy("turn_camera", TurnCamera)
        for asked, angle in _ASKED:
            try:
                image = turn(asked).image
            except rospy.ServiceException as error:
                raise NotYetError(f"asked for {asked:g} degrees it failed: {error}") from error
            expect(
                (image.height, image.width) == _SIZE,
                f"asked for {asked:g} degrees: expected a picture of {_SIZE[1]} x {_SIZE[0]} "
                f"pixels, got {image.width} x {image.height}",
            )
            came = tuple(int(value) for value in CvBridge().imgmsg_to_cv2(image, "bgr8")[0, 0])
            expect(
                came == _COLOURS[angle],
                f"asked for {asked:g} degrees: expected the picture of {angle}, got {_which(came)}",
            )
    return f"{len(_ASKED)} angles, each the nearest picture in its colours"


def _which(colour: tuple[int, ...]) -> str:
    for angle, own in _COLOURS.items():
        if colour == own:
            return f"that of {angle}"
        if colour == own[::-1]:
            return f"that of {angle} with red and blue exchanged"
    return f"another one, of colour {colour}"


if __name__ == "__main__":
    sys.exit(judged(check))
