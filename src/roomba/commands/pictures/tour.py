"""The pictures of the README: the home, a walk over its map, and what the camera sees."""

from __future__ import annotations

import numpy as np

from roomba.configuration.sensors import CameraConfig
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.plots.canvas import Picture
from roomba.plots.home import draw_floor_plan
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import Home

_PIXELS_PER_METRE = 110.0
_WALK = ((3.0, 4.0), (5.2, 6.0), (6.8, 2.9), (0.0, 0.0))
"""m; the walk that is drawn goes to these points, one after the other."""
VIEWS = {
    "kitchen": Pose(3.9, 5.1, 2.75),
    "living_room": Pose(0.3, -0.4, 0.8),
    "bedroom": Pose(6.4, 4.0, -0.85),
    "bathroom": Pose(6.3, 5.0, 0.75),
}
"""Where the robot stands, and how it looks, for a picture of each room."""


def picture_of_home(home: Home) -> Picture:
    """Return the plan of a home, uint8 [height, width, 3] RGB."""
    return draw_floor_plan(home, pixels_per_metre=_PIXELS_PER_METRE)


def picture_of_walk(home: Home) -> Picture:
    """Let the robot walk from point to point; return the plan with the way that it drove."""
    robot = HeadlessMission(home)
    records = [robot.walk(*point) for point in _WALK]
    way = np.concatenate([record.poses[:, 1:3] for record in records])
    return draw_floor_plan(
        home,
        pixels_per_metre=_PIXELS_PER_METRE,
        path=[(float(x), float(y)) for x, y in way],
        robot=robot.simulator.pose,
    )


def picture_of_view(home: Home, pose: Pose, config: CameraConfig | None = None) -> Picture:
    """Return what the robot's camera sees from a pose, as it takes its pictures."""
    dirt = HeadlessMission(home).simulator.dirt
    camera = Camera(Scene.of(home), config or CameraConfig())
    return camera.picture(pose, 0.0, dirt.micrograms, dirt.frame).copy()
