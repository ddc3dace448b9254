"""Things that the map does not show: evidence of a cell, scan by scan."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.figure import Figure

from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.plots.style import (
    BLUE,
    GREY,
    INK,
    RED,
    draw_robot,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_AT: Final = Pose(0.9, 0.3, 0.0)
_THING: Final = (2.2, 0.6, 0.08)
"""m; x, y and radius of what is put down, and taken away again."""
_SCANS: Final = 45
_COMES, _GOES = 5, 27
"""Numbers of the scans before which it comes, and goes."""
_TICK: Final = 0.1
"""s between two scans."""


@drawn
def picture_of_things(home: Home) -> Figure:
    """Draw what a thing in the way makes of evidence, while it is there and after it has gone."""
    config = SimulatedRobotConfig().with_lidar(EXACT_LIDAR)
    robot = Simulator(home, config, seed=1, start=_AT)
    lidar = config.lidar
    beams = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range).arrays()
    layer = ThingLayer(SurfaceField.of(home.map))
    frame = home.frame
    robot.step(Twist(), 3.0 * _TICK)
    evidence, seen = [], None
    for scan in range(_SCANS):
        if scan == _COMES:
            robot.place_obstacle(*_THING)
        if scan == _GOES:
            seen = layer.cells()
            robot.remove_obstacles()
        robot.step(Twist(), _TICK)
        layer.see(robot.ranges, beams, robot.pose)
        evidence.append(layer.arrays.evidence.copy())
    assert seen is not None
    figure = empty_figure(1150, 440)
    plan, over_time = figure.subplots(1, 2, width_ratios=[1.0, 1.3])
    show_floor_plan(plan, home, (_AT.x - 0.6, _AT.y - 1.1, _THING[0] + 0.8, _THING[1] + 1.0))
    x, y = frame.centres(seen[:, 0], seen[:, 1])
    plan.scatter(x, y, marker="s", s=70, color=RED, alpha=0.7, label="cells that are a thing")
    draw_robot(plan, _AT)
    plan.legend(loc="lower right", frameon=True)
    numbers = layer.config
    cells = seen[:, 0] * frame.columns + seen[:, 1]
    told = np.array(evidence)[:, cells]
    over_time.plot(told, color=BLUE, lw=1.0, alpha=0.6)
    over_time.axhline(numbers.enough, color=RED, ls="--", lw=1.0)
    over_time.text(0.3, numbers.enough + 0.4, "enough: a thing", color=RED)
    for scan, name in ((_COMES, "it comes"), (_GOES, "it goes")):
        over_time.axvline(scan - 0.5, color=GREY, lw=1.0)
        over_time.text(scan, numbers.most + 0.6, name, color=INK)
    over_time.set(xlabel="scan", ylabel="evidence of these cells", ylim=(0.0, numbers.most + 3.0))
    return figure
