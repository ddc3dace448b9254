"""The camera: colour and depth of the same picture, with a person in it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from roomba.configuration.sensors import CameraConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import drawn, empty_figure
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import Home, MovingKind
from roomba.world.simulator import Simulator

_STAND = Pose(0.6, 0.9, 0.15)
_DT = 0.1
"""s"""
_LONGEST = 1200.0
"""s; a person has come by then."""
_FAR = 6.0
"""m; farther things have one colour in the picture of depths."""


@drawn
def picture_of_depth(home: Home, config: CameraConfig | None = None) -> Figure:
    """Draw colour and depth side by side, when a person walks through the middle of the view."""
    config = config or CameraConfig()
    world = Simulator(home, start=_STAND)
    _wait_for_person(world)
    camera = Camera(Scene.of(home), config)
    camera.place_things(world.things)
    dirt = world.dirt
    picture = camera.render(world.pose, 0.0, dirt.micrograms, dirt.frame)
    figure = empty_figure(1000, 376)
    colour, depth = figure.subplots(1, 2, width_ratios=[1.0, 1.0])
    colour.imshow(picture.colour)
    shown = depth.imshow(picture.depth, cmap="viridis_r", vmin=0.0, vmax=_FAR)
    colour.set_title("/camera/image_raw")
    depth.set_title("/camera/depth/image_raw")
    for axes in (colour, depth):
        axes.set_axis_off()
    figure.colorbar(shown, ax=depth, label="depth, m", extend="max", fraction=0.04, pad=0.02)
    return figure


def _wait_for_person(world: Simulator) -> None:
    """Let time pass until a person is 2 to 3.5 m ahead, near the middle of the view."""
    people = np.array([thing.kind is MovingKind.PERSON for thing in world.home.moving], bool)
    while world.time < _LONGEST and people.any():
        world.advance(Twist(), _DT, 1)
        for x, y, _, present in world.things[people].tolist():
            near = 2.0 < _STAND.distance_to(x, y) < 3.5
            if present > 0.0 and near and abs(_STAND.bearing_to(x, y)) < 0.15:
                return
