"""Matching a scan to the map: a scan before and after, and what an end of a beam weighs."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.figure import Figure

from roomba.arrays import Floats
from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.perception.matching.match_kernels import match
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.plots.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    RED,
    area_of,
    draw_robot,
    drawn,
    empty_figure,
)
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_AT: Final = Pose(1.6, 0.6, 0.6)
_OFF: Final = Pose(0.18, -0.12, 0.12)
"""Where the robot is, and by how much the guess is off, in the robot's frame: m, rad."""
_PRIOR: Final = (0.2, 0.2, 0.2)
"""m, m, rad; deviations of the guess."""
SCALES: Final = (0.40, 0.30, 0.20, 0.10, 0.05, 0.05)
"""m; at which ends lose weight, round by round, as for a guess that is unsure."""
_SHOWN: Final = 0.6
"""m; distances beyond are drawn alike."""
_STAND: Final = 0.3
"""s; until there is a scan."""


def ends_at(home: Home, at: Pose, seed: int = 1) -> Floats:
    """Return where the beams of a scan end, float64 [n, 4], in the frame of the robot there."""
    config = SimulatedRobotConfig().with_lidar(EXACT_LIDAR)
    robot = Simulator(home, config, seed=seed, start=at)
    robot.step(Twist(), _STAND)
    lidar = config.lidar
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    return model.view(robot.ranges).ends


def matched(home: Home, ends: Floats, guess: Floats, covariance: Floats) -> tuple[Floats, Floats]:
    """Return the pose [3] that fits best near a guess, and its covariance [3, 3]."""
    field, after, pose = SurfaceField.of(home.map), covariance.copy(), guess.copy()
    beam = SimulatedRobotConfig().localization.beam_deviation ** 2
    match(field.values, field.place, ends, len(ends), guess, after, np.array(SCALES), beam, pose)
    return pose, after


def placed(ends: Floats, pose: Floats) -> Floats:
    """Return the ends of beams, float64 [n, 2], on the map, of a robot at a pose [3]."""
    return Pose(*pose.tolist()).transform(ends[:, :2])


@drawn
def picture_of_matching(home: Home) -> Figure:
    """Draw a scan on the surface field by a wrong guess and by the pose that fits, and weights."""
    ends, guess = ends_at(home, _AT), _AT.compose(_OFF)
    wrong = guess.as_array()
    right, _ = matched(home, ends, wrong, np.diag(np.square(_PRIOR)))
    figure = empty_figure(1150, 520)
    on_map, weights = figure.subplots(1, 2, width_ratios=[1.25, 1.0])
    field = SurfaceField.of(home.map).values
    x_min, y_min, x_max, y_max = area_of(home)
    image = on_map.imshow(
        np.clip(field, -_SHOWN, _SHOWN),
        extent=(x_min, x_max, y_min, y_max),
        origin="lower",
        cmap="BrBG",
        alpha=0.6,
    )
    figure.colorbar(image, ax=on_map, shrink=0.8, label="distance to the nearest surface, m")
    for name, pose, colour in (("by the guess", wrong, RED), ("by the match", right, INK)):
        places = placed(ends, pose)
        on_map.scatter(places[:, 0], places[:, 1], s=7, color=colour, label=f"ends {name}")
        draw_robot(on_map, Pose(*pose.tolist()), colour)
    off, before = (1000.0 * _AT.distance_to(*pose[:2]) for pose in (right, wrong))
    on_map.set_title(f"The match is {off:.1f} mm off the truth, the guess {before:.0f} mm")
    on_map.set(xlim=(x_min, x_max), ylim=(y_min, y_max), xlabel="x, m", ylabel="y, m")
    on_map.legend(loc="upper right", frameon=True)
    away = np.linspace(-_SHOWN, _SHOWN, 301)
    for scale, colour in ((0.40, ORANGE), (0.20, GREEN), (0.05, BLUE)):
        weight = (1.0 + (away / scale) ** 2) ** -2
        weights.plot(away, weight, color=colour, label=f"s = {scale} m")
    weights.set_title("What an end weighs, by how far it is off")
    weights.set(xlabel="d, m", ylabel="w")
    weights.legend()
    return figure
