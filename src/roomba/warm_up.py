"""Compiles the hot loops once, so that the first start of the robot is as quick as every other.

Numba keeps what it compiled in a cache on disk; ``./roomba`` runs this after each build, and
:mod:`roomba.sim.warm`, for all that a clean needs, beside it.
"""

from __future__ import annotations

import numpy as np

from roomba.config import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.perception.localizer import Localizer
from roomba.perception.map_changes import MapChanges
from roomba.perception.rooms import segment
from roomba.perception.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba.perception.slam.mapping_config import MappingConfig
from roomba.planning.frontiers import frontiers, is_frontier
from roomba.planning.grid_path import shortest_grid_path
from roomba.planning.path import PathPlanner
from roomba.world.camera import Camera, Scene
from roomba.world.home import DirtSource, Home
from roomba.world.simulator import Simulator


def main() -> None:
    """Do a little of everything in a small room."""
    home = _small_room()
    config = RobotConfig()
    simulator = Simulator(home, config)
    for _ in range(40):
        simulator.step(Twist(0.5, 0.1), 0.025)
    _find_place(home, config, simulator)
    _make_map(home, config, simulator)
    segment(home.map)
    planner = PathPlanner(
        home.map, config.body.radius, config.walk.clearance, config.walk.tight_clearance
    )
    planner.plan((1.0, 1.0), (2.0, 2.0), [(1.5, 1.5, 0.1)])
    shortest_grid_path(np.ones((4, 4), np.bool_), (0, 0), (3, 3))
    scene = Scene.of(home)
    for supersampling in (1, 2):
        camera = Camera(scene, config.camera, supersampling)
        camera.render(home.station, 0.0, simulator.dirt.micrograms, simulator.dirt.frame)


def _find_place(home: Home, config: RobotConfig, simulator: Simulator) -> None:
    """Look for the robot in the map, and follow it."""
    lidar = config.lidar
    localizer = Localizer(
        home.map, config.localization, config.gyro, config.body.radius, simulator.pose
    )
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    localizer.forget("nobody told")
    for step in range(40):
        localizer.move(0.1 * step, Pose(), 0.0)
        localizer.see(0.1 * step, simulator.ranges, model)


def _make_map(home: Home, config: RobotConfig, simulator: Simulator) -> None:
    """Map the room from a few places, look where to go next, and for what has changed."""
    lidar = config.lidar
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    mapper = Mapper(
        MappingConfig(submap_keyframes=4), config.localization, config.gyro, simulator.pose
    )
    changes = MapChanges(home.map)
    for _ in range(60):
        seen = simulator.step(Twist(0.1, 1.0), 0.1)
        mapper.move(seen.time, seen.odometry, seen.angular_velocity)
        mapper.see(seen.time, simulator.ranges, model)
        changes.see(seen.time, simulator.ranges, model.arrays(), mapper.pose)
    changes.changes()
    mapper.finish()
    frame, values = home.map.frame, home.map.values.copy()
    values[20:30, 20:30] = UNKNOWN
    half_known = OccupancyMap(frame, values)
    frontiers(half_known, values == FREE, (2.0, 2.0))
    is_frontier(half_known, (1.0, 1.0), 0.2)


def _small_room() -> Home:
    frame = GridFrame(0.05, 0.0, 0.0, 60, 60)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    solid = values != FREE
    return Home(
        name="small room",
        map=OccupancyMap(frame, values),
        solid=solid,
        walls=solid,
        station=Pose(0.5, 1.5, 0.0),
        dirt_sources=(DirtSource("crumbs", 1.0, 1.5, 0.2, 1.0, 0.0),),
    )


if __name__ == "__main__":
    main()
