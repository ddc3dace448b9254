"""Makes the pictures of the README: the home, a walk over its map, and what the camera sees.

``./roomba pictures [FOLDER]``; no ROS, no screen, the same pictures each time.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.headless import HeadlessRobot
from roomba.world.camera import Camera, Scene
from roomba.world.home import Home
from roomba.world.layer import load_home
from roomba.world.plan import draw_plan

_ROOT = Path(__file__).parents[2]
_PIXELS_PER_METRE = 110.0
_WALK = ((3.0, 4.0), (5.2, 6.0), (6.8, 2.9), (0.0, 0.0))
"""m; the walk that is drawn goes to these points, one after the other."""
_VIEWS = {
    "kitchen": Pose(3.9, 5.1, 2.75),
    "living_room": Pose(0.3, -0.4, 0.8),
    "bedroom": Pose(6.4, 4.0, -0.85),
    "bathroom": Pose(6.3, 5.0, 0.75),
}
"""Where the robot stands, and how it looks, for a picture of each room."""


def main(arguments: list[str] | None = None) -> int:
    """Write all pictures; returns the exit status."""
    parser = argparse.ArgumentParser(prog="./roomba pictures", description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=_ROOT / "docs" / "pictures")
    folder = parser.parse_args(arguments).folder
    try:
        home = load_home("flat", _ROOT / "homes")
        folder.mkdir(parents=True, exist_ok=True)
        _write(folder / "home.png", picture_of_home(home))
        robot = HeadlessRobot(home)
        _write(folder / "walk.png", picture_of_walk(robot))
        for name, picture in pictures_of_camera(HeadlessRobot(home)).items():
            _write(folder / f"{name}.png", picture)
    except (RoombaError, OSError) as error:
        print(f"./roomba pictures: {error}", file=sys.stderr)
        return 1
    return 0


def picture_of_home(home: Home) -> NDArray[np.uint8]:
    """Return the plan of a home, uint8 [height, width, 3] RGB."""
    return draw_plan(home, pixels_per_metre=_PIXELS_PER_METRE)


def picture_of_walk(robot: HeadlessRobot) -> NDArray[np.uint8]:
    """Let the robot walk from point to point; return the plan with the way that it drove."""
    records = [robot.walk(*point) for point in _WALK]
    way = np.concatenate([record.poses[:, 1:3] for record in records])
    return draw_plan(
        robot.simulator.home,
        pixels_per_metre=_PIXELS_PER_METRE,
        path=[(float(x), float(y)) for x, y in way],
        robot=robot.simulator.pose,
    )


def pictures_of_camera(robot: HeadlessRobot) -> dict[str, NDArray[np.uint8]]:
    """Return a picture of each room by its name, as the robot's camera takes it."""
    world = robot.simulator
    camera = Camera(Scene.of(world.home), world.config.camera)
    dirt = world.dirt
    return {
        name: camera.picture(pose, 0.0, dirt.micrograms, dirt.frame).copy()
        for name, pose in _VIEWS.items()
    }


def _write(path: Path, picture: NDArray[np.uint8]) -> None:
    if not cv2.imwrite(str(path), picture[:, :, ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 9]):
        raise OSError(f"{path}: cannot be written")
    print(path)


if __name__ == "__main__":
    sys.exit(main())
