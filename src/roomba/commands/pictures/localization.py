"""Localization: the error over time beside that of odometry, and relocation on the map."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roomba.commands.pictures.tours import tour_of
from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.search.relocation import Relocation, Verdict
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
    show_floor_plan,
)
from roomba.robot.look_around import LookAround
from roomba.world.home.home import Home
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator

_TICK = 0.05
"""s; between two looks at the sensors."""
_SET_DOWN = Pose(6.3, 7.9, 2.0)
"""A place in the reference room whose corners all look alike, far from the station."""


@drawn
def picture_of_localization(home: Home, minutes: float = 10.0) -> Figure:
    """Draw how far off the robot takes itself to be on walks through the home, over time."""
    tour = tour_of(home, 60.0 * minutes, seed=3)
    figure = empty_figure(1150, 420)
    axes = figure.subplots()
    for name, colour, poses in (
        ("by the wheels alone", ORANGE, tour.by_wheels),
        ("by wheels and gyro", GREEN, tour.by_gyro),
        ("by wheels, gyro and lidar on the map", BLUE, tour.believed),
    ):
        off = 1000.0 * np.hypot(*(poses[:, :2] - tour.true[:, :2]).T)
        label = f"{name}:\nmedian {np.median(off):.1f} mm, most {off.max():.0f} mm"
        axes.plot(tour.times / 60.0, np.maximum(off, 0.1), color=colour, label=label)
    axes.set_yscale("log")
    axes.set(xlabel="time, minutes", ylabel="error of the place, mm")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
    return figure


@drawn
def picture_of_relocation(home: Home, set_down: Pose = _SET_DOWN) -> Figure:
    """Draw the places that fit what is in sight, at once and after looking around a little."""
    config = SimulatedRobotConfig().with_lidar(EXACT_LIDAR)
    world = Simulator(home, config, seed=2, start=set_down)
    lidar = LidarModel.all_around(
        config.lidar.beams, config.lidar.min_range, config.lidar.max_range
    )
    reckoning = DeadReckoning(config.localization, config.gyro)
    looks = LookAround(config.body, config.looking_around)
    seen = world.step(Twist(), 2.0 * _TICK)
    reckoning.move(seen.time, seen.odometry, seen.angular_velocity)
    view = lidar.view(world.ranges)
    field = SurfaceField.of(home.map)
    relocation = Relocation(field, config.localization, config.body.radius, view, reckoning.pose)
    while relocation.verdict is Verdict.SEARCHING:
        relocation.advance()
    figure = empty_figure(1150, 620)
    panels = list(figure.subplots(1, 2))
    _draw_places(panels[0], home, relocation, reckoning.pose, seen)
    while relocation.verdict is not Verdict.FOUND and seen.time < 30.0:
        twist = looks.tick(seen.time, reckoning.pose, view.ends, seen.bumper.pressed)
        world.advance(twist, 0.5 * _TICK, 2)
        seen = world.observe()
        reckoning.move(seen.time, seen.odometry, seen.angular_velocity)
        view = lidar.view(world.ranges)
        relocation.see(view, reckoning.pose)
    _draw_places(panels[1], home, relocation, reckoning.pose, seen)
    return figure


def _draw_places(
    axes: Axes, home: Home, relocation: Relocation, reckoned: Pose, seen: Observation
) -> None:
    show_floor_plan(axes, home, area_of(home))
    best = relocation.hypotheses[0].evidence
    for hypothesis in reversed(relocation.hypotheses):
        likelihood = math.exp(max(hypothesis.evidence - best, -6.0) / 3.0)
        pose = hypothesis.frame.compose(reckoned)
        ahead = pose.compose(Pose(0.45, 0.0, 0.0))
        axes.annotate(
            "",
            (ahead.x, ahead.y),
            (pose.x, pose.y),
            arrowprops={"arrowstyle": "-|>", "color": RED, "alpha": likelihood, "linewidth": 2.0},
        )
    draw_robot(axes, seen.pose, INK)
    is_found = relocation.verdict is Verdict.FOUND
    places = "one is believed" if is_found else f"{len(relocation.hypotheses)} places fit"
    axes.set_title(f"{seen.time:.1f} s after it was set down: {places}")
