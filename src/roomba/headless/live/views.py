"""What a page shows of a headless robot: snapshots of mission, map and sensors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.client.protocol import (
    CleanReport,
    ErrandOutcome,
    ExploreReport,
    MissedFloor,
    VacuumSnapshot,
)
from roomba.client.view import (
    MOST_PATH,
    NO_POINTS,
    GridLayer,
    HomeView,
    LowThingView,
    RobotView,
    RoomView,
    TruthView,
    ZoneView,
    battery_fills,
    battery_seconds,
    known_cells,
)
from roomba.geometry import Point
from roomba.grid import OccupancyMap
from roomba.headless.embodied import Embodied
from roomba.headless.live.live_home import LiveHome
from roomba.mission.cleaning.result import CleanResult
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones
from roomba.perception.swept.dirt_map import DirtMap
from roomba.shares import share_of
from roomba.vocabulary import Phase, word_of
from roomba.world.home.home import Home
from roomba.world.home.materials import MATERIALS
from roomba.world.home.raster import footprint, outline

_DIRTIEST: Final = 8000.0
"""Grains/m2 that are drawn as the dirtiest floor: sixteen times those of barely dirty floor."""


def robot_view(
    robot: Embodied, last: CleanReport | None, truth: TruthView | None = None
) -> RobotView:
    """Return the robot as it is now, by its own belief; the truth is told apart."""
    now, estimate = robot.now, robot.brain.keeper.place.estimate
    pose, mission = estimate.pose, robot.mission
    scan = robot.body.newest_scan()
    return RobotView(
        time=now.time,
        pose=(pose.x, pose.y, pose.theta),
        doubt="" if estimate.knowledge is Knowledge.KNOWN else estimate.reason,
        speed=abs(now.twist.linear),
        dirt=now.in_bin,
        held=_held(mission),
        vacuum=vacuum_snapshot(robot),
        scan=NO_POINTS if scan is None else scan.lidar.view(scan.ranges).ends_at(pose),
        path=_path(robot),
        last=last,
        battery_seconds=battery_seconds(now.battery.level, robot.battery_change),
        top_speed=robot.brain.max_speed,
        truth=truth,
        charges=battery_fills(now.battery.level, is_docked=now.battery.is_docked),
        bag=math.nan if now.emptying is None else now.emptying.bag,
    )


def vacuum_snapshot(robot: Embodied) -> VacuumSnapshot:
    """Return the state in the words of smart homes, and the progress of a clean.

    Its message is why the robot cannot be reached, or why it does not do what was asked.
    """
    mission, cleaning = robot.mission, robot.mission.cleaning
    covered = wanted = fraction = 0.0
    if cleaning is not None:
        covered = cleaning.ledger.clean_area
        wanted = cleaning.ledger.coverage.wanted_area
        fraction = share_of(covered, wanted)
    pose = robot.brain.pose
    phase, reason = mission.state.phase, robot.body.trouble or mission.reason
    return VacuumSnapshot(
        VACUUM_STATES[phase],
        phase.value,
        reason.text,
        mission.context.room_at(pose.x, pose.y),
        covered,
        wanted,
        fraction,
        mission.seconds_to_go(),
        robot.now.battery.level,
        mission.queue,
        mission.is_on_carpet,
        reason.hindrance,
        reason.looks_within,
        mission.queue_ways,
    )


def _held(mission: Mission) -> str:
    """Return why an emergency stop holds the drive; empty without one."""
    return mission.message or "emergency stop" if mission.state.phase is Phase.EMERGENCY else ""


def _path(robot: Embodied) -> NDArray[np.float32]:
    """Return what is left of the path that it drives, float32 [n, 2], m."""
    driver = robot.mission.driver
    if driver is None:
        return NO_POINTS
    return driver.tracker.rest[:MOST_PATH].astype(np.float32)


def dirt_cells(dirt: DirtMap) -> NDArray[np.uint8]:
    """Return how dirty the floor was found: 0 not known, 1 clean to 255 the dirtiest."""
    density = dirt.known()
    known = ~np.isnan(density)
    cells = np.zeros(dirt.frame.shape, np.uint8)
    cells[known] = 1 + np.minimum(254.0 * density[known] / _DIRTIEST, 254.0).astype(np.uint8)
    return cells


def dirt_layer(dirt: DirtMap, shape: int) -> GridLayer:
    """Return the dirt map to be drawn."""
    return GridLayer.over(dirt.frame, dirt_cells(dirt), shape)


def map_cells(plan: Home | None, occupancy: OccupancyMap) -> NDArray[np.uint8]:
    """Return the cells of the map; on a home's plan, furniture differs from walls."""
    cells = known_cells(occupancy)
    if plan is not None and plan.turned is None and occupancy.frame == plan.frame:
        cells[(cells == 2) & ~plan.walls] = 3
    return cells


def home_view(
    version: int,
    live_home: LiveHome,
    robot: Embodied,
    rooms: Rooms | None,
    zones: Zones,
) -> HomeView:
    """Return what seldom changes."""
    station, plan = robot.mission.context.station, live_home.plan
    height = robot.robot_config.body.height
    return HomeView(
        version=version,
        name=live_home.name,
        station=(station.x, station.y, station.theta),
        rooms=() if rooms is None else tuple(_room_views(rooms, plan)),
        zones=tuple(ZoneView(zone.name, zone.kind.value, zone.points) for zone in zones.all),
        furniture=() if plan is None else tuple(_outlines(plan, height, is_overhead=False)),
        radius=robot.robot_config.body.radius,
        tool=robot.robot_config.brush.width,
        overhead=() if plan is None else tuple(_outlines(plan, height, is_overhead=True)),
        carpets=() if plan is None else tuple(_carpets(plan)),
        felt_carpets=robot.mission.carpets.felt.all,
        low_things=tuple(
            LowThingView(offer.times, offer.corners)
            for offer in robot.mission.obstacles.offered_zones(zones)
        ),
    )


def _room_views(rooms: Rooms, home: Home | None) -> Iterator[RoomView]:
    for label, name in enumerate(rooms.names, 1):
        rings = tuple(_rings(rooms.outline(label)))
        anchor = rooms.anchor(label)
        room = None if home is None else home.room_at(*anchor)
        floor = "" if room is None else MATERIALS[room.floor].texture
        yield RoomView(name, rooms.area(label), anchor, rings, floor)


def _rings(outline: shapely.Polygon | shapely.MultiPolygon) -> Iterator[tuple[Point, ...]]:
    parts = outline.geoms if isinstance(outline, shapely.MultiPolygon) else (outline,)
    for part in parts:
        for ring in (part.exterior, *part.interiors):
            yield tuple((float(x), float(y)) for x, y in ring.coords)


def _outlines(home: Home, height: float, *, is_overhead: bool) -> Iterator[tuple[Point, ...]]:
    """Yield the outlines of the boxes of all furniture that the map shows, the lowest first.

    ``is_overhead``: the boxes below which a robot of ``height``, m, passes; else all others.
    """
    boxes = [box for piece in home.furniture if piece.on_map for box in piece.boxes]
    for box in sorted(boxes, key=lambda box: box.top):
        if (box.bottom >= height) is is_overhead:
            yield tuple((x, y) for x, y in footprint(box).exterior.coords[:-1])


def _carpets(home: Home) -> Iterator[tuple[Point, ...]]:
    for carpet in home.carpets:
        yield tuple((x, y) for x, y in outline(carpet.area).exterior.coords[:-1])


def clean_report(result: CleanResult) -> CleanReport:
    """Return how a clean ended."""
    return CleanReport(
        ErrandOutcome(result.outcome.value),
        result.message,
        result.covered,
        result.wanted,
        result.dirt,
        result.distance,
        result.duration,
        result.energy,
        tuple(
            MissedFloor(
                missed.area,
                missed.x,
                missed.y,
                missed.room,
                missed.reason.value,
                word_of(missed.reason),
            )
            for missed in result.missed
        ),
        result.times,
        result.rooms,
        result.open_edges,
    )


def exploration_report(result: ExploreResult) -> ExploreReport:
    """Return how an exploration ended."""
    return ExploreReport(
        ErrandOutcome(result.outcome.value),
        result.message,
        result.known,
        result.distance,
        result.duration,
        result.open_edges,
    )
