"""Compiles the hot loops once, so that the first start of the robot is as quick as later ones.

Numba keeps compiled functions in a cache on disk. ``./roomba`` runs this module when one is missing
there, and :mod:`roomba.commands.trials.warm` beside it. A plan here and a clean there are what a
robot needs first. Each of the two finds in the cache what the other has compiled, so each begins
with large loops that the other needs later. The functions ``others`` may wait, and are compiled
while the robot is used already: bursts, the camera, :mod:`roomba.commands.map.warm`.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from roomba.commands.compiling import compiled_functions_told
from roomba.configuration.mapping import MapChangesConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.perception.floors.map_changes import MapChanges
from roomba.perception.localization.localizer import Localizer
from roomba.perception.localization.search.particle_search import ParticleSearch
from roomba.perception.matching.scan_view import LidarModel, ScanView
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import segment
from roomba.planning.path.search.grid_path import shortest_grid_path
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import DirtSource, Home
from roomba.world.home.turned import turned_home
from roomba.world.lidar import Lidar
from roomba.world.simulator import Simulator


def main() -> None:
    """Cut a map into rooms, plan, and walk in a small room.

    The other process begins by making a robot.
    """
    home = _small_room()
    segment(home.map)
    robot = HeadlessMission(home)
    _plan(home, robot)
    robot.walk(2.4, 2.4)


def others() -> None:
    """Compile here what a first clean can do without."""
    home, config = _small_room(), SimulatedRobotConfig()
    simulator = Simulator(home, config)
    _take_pictures(home, config, simulator)
    for _ in range(40):
        simulator.step(Twist(0.5, 0.1), config.timing.world_step)
    _find_place(home, config, simulator)
    _look_for_changes(home, config, simulator)
    _cut_into_rooms()
    _plan_beside_slanted_walls(home)


def _plan(home: Home, robot: HeadlessMission) -> None:
    """Plan a clean, and ways, around a thing that the map does not show."""
    things, context = [(1.5, 1.0, 0.1)], robot.mission.context
    todo = np.ones(context.frame.shape, np.bool_)
    context.plan_coverage((0.8, 1.5), todo, things, edges_only=False, end=(0.8, 1.5))
    robot.brain.walking.planner(home.map).plan((1.0, 1.0), (2.0, 1.0), things)
    shortest_grid_path(np.ones((4, 4), np.bool_), (0, 0), (3, 3))


def _take_pictures(home: Home, config: SimulatedRobotConfig, simulator: Simulator) -> None:
    """Take a picture of each quality, and a scan."""
    scene = Scene.of(home)
    for supersampling in (1, 2):
        camera = Camera(scene, config.camera, supersampling)
        camera.render(home.station, 0.0, simulator.dirt.micrograms, simulator.dirt.frame)
    Lidar.of(home, config.lidar).scan(np.array([home.station.as_array()]))


def _find_place(home: Home, config: RobotConfig, simulator: Simulator) -> None:
    """Localize the robot on the map, and track it."""
    lidar = config.lidar
    localizer = Localizer(
        home.map, config.localization, config.gyro, config.body.radius, simulator.pose
    )
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    localizer.forget("warming up")
    for step in range(40):
        localizer.move(0.1 * step, Pose(), 0.0)
        localizer.see(0.1 * step, simulator.ranges, model)
    _find_place_while_driving(home, config, model.view(simulator.ranges))


def _find_place_while_driving(home: Home, config: RobotConfig, view: ScanView) -> None:
    """Localize a robot whose place is not clear from one scan."""
    search = ParticleSearch(SurfaceField.of(home.map), config.body.radius)
    search.see(view, Pose())
    search.see(view, Pose(0.5, 0.0, 0.0))


def _cut_into_rooms() -> None:
    """Cut a home with a deep doorway: the small room has none."""
    values = np.full((60, 140), OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    values[:, 60:80] = OCCUPIED
    values[20:36, 60:80] = FREE
    segment(OccupancyMap(GridFrame(0.05, 0.0, 0.0, *values.shape), values))


def _plan_beside_slanted_walls(home: Home) -> None:
    """Plan a clean where walls lie aslant on the map's grid."""
    turned = turned_home(home, math.radians(20.0))
    context = HeadlessMission(turned).mission.context
    begin = turned.axes.compose(Pose(0.8, 1.5))
    todo = np.ones(context.frame.shape, np.bool_)
    context.plan_coverage((begin.x, begin.y), todo, (), edges_only=False)


def _look_for_changes(home: Home, config: RobotConfig, simulator: Simulator) -> None:
    """Look from some places for differences between the home and the map."""
    lidar = config.lidar
    model = LidarModel.all_around(lidar.beams, lidar.min_range, lidar.max_range)
    changes = MapChanges(home.map, MapChangesConfig(look_way=0.1, look_time=1.0))
    for _ in range(60):
        seen = simulator.step(Twist(0.1, 1.0), 0.1)
        changes.see(seen.time, simulator.ranges, model.arrays(), seen.pose)
    changes.changes()


def _small_room() -> Home:
    frame = GridFrame(0.05, 0.0, 0.0, 60, 60)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    values[34:40, 30:42] = OCCUPIED
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
    with compiled_functions_told():
        others() if sys.argv[1:] == ["others"] else main()
