"""Fills the arrays of worlds and robots as they are at the beginning, from a seed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.body import BodyConfig
from roomba.configuration.simulation import SimulatedRobotConfig, SimulatedWear
from roomba.errors import HomeError
from roomba.world.engine.layout import Layout, room_around
from roomba.world.engine.state.arrays import (
    DISC,
    FALL,
    MOST_DISCS,
    ROBOT,
    THING,
    WORLD,
    Dirt,
    Row,
    Rows,
    Solid,
    State,
)
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import Box, Home
from roomba.world.home.moving import Track, tracks_of

_WORLD, _TRACKS, _ROBOT, _PLACES, _WEAR, _PILE = range(6)
"""What a seed is used for, so that no two things get the same random numbers."""
_TRIES = 2000


def first_state(
    layout: Layout,
    homes: Sequence[Home],
    home_of_world: Sequence[int],
    config: SimulatedRobotConfig,
    seeds: Sequence[int],
    robots_per_home: int,
    max_speed: float,
) -> State:
    """Return worlds in which no time has passed; ``homes`` are those of the layout.

    Their robots all stand at (0, 0).
    """
    dirt = [_first_dirt(home) for home in homes]
    worlds = np.zeros(len(seeds), WORLD)
    falls: list[tuple[float, int]] = []
    things: list[tuple[float, ...]] = []
    tracks: list[Track] = []
    dirt_at = robots_at = tracks_at = 0
    for number, (home, seed) in enumerate(zip(home_of_world, seeds, strict=True)):
        world = worlds[number]
        world["random"] = _seed_bits(seed, _WORLD)
        world["home"] = home
        world["pull_x"], world["pull_y"] = _pull(config, seed)
        world["robots_at"], world["robots_end"] = robots_at, robots_at + robots_per_home
        world["dirt_at"], world["dirt_end"] = dirt_at, dirt_at + dirt[home].size
        world["brought_in"] = dirt[home].sum(dtype=np.int64)
        world["falls_at"], world["things_at"] = len(falls), len(things)
        world["discs_at"] = world["discs_end"] = number * MOST_DISCS
        falls += _first_falls(layout, home, seed)
        boxes_at = layout.boxes_at[home]
        for index, track in enumerate(tracks_of(homes[home].moving, _generator(seed, _TRACKS))):
            rows = tracks_at, tracks_at + len(track) - 1
            things.append((*track[0, 1:], 0.0, *rows, boxes_at[index], boxes_at[index + 1]))
            tracks.append(track)
            tracks_at += len(track)
        world["falls_end"], world["things_end"] = len(falls), len(things)
        robots_at, dirt_at = robots_at + robots_per_home, dirt_at + dirt[home].size
    robots = first_robots(config, seeds, robots_per_home, max_speed)
    swept = config.lidar.beams if config.is_swept else 0
    return State(
        homes=layout.homes,
        worlds=worlds,
        solid=Solid(
            cells=layout.cells,
            squares=layout.squares,
            faces=layout.faces,
            things=np.array(things, THING),
            boxes=layout.boxes,
            discs=np.zeros(len(seeds) * MOST_DISCS, DISC),
            robots=robots,
        ),
        dirt=Dirt(
            micrograms=np.concatenate([dirt[home] for home in home_of_world]),
            floors=layout.floors,
            falls=np.array(falls, FALL),
            sources=layout.sources,
        ),
        edges=layout.edges,
        tracks=np.concatenate([*tracks, np.zeros((0, 5))]),
        ranges=np.full((len(robots), config.lidar.beams), np.inf, np.float32),
        made=np.full((len(robots), swept), np.inf, np.float32),
        underway=np.full((len(robots), swept), np.inf, np.float32),
    )


def first_robots(
    config: SimulatedRobotConfig, seeds: Sequence[int], robots_per_home: int, max_speed: float
) -> Rows:
    """Return charged robots that stand at (0, 0), each with errors of its own."""
    robots = np.zeros(len(seeds) * robots_per_home, ROBOT)
    truth = config.simulation
    robots["charge"] = config.battery.capacity
    robots["temperature"] = truth.battery.ambient
    robots["max_speed"] = max_speed
    robots["brush_duty"], robots["fan_duty"] = config.brush.duty, config.fan.duty
    sizes = ("wheel_left_size", "wheel_right_size", "roll_left", "roll_right", "gyro_scale")
    for name in sizes:
        robots[name] = 1.0
    robots["track"] = config.body.wheel_separation
    for number, robot in enumerate(robots):
        seed = seeds[number // robots_per_home]
        purpose = (_ROBOT, number % robots_per_home)
        robot["random"] = _seed_bits(seed, *purpose)
        if truth.sensors == "noisy":
            left, right, scale, bias = _generator(seed, *purpose).standard_normal(4).tolist()
            robot["wheel_left_size"] += truth.wheels.scale_error * left
            robot["wheel_right_size"] += truth.wheels.scale_error * right
            robot["gyro_scale"] += truth.gyro.scale_error * scale
            robot["gyro_bias"] = truth.gyro.bias * bias
        if truth.condition == "worn":
            _wear(robot, truth.wear, _generator(seed, _WEAR, purpose[1]))
    return robots


def _wear(robot: Row, wear: SimulatedWear, random: np.random.Generator) -> None:
    """Give a robot the errors of worn wheels, of its gyro, and of how its lidar is screwed on."""
    left, right, base, gyro, x, y, turn = random.uniform(-1.0, 1.0, 7).tolist()
    robot["roll_left"] += wear.wheel * left
    robot["roll_right"] += wear.wheel * right
    robot["track"] *= 1.0 + wear.base * base
    robot["gyro_scale"] += wear.gyro * gyro
    robot["lidar_x"], robot["lidar_y"] = wear.lidar_shift * x, wear.lidar_shift * y
    robot["lidar_turn"] = np.radians(wear.lidar_turn) * turn


def _pull(config: SimulatedRobotConfig, seed: int) -> tuple[float, float]:
    """Return how far the carpets of a home carry a worn robot, m for each metre that it rolls."""
    if config.simulation.condition != "worn":
        return 0.0, 0.0
    pull, pile = config.simulation.wear.carpet_pull, _generator(seed, _PILE).uniform(-np.pi, np.pi)
    return float(pull * np.cos(pile)), float(pull * np.sin(pile))


def starts_of(
    homes: Sequence[Home], seeds: Sequence[int], robots_per_home: int, body: BodyConfig
) -> NDArray[np.float64]:
    """Return where robots start, float64 [robots, 3]: the first of each home at the station.

    The others stand at random places where such a body fits beside all that moves; raises HomeError
    if there is not enough room.
    """
    starts, radius = [], body.radius
    for home, seed in zip(homes, seeds, strict=True):
        docked = body.docked_at(home.station)
        taken = [(docked.x, docked.y, docked.theta)]
        if robots_per_home > 1:
            room = room_around(home.blocked, home.frame.resolution)
            rows, columns = np.nonzero(room > radius + 0.01)
            boxes = [box for thing in home.moving for box in thing.first_boxes]
            random = _generator(seed, _PLACES)
            for _ in range(_TRIES * robots_per_home if len(rows) else 0):
                if len(taken) == robots_per_home:
                    break
                cell = int(random.integers(len(rows)))
                x, y = home.frame.centre_of(int(rows[cell]), int(columns[cell]))
                theta = float(random.uniform(-np.pi, np.pi))
                away = min(np.hypot(x - other[0], y - other[1]) for other in taken)
                is_free = all(_distance(box, x, y) > radius + 0.01 for box in boxes)
                if is_free and away > 2.0 * radius + 0.05:
                    taken.append((x, y, theta))
            if len(taken) < robots_per_home:
                raise HomeError(
                    f"home {home.name}: expected room for {robots_per_home} robots, found it for "
                    f"{len(taken)}; ask for fewer"
                )
        starts.extend(taken)
    return np.array(starts, np.float64)


def _distance(box: Box, x: float, y: float) -> float:
    cosine, sine = np.cos(box.theta), np.sin(box.theta)
    dx, dy = x - box.x, y - box.y
    along = max(abs(cosine * dx + sine * dy) - 0.5 * box.length, 0.0)
    across = max(abs(cosine * dy - sine * dx) - 0.5 * box.width, 0.0)
    return float(np.hypot(along, across))


def _first_dirt(home: Home) -> NDArray[np.int32]:
    field = DirtField.of(home)
    for source in home.dirt_sources:
        if source.amount > 0.0:
            field.spread(source.x, source.y, source.radius, source.amount)
    return field.micrograms.ravel()


def _first_falls(layout: Layout, home: int, seed: int) -> list[tuple[float, int]]:
    first, last = layout.sources_at[home], layout.sources_at[home + 1]
    waits = layout.sources["mean_wait"][first:last]
    times = waits * _generator(seed, _WORLD).exponential(1.0, last - first)
    return list(zip(times.tolist(), range(first, last), strict=True))


def _generator(seed: int, *purpose: int) -> np.random.Generator:
    return np.random.default_rng([seed, *purpose])


def _seed_bits(seed: int, *purpose: int) -> np.uint64:
    return np.uint64(np.random.SeedSequence([seed, *purpose]).generate_state(1, np.uint64)[0])
