"""Mapping: a strip of pictures of a map that grows while a robot explores, and its errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from roomba.commands.map.plot import area_of_maps, draw_map, draw_station, draw_way, picture_of
from roomba.commands.map.runs import run_trial
from roomba.commands.output import clock
from roomba.commands.trials.trial import Trial
from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Point, Pose
from roomba.grid import FREE, OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.plots.canvas import Picture
from roomba.plots.style import BLUE, INK, ORANGE, Area, draw_robot, drawn, empty_figure
from roomba.world.home.home import Home

_EVERY: Final = 20
"""Ticks between two looks."""
SHARES: Final = (0.02, 0.2, 0.45, 1.0)
"""Shares of the whole time at which the map is shown."""


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """The map at a time, s, where the robot takes itself to be, and what it goes to look at."""

    time: float
    occupancy: OccupancyMap
    pose: Pose
    goal: Point | None


@drawn
def picture_of_mapping(home: Home, seed: int = 1) -> Figure:
    """Draw the map of a home as it is at some times, and at the end."""
    looks, way = explored(home, seed)
    area = area_of_maps([looks[-1].occupancy])
    figure = empty_figure(1180, 350)
    panels = figure.subplots(1, len(SHARES), sharey=True)
    for axes, share in zip(panels, SHARES, strict=True):
        look = looks[round(share * (len(looks) - 1))]
        _draw(axes, look, way, area, is_last=look is looks[-1])
        axes.label_outer()
    figure.legend(
        handles=[
            Line2D([], [], color=BLUE, label="way"),
            Line2D([], [], ls="", marker="o", mfc="white", mec=INK, ms=9.0, label="robot"),
            Line2D([], [], ls="", marker="*", c=ORANGE, mec=INK, ms=13.0, label="looks there next"),
            Line2D([], [], ls="", marker="P", c="white", mec=INK, ms=11.0, label="station"),
        ],
        loc="outside lower center",
        ncols=4,
    )
    return figure


def picture_of_map_errors(home: Home, seed: int = 1) -> Picture:
    """Draw a shipped home's map with its errors, beside the one by odometry alone."""
    return picture_of(run_trial(Trial(home=home.name, seed=seed)))


def explored(home: Home, seed: int) -> tuple[list[Look], NDArray[np.float64]]:
    """Explore; return looks at the map, and rows of t (s), x, y (m), where it took itself to be."""
    robot = _Observed(home, seed=seed)
    record = robot.explore()
    end = robot.looks[-1]
    robot.looks.append(Look(end.time, record.occupancy, robot.brain.pose, None))
    return robot.looks, record.believed


class _Observed(HeadlessMission):
    """Keeps the map as it is now and then."""

    def __init__(self, home: Home, *, seed: int) -> None:
        super().__init__(home, seed=seed, known=MappingConfig(), longest_burst=0)
        self.looks: list[Look] = []
        self._ticks = 0

    def tick(self) -> None:
        super().tick()
        if self._ticks % _EVERY == 0:
            exploration = self.mission.exploration
            goal = exploration.goal if exploration is not None else None
            middle = goal.middle if goal is not None else None
            look = Look(self.seen.time, self.mapper.occupancy(), self.mapper.pose, middle)
            self.looks.append(look)
        self._ticks += 1


def _draw(axes: Axes, look: Look, way: NDArray[np.float64], area: Area, *, is_last: bool) -> None:
    draw_map(axes, look.occupancy)
    draw_way(axes, way[way[:, 0] <= look.time, 1:3])
    draw_station(axes, Pose(*way[0, 1:4].tolist()))
    draw_robot(axes, look.pose)
    if look.goal is not None:
        axes.plot(*look.goal, "*", c=ORANGE, mec=INK, ms=13.0, mew=0.8, zorder=8)
    axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    free = np.count_nonzero(look.occupancy.values == FREE) * look.occupancy.frame.resolution**2
    end = ", the end" if is_last else ""
    axes.set_title(f"{clock(look.time)}: {free:.0f} m²{end}")
