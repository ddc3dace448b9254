"""The stages of coverage planning, one after the other, over a home."""

from __future__ import annotations

from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from roomba.configuration.coverage import CoverageConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.planning.coverage.planner import CoveragePlanner
from roomba.plots.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    area_of,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home


@drawn
def picture_of_stages(home: Home) -> Figure:
    """Draw the floor, edges, swaths, and the one line of all pieces."""
    robot = SimulatedRobotConfig()
    reach = robot.body.radius + MissionConfig().driving.clearance
    planner = CoveragePlanner(
        home.map, reach, robot.brush.width, robot.tracking.sharp_corner, CoverageConfig()
    )
    start = (home.station.x, home.station.y)
    plan = planner.plan(start, start)
    figure = empty_figure(1150, 960)
    floor, edges, swaths, line = figure.subplots(2, 2).ravel()
    area = area_of(home)
    for axes in (floor, edges, swaths, line):
        show_floor_plan(axes, home, area)
    floor.imshow(
        planner.floor.fits,
        extent=(area[0], area[2], area[1], area[3]),
        origin="lower",
        cmap=ListedColormap(["#FFFFFF00", BLUE]),
        alpha=0.45,
    )
    floor.set_title("1. Where the middle fits")
    for axes, pieces, colour in ((edges, plan.edges, ORANGE), (swaths, plan.swaths, GREEN)):
        for piece in pieces:
            axes.plot(piece[:, 0], piece[:, 1], color=colour)
    edges.set_title(f"2. Edges: {len(plan.edges)} pieces")
    swaths.set_title(f"3. Swaths: {len(plan.swaths)} pieces in what edges leave")
    line.plot(plan.points[:, 0], plan.points[:, 1], color=INK, lw=1.0)
    line.set_title(f"4. Ordered, connected, polished, rounded: {plan.length:.0f} m")
    return figure
