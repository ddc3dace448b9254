"""The bumper: which half a contact presses, and for how long."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Wedge

from roomba.commands.pictures.sensors.drives import DriveRecording
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    draw_signals,
    drawn,
    empty_figure,
    side_by_side,
    stacked,
)
from roomba.world.home.home import Home
from roomba.world.observation import Bumper
from roomba.world.simulator import Simulator

_POST = 0.05
"""m; radius of what it runs into."""
_START_GAP = 0.02
"""m; between body and post before they touch."""
_KINDS = {
    Bumper(True, False): (BLUE, "left"),
    Bumper(True, True): (GREEN, "both"),
    Bumper(False, True): (ORANGE, "right"),
    Bumper(False, False): (GREY, "none"),
}


@drawn
def picture_of_bumper(home: Home, posts: int = 180) -> Figure:
    """Draw what a contact presses by its direction, and a bump over time."""
    figure = empty_figure(1050, 480)
    left, right = side_by_side(figure, [1.0, 1.15])
    _draw_directions(left.subplots(), home, posts)
    _draw_bump(stacked(right, 3, [1.0, 1.0, 0.8]), home)
    return figure


def _draw_directions(axes: Axes, home: Home, posts: int) -> None:
    world = Simulator(home)
    middle = _middle_of(home)
    radius = world.config.body.radius
    contacts: dict[Bumper, list[float]] = {kind: [] for kind in _KINDS}
    for angle in np.linspace(-math.pi, math.pi, posts, endpoint=False):
        contact = _contact(world, middle, float(angle))
        if contact is not None:
            contacts[contact[1]].append(contact[0])
    axes.add_patch(Circle((0.0, 0.0), 1000.0 * radius, facecolor="#F3F4F6", edgecolor=INK))
    for kind, (colour, name) in _KINDS.items():
        angles = np.array(contacts[kind])
        # The robot looks up.
        axes.plot(
            -1150.0 * radius * np.sin(angles),
            1150.0 * radius * np.cos(angles),
            "o",
            color=colour,
            markersize=5.0,
            label=name,
        )
    axes.add_patch(
        Wedge((0.0, 0.0), 1000.0 * radius, 0.0, 180.0, width=14.0, facecolor=INK, alpha=0.75)
    )
    axes.annotate("ahead", (0.0, 100.0), (0.0, 20.0), ha="center", arrowprops={"arrowstyle": "->"})
    limit = 1350.0 * radius
    axes.set(xlim=(-limit, limit), ylim=(-limit, limit), xlabel="mm to the right")
    axes.set(ylabel="mm ahead", aspect="equal")
    axes.set_title("Half pressed, by the direction of the contact")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=4)


def _contact(world: Simulator, middle: Pose, angle: float) -> tuple[float, Bumper] | None:
    """Run into a post in a direction, rad; return where it was touched, and what that pressed."""
    world.remove_obstacles()
    world.put(middle)
    world.advance(Twist(), 0.01, 100)
    away = world.config.body.radius + _POST + _START_GAP
    post = middle.x + away * math.cos(angle), middle.y + away * math.sin(angle)
    world.place_obstacle(*post, _POST)
    speed = math.copysign(0.1, math.cos(angle))
    for _ in range(500):
        world.advance(Twist(speed, 0.0), 0.01, 1)
        if world.numbers["hit"] > 0.0:
            return world.pose.bearing_to(*post), world.observe().bumper
    return None


def _draw_bump(panels: list[Axes], home: Home) -> None:
    config = SimulatedRobotConfig()
    radius = config.body.radius
    middle = _middle_of(home)
    world = Simulator(home, config, start=middle)
    post = middle.compose(Pose(0.5, 0.08, 0.0))
    world.place_obstacle(post.x, post.y, _POST)
    recording = DriveRecording(
        world, {"gap": lambda now: now.pose.distance_to(post.x, post.y) - radius - _POST}
    )
    recording.drive(Twist(0.2, 0.0), 2.4)
    recording.drive(Twist(-0.05, 0.0), 1.2)
    time = recording.of("time")
    speed, distance, signals = panels
    speed.plot(time, recording.of("odometry_linear"), color=ORANGE, label="by the encoders")
    speed.plot(time, recording.of("ground_linear"), color=INK, label="true")
    speed.set(ylabel="speed, m/s")
    speed.legend(loc="upper right")
    speed.set_title("A bump at 0.2 m/s, and backing off")
    distance.plot(time, 1000.0 * recording.of("gap"), color=INK)
    distance.set(ylabel="gap, mm", ylim=(-2.0, 30.0))
    halves = {name: recording.of(f"bumper_{name}") for name in ("left", "right")}
    draw_signals(signals, time, halves)
    signals.set(xlabel="time, s", xlim=(0.8, time[-1]))


def _middle_of(home: Home) -> Pose:
    x_min, x_max, y_min, y_max = home.frame.extent
    return Pose(0.5 * (x_min + x_max), 0.5 * (y_min + y_max), 0.0)
