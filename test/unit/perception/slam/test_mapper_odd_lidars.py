"""Maps by any planar lidar and poor odometry: no wall is doubled, and the robot is not lost."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pytest
from fixtures.drives.made_lidars import Lidar, mapped, outlines
from fixtures.robots.mapped import CUPBOARD, FURNISHED, SHELF, wrong_cells
from fixtures.thoroughness import core_first

from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge

STRAY = 3
"""Cells of a map of 8,000 that may be wrong: beams two degrees apart, or that look one way only,
meet some once and never again. A doubled wall has dozens."""
WALLS = outlines((0.0, 0.0, 5.0, 4.0), CUPBOARD, SHELF)


@dataclass(frozen=True)
class Drive:
    """What is odd: the lidar, or odometry; and what the pose may be off by, m."""

    lidar: Lidar
    way_error: float = 0.0
    leap: float = 0.0
    shaken: float = 0.0
    most_off: float = 0.02


def around(time: float) -> Pose:
    """It stands for two seconds, and then drives around, turning to and fro."""
    time = max(time - 2.0, 0.0)
    angle = 0.25 * time
    heading = angle + 0.5 * math.pi + 0.3 * math.sin(1.1 * time)
    return Pose(2.5 + math.cos(angle), 2.0 + 0.9 * math.sin(angle), heading)


def degrees(fan: float, step: float = 1.0, **more: float) -> Lidar:
    return Lidar(fan=math.radians(fan), step=math.radians(step), **more)  # type: ignore[arg-type]


DRIVES = {
    "60 degrees, half a degree apart": Drive(degrees(60.0, 0.5, rate=10.0)),
    "60 degrees, a degree apart": Drive(degrees(60.0, 1.0, rate=10.0), most_off=0.03),
    "90 degrees, two degrees apart": Drive(degrees(90.0, 2.0, rate=10.0), most_off=0.03),
    "120 degrees": Drive(degrees(120.0, rate=10.0)),
    "180 degrees": Drive(degrees(180.0, rate=10.0)),
    "270 degrees, a quarter of a degree apart": Drive(
        degrees(270.0, 0.25, rate=20.0, farthest=30.0)
    ),
    "all around, two degrees apart": Drive(degrees(360.0, 2.0)),
    "clockwise, or upside down": Drive(degrees(360.0, -1.0)),
    "up to 4 m": Drive(Lidar(farthest=4.0)),
    "up to 80 m": Drive(Lidar(farthest=80.0)),
    "no farthest range": Drive(Lidar(farthest=math.inf)),
    "once a second": Drive(Lidar(rate=1.0)),
    "40 times a second": Drive(Lidar(rate=40.0)),
    "measured at once": Drive(Lidar(turns=False)),
    "no echo: nan": Drive(Lidar(no_echo=math.nan, missed=0.1)),
    "no echo: 0": Drive(Lidar(no_echo=0.0, missed=0.1)),
    "no echo: the farthest range": Drive(Lidar(no_echo=5.6, farthest=5.6, missed=0.1)),
    "no echo: beyond it": Drive(Lidar(no_echo=81.83, missed=0.1)),
    "no echo: below the nearest range": Drive(Lidar(no_echo=0.05, missed=0.1)),
    "off the middle": Drive(Lidar(mount=Pose(0.25, -0.1, 0.0))),
    "backwards": Drive(Lidar(mount=Pose(-0.1, 0.0, math.pi))),
    "15 cm from where it is told to be": Drive(
        Lidar(mount=Pose(0.15, -0.1, 0.0), told_mount=Pose(), turns=False)
    ),
    "odometry that is shaken": Drive(Lidar(turns=False), shaken=0.2, most_off=0.03),
    "odometry off by a tenth": Drive(Lidar(), way_error=0.1, most_off=0.04),
    "odometry off by a tenth, that leaps": Drive(
        degrees(180.0, rate=10.0), way_error=-0.1, leap=0.5, most_off=0.08
    ),
}


CORE = {
    "60 degrees, half a degree apart",
    "90 degrees, two degrees apart",
    "180 degrees",
    "clockwise, or upside down",
    "up to 4 m",
    "once a second",
    "no echo: nan",
    "no echo: 0",
    "no echo: below the nearest range",
    "off the middle",
    "15 cm from where it is told to be",
    "odometry that is shaken",
    "odometry off by a tenth, that leaps",
}


@pytest.mark.parametrize("name", core_first(DRIVES, CORE))
def test_it_makes_a_map_and_knows_where_it_is(name: str) -> None:
    drive = DRIVES[name]
    mapper, errors = mapped(
        drive.lidar, around, WALLS, 40.0, way_error=drive.way_error, leap=drive.leap,
        shaken=drive.shaken,
    )  # fmt: skip
    assert mapper.estimate.knowledge is Knowledge.KNOWN
    assert errors.worst < drive.most_off
    assert max(wrong_cells(mapper.finish(), FURNISHED)) <= STRAY
