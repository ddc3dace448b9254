"""How long a picture takes: colour and depth, 640 x 480 pixels."""

from __future__ import annotations

import itertools
import math

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.sensors import CameraConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import Home
from roomba.world.home.materials import MATERIALS
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator
from roomba_bench.bench import Bench
from roomba_bench.checks import agreed
from roomba_bench.contestants import Contestant, Local
from roomba_bench.floors import Floor, free_poses
from roomba_bench.peers.protocol import Work
from roomba_bench.peers.simulators.boxes import boxes_of
from roomba_bench.record import Better, Record, gain
from roomba_bench.rounds import milliseconds

_TOPIC = "camera"
_VIEWS = 16
_CHECKED_VIEWS = 4
_THICK = 0.1
"""m; of the floor and of the ceiling, which are boxes to the peers."""
_GREY = (0.7, 0.7, 0.7)
_SAME_DEPTH = 0.05
"""Relative; the peers' home lacks skirtings, door frames, and walls above doors."""


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    bench.say("flat, 640 x 480")
    home = load_home("flat", HOMES)
    config = CameraConfig(width=640, height=480)
    poses = free_poses(Floor("flat", home.solid, home.frame), _VIEWS, room=0.35)
    parameters = {
        "boxes": bench.save("boxes", home_of_boxes(home)),
        "views": bench.save("views", lenses(poses, config)),
        "width": config.width,
        "height": config.height,
        "horizontal_field": config.horizontal_field,
    }
    contestants: list[Contestant] = [
        Local("ours", lambda: _pictures(home, config, poses)),
        bench.peer("moderngl", "cameras.moderngl", parameters),
        bench.peer("mujoco", "cameras.mujoco", parameters),
        bench.peer("pyrender", "cameras.pyrender", parameters),
        bench.peer("pybullet", "cameras.pybullet", parameters),
    ]
    ours, *peers = bench.compete(contestants)
    time = Record(
        _TOPIC,
        f"flat, {config.width} x {config.height}, colour and depth, {_VIEWS} views",
        "picture",
        None if ours.rate is None else milliseconds(ours.rate),
        "ms",
        Better.LOWER,
        1.0,
        tuple(
            agreed(ours, peer, "median depth", _SAME_DEPTH).figure(milliseconds) for peer in peers
        ),
        ours.error,
    )
    return [time, gain(time, "moderngl", 3.0)]


def home_of_boxes(home: Home) -> Floats:
    """Return a home as boxes in flat colours.

    :mod:`roomba_bench.peers.cameras.views` describes them.
    """
    frame = home.frame
    x_min, x_max, y_min, y_max = frame.extent
    middle = (0.5 * (x_min + x_max), 0.5 * (y_min + y_max), 0.0)
    halves = (0.5 * (x_max - x_min), 0.5 * (y_max - y_min))
    rows: list[tuple[float, ...]] = [
        (*middle, *halves, -_THICK, 0.0, *_colour("oak")),
        (*middle, *halves, home.wall_height, home.wall_height + _THICK, *_GREY),
    ]
    for left, low, right, high in (boxes_of(home.walls) * frame.resolution).tolist():
        x, y = x_min + 0.5 * (left + right), y_min + 0.5 * (low + high)
        size = (0.5 * (right - left), 0.5 * (high - low))
        rows.append((x, y, 0.0, *size, 0.0, home.wall_height, *_GREY))
    for piece in home.furniture:
        for box in piece.boxes:
            size = (0.5 * box.length, 0.5 * box.width)
            heights = (box.bottom, box.top)
            rows.append((box.x, box.y, box.theta, *size, *heights, *_colour(box.material)))
    return np.array(rows)


def lenses(poses: Floats, config: CameraConfig) -> Floats:
    """Return where the camera's lens is for poses of the body: x, y, height and heading."""
    forward = config.mount_forward
    x = poses[:, 0] + forward * np.cos(poses[:, 2])
    y = poses[:, 1] + forward * np.sin(poses[:, 2])
    return np.column_stack([x, y, np.full(len(poses), config.mount_height), poses[:, 2]])


def _colour(material: str) -> tuple[float, ...]:
    look = MATERIALS.get(material)
    return _GREY if look is None else tuple(channel / 255.0 for channel in look.rgb)


def _pictures(home: Home, config: CameraConfig, poses: Floats) -> Work:
    camera = Camera(Scene.of(home), config, supersampling=1)
    dirt = Simulator(home).dirt
    stands = [Pose(*pose) for pose in poses.tolist()]
    forever = itertools.cycle(stands)

    def picture() -> float:
        camera.render(next(forever), 0.0, dirt.micrograms, dirt.frame)
        return 1.0

    medians = [
        float(np.median(camera.render(pose, 0.0, dirt.micrograms, dirt.frame).depth))
        for pose in stands[:_CHECKED_VIEWS]
    ]
    assert all(math.isfinite(median) for median in medians)
    return Work(picture, {"median depth": float(np.mean(medians))})
