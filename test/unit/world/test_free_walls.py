"""Slanted and round walls, glass and mirrors, as bodies and sensors meet them: by plain geometry.

The reference for the bay is a true circle, so that the chain of pieces is measured as well.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from fixtures.homes.free_walls import home_with, room_outline, straight_wall, way_to
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, IDEAL
from fixtures.thoroughness import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st

from roomba.configuration.sensors import CameraConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.grid import GridFrame
from roomba.world.camera.camera import Camera, Scene
from roomba.world.engine.state.arrays import Infrared
from roomba.world.home.free_wall import FreeWall, FreeWalls, arc_outline, counter_clockwise
from roomba.world.home.home import Home
from roomba.world.home.surface import LOW
from roomba.world.home.turned import turned_home, with_steps
from roomba.world.layers.layer import load_home
from roomba.world.lidar import Lidar
from roomba.world.simulator import Simulator

RADIUS = IDEAL.body.radius
CAMERA = CameraConfig(width=160, height=120)
NEATO = SimulatedRobotConfig().with_lidar("neato").with_sensors("ideal")
angles = st.floats(-math.pi, math.pi)

CENTRE, ROUND = (3.4, 2.0), 1.3
"""A half circle that opens to the west, of this inner radius."""


def bay_home() -> Home:
    """A room with a round wall and a slanted one in it."""
    whole = arc_outline(CENTRE, ROUND + 0.05, -0.5 * math.pi, 0.5 * math.pi, 0.1)
    middle = [
        (CENTRE[0] + (ROUND + 0.05) * math.cos(a), CENTRE[1] + (ROUND + 0.05) * math.sin(a))
        for a in np.linspace(-0.5 * math.pi, 0.5 * math.pi, 91)
    ]
    arc = FreeWall(counter_clockwise(whole), tuple(middle), 0.1)
    return home_with([arc, straight_wall([(0.3, 2.6), (1.4, 3.7)], thickness=0.1)])


BAY = bay_home()


def outlines(off: float = 0.0) -> list[shapely.Geometry]:
    """The same room drawn plainly, its circles with four thousand corners, ``off`` m smaller."""
    circle = [
        shapely.Point(CENTRE).buffer(radius - off, quad_segs=1000).exterior
        for radius in (ROUND, ROUND + 0.1)
    ]
    east = shapely.box(CENTRE[0], 0.0, 5.0, 4.0)
    half = [shapely.intersection(ring, east) for ring in circle]
    ends = [
        shapely.LineString(
            [(CENTRE[0], CENTRE[1] + s * ROUND), (CENTRE[0], CENTRE[1] + s * (ROUND + 0.1))]
        )
        for s in (-1.0, 1.0)
    ]
    slanted = shapely.LineString([(0.3, 2.6), (1.4, 3.7)]).buffer(0.05, cap_style="flat").exterior
    return [*room_outline(), *half, *ends, slanted]


LINES = outlines()
SMALLER = outlines(5e-4)
"""As far off the circles as docs/homes.md promises: a chord of a circle lies within it."""
SINGLE = 1e-5
"""m; what single precision, and a circle of four thousand corners, are off: 3e-6 was measured."""


def expected_way(x: float, y: float, direction: float) -> float | None:
    """The way of a ray; None if it grazes a corner: right beside it another goes elsewhere."""
    way = way_to(LINES, x, y, direction)
    beside = [way_to(LINES, x, y, direction + off) for off in (-1e-3, 1e-3)]
    return way if all(abs(each - way) < 0.02 for each in beside) else None


@settings(max_examples=examples(12), deadline=None)
@example(x=1.65625, y=1.203125, theta=1.20703125, turn=0.0)
@given(x=st.floats(1.5, 3.6), y=st.floats(1.2, 2.8), theta=angles, turn=st.sampled_from([0.0, 0.6]))
def test_lidars_meet_slanted_walls_and_round_ones_within_half_a_millimetre_of_their_circle(
    x: float, y: float, theta: float, turn: float
) -> None:
    """Across the wall: along a beam that meets it at a slant, the same half millimetre is more."""
    home = turned_home(BAY, turn) if turn else BAY
    pose = Pose(0.0, 0.0, turn).compose(Pose(x, y, theta))
    alone = Lidar.of(home, IDEAL.lidar).scan(np.array([[pose.x, pose.y, pose.theta]]))[0]
    seen = [alone]
    for config in (IDEAL, NEATO):
        world = Simulator(home, config, start=pose)
        while not world.observe().scans:
            world.step(Twist(), DT)
        seen.append(world.ranges)
    compared = 0
    for beam in range(0, 360, 5):
        direction = theta + math.radians(beam)
        way, inner = expected_way(x, y, direction), way_to(SMALLER, x, y, direction)
        # One that grazes the smaller circle alone may pass a piece, too.
        if way is not None and abs(way - inner) < 0.02:
            for ranges in seen:
                assert min(way, inner) - SINGLE <= ranges[beam] <= max(way, inner) + SINGLE
            compared += 1
    assert compared > 40


@settings(max_examples=examples(12), deadline=None)
@given(theta=angles, turns=st.floats(-0.6, 0.6), turn=st.sampled_from([0.0, -0.8]))
def test_the_round_body_comes_to_rest_at_round_and_slanted_walls(
    theta: float, turns: float, turn: float
) -> None:
    home = turned_home(BAY, turn) if turn else BAY
    world = Simulator(home, IDEAL, start=Pose(0.0, 0.0, turn).compose(Pose(2.6, 2.0, theta)))
    for _ in range(60):
        world.advance(Twist(0.3, turns), DT, 8)
        at = Pose(0.0, 0.0, turn).inverse().compose(world.pose)
        away = min(shapely.distance(shapely.Point(at.x, at.y), line) for line in LINES)
        # A chord of the round wall stands before the circle.
        assert away > RADIUS - 1e-5
        assert world.gap == pytest.approx(min(away - RADIUS, RADIUS), abs=6e-4)
        if world.observe().bumper.pressed:
            assert away < RADIUS + 2e-3
    assert world.numbers["hits"] > 0.0 or abs(turns) > 0.2


@settings(max_examples=examples(8), deadline=None)
@given(x=st.floats(1.6, 3.2), y=st.floats(1.4, 2.6), theta=angles, turn=st.sampled_from([0.0, 1.0]))
def test_the_camera_sees_round_and_slanted_walls(
    x: float, y: float, theta: float, turn: float
) -> None:
    home = turned_home(BAY, turn) if turn else BAY
    camera = Camera(Scene.of(home), CAMERA, supersampling=1)
    pose = Pose(x, y, theta)
    lens = pose.compose(Pose(CAMERA.mount_forward, 0.0, 0.0))
    level = camera.depth(Pose(0.0, 0.0, turn).compose(pose), 0.0)[CAMERA.height // 2 - 1]
    compared = 0
    for column in range(0, CAMERA.width, 9):
        aside = math.atan2(0.5 * CAMERA.width - column - 0.5, camera.focal)
        way = expected_way(lens.x, lens.y, lens.theta + aside)
        if way is not None:
            assert level[column] == pytest.approx(way * math.cos(aside), abs=4e-3)
            compared += 1
    assert compared > 8


@pytest.mark.parametrize("material", ["glass", "mirror", None])
def test_glass_and_mirrors_stop_the_body_as_any_wall(material: str | None) -> None:
    pane = straight_wall([(2.0, 0.5), (2.6, 3.5)], material, 0.02)
    world = Simulator(home_with([pane]), IDEAL, start=Pose(1.0, 2.0, 0.0))
    world.advance(Twist(0.3, 0.0), DT, 200)
    away = shapely.distance(pane.polygon, shapely.Point(world.pose.x, world.pose.y))
    assert away == pytest.approx(RADIUS, abs=1e-6)
    assert world.observe().bumper.pressed


def test_lidars_look_over_what_is_low_and_the_bumper_feels_it() -> None:
    sill = replace(straight_wall([(2.0, 0.5), (2.0, 3.5)], None, 0.04), surface=LOW)
    bare, home = home_with([]), home_with([sill])
    pose = Pose(1.0, 2.0, 0.0)
    for config in (IDEAL, NEATO):
        scans = []
        for each in (bare, home):
            world = Simulator(each, config, start=pose)
            while not world.observe().scans:
                world.step(Twist(), DT)
            scans.append(np.array(world.ranges))
        # A ray that goes on adds up two ways, in single precision.
        assert np.allclose(scans[0], scans[1], rtol=0.0, atol=1e-5, equal_nan=True)
    expected, seen = (
        Lidar.of(each, IDEAL.lidar).scan(np.array([[pose.x, pose.y, pose.theta]]))
        for each in (bare, home)
    )
    assert np.allclose(seen, expected, rtol=0.0, atol=1e-5)
    world = Simulator(home, IDEAL, start=pose)
    world.advance(Twist(0.3, 0.0), DT, 200)
    assert world.pose.x == pytest.approx(2.0 - 0.02 - RADIUS, abs=1e-6)
    assert world.observe().bumper.pressed


@pytest.mark.parametrize(
    ("material", "is_received"), [("glass", True), ("low", True), (None, False)]
)
def test_walls_but_not_glass_hide_the_station(material: str | None, is_received: bool) -> None:
    pane = straight_wall([(2.0, 0.3), (2.4, 1.7)], None if material == "low" else material, 0.02)
    if material == "low":
        pane = replace(pane, surface=LOW)
    home = room_home(station=Pose(3.5, 1.0, 0.0))
    home = with_steps(replace(home, free_walls=FreeWalls.on(home.frame, [pane])))
    world = Simulator(home, IDEAL, start=Pose(3.0, 1.0, 0.0))
    assert world.step(Twist(), DT).infrared != Infrared(0)
    far = SimulatedRobotConfig.model_validate(
        {**IDEAL.model_dump(), "station": {**IDEAL.station.model_dump(), "beam": 3.0}}
    )
    behind = Simulator(home, far, start=Pose(1.5, 1.0, 0.0))
    assert (behind.step(Twist(), DT).infrared != Infrared(0)) == is_received


def test_the_camera_looks_through_glass_and_at_a_mirror() -> None:
    pose = Pose(1.0, 2.0, 0.0)
    depths = {}
    for material in ("glass", "mirror", None):
        walls = [] if material is None else [straight_wall([(3.0, 0.5), (3.0, 3.5)], material)]
        home = home_with(walls)
        camera = Camera(Scene.of(home), CAMERA, supersampling=1)
        depths[material] = camera.depth(pose, 0.0)[CAMERA.height // 2 - 5, CAMERA.width // 2]
        dirt = np.zeros((1, 1), np.int32)
        picture = camera.picture(pose, 0.0, dirt, GridFrame(1.0, 0.0, 0.0, 1, 1))
        assert picture.std() > 1.0
    assert depths["glass"] == depths[None]
    assert depths["mirror"] == pytest.approx(3.0 - 0.015 - 1.0 - CAMERA.mount_forward, abs=1e-3)


def test_no_dirt_lies_where_a_free_wall_stands() -> None:
    world = Simulator(load_home("bay", HOMES))
    home = world.home.exact
    assert home.free_walls is not None
    assert not world.dirt.micrograms[home.free_walls.touched].any()
    assert world.dirt.micrograms.any()
