"""The newest messages of the graph that a page shows, and which of them are new."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from numpy.typing import NDArray
from roomba_robot.msg import (
    CarpetArray,
    CleanActionResult,
    EmptyingStation,
    ExploreActionResult,
    LineTrouble,
    Localization,
    LowThingArray,
    MapUpdate,
    RoomArray,
    SimHome,
    ZoneArray,
)
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Float32, String
from tf2_msgs.msg import TFMessage

from roomba.client.protocol import CleanReport, RobotUnavailableError, VacuumSnapshot
from roomba.client.view import (
    NO_POINTS,
    ChangeView,
    GridLayer,
    HomeView,
    LayerName,
    LowThingView,
    RoomView,
    TruthView,
    ZoneView,
)
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Point, Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.robot.readings import ScanReading
from roomba.vocabulary import NO_REASON
from roomba_ros.convert.client import doubt_of, line_trouble_of
from roomba_ros.convert.common import pose_in_map
from roomba_ros.convert.mounts import Mounts, transforms_of
from roomba_ros.convert.page import (
    ToldHome,
    battery_seconds_of,
    carpets_of,
    changes_of,
    charges_of,
    clean_report_of,
    covered_cells_of,
    dirt_cells_of,
    exploration_report_of,
    known_cells_of,
    low_things_of,
    room_views_of,
    shown_path_of,
    sim_dirt_of,
    sim_home_of,
    zone_views_of,
)
from roomba_ros.convert.readings import bag_of
from roomba_ros.convert.scan import ScanDecoder
from roomba_ros.convert.values import data_of, number_of
from roomba_ros.runtime.held_drive import HeldDrive
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.senders import (
    SELDOM_SILENT_AFTER,
    SUPERVISOR,
    OneSender,
    OnlyFrom,
)
from roomba_ros.runtime.subscriptions import subscribe

_OLDEST_POSE: Final = 2.0
"""s of wall time; the pose comes 20 times a second."""


class PageTopics:
    """The newest of each topic.

    Subscribes: ``pose``, ``localization``, ``speed``, ``bin_level``, ``emptying_station``,
    ``battery_state``, ``emergency_stop``, ``scan``, ``plan``, ``map``, ``coverage_map``,
    ``dirt_map``, ``rooms``, ``zones``, ``carpets``, ``station_pose``, ``trouble``,
    ``line_trouble``, ``map/update``, ``clean/result``, ``explore/result``, ``/tf_static``; of a
    simulation also ``sim/pose``, ``sim/home`` and ``sim/dirt``.
    """

    def __init__(self, config: RobotConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._lock = threading.Lock()
        self._pose: Pose | None = None
        self._pose_heard = -math.inf
        self._true_pose: Pose | None = None
        self._true_pose_heard = -math.inf
        self._true_home: ToldHome | None = None
        self._scan: ScanReading | None = None
        self._path = NO_POINTS
        self._home = HomeView(
            0, "home", (0.0, 0.0, 0.0), (), (), (), config.body.radius, config.brush.width
        )
        self._layers: dict[LayerName, GridLayer] = {}
        self.doubt, self.trouble, self.unreached = "", "", NO_REASON
        self.held = HeldDrive()
        self.last: CleanReport | None = None
        self.speed, self.in_bin, self.battery_seconds = 0.0, 0.0, math.nan
        self.charges = False
        self.bag = math.nan
        self._mounts = Mounts()
        self._decoder = ScanDecoder.on_robot(self._mounts, frame_id("base_link"))

    def start(self) -> None:
        """Connect."""
        subscribe("/tf_static", TFMessage, transforms_of, self._mounts.add, queue_size=10)
        subscribe("pose", PoseStamped, pose_in_map, self._on_pose)
        doubt = partial(self._set, "doubt")
        subscribe("localization", Localization, doubt_of, doubt, senders=_one())
        subscribe("speed", Float32, number_of, partial(self._set, "speed"))
        subscribe("bin_level", Float32, number_of, self._on_bin_level, senders=_one())
        bag = partial(self._set, "bag")
        subscribe("emptying_station", EmptyingStation, bag_of, bag, senders=_one())
        seconds, charges = partial(self._set, "battery_seconds"), partial(self._set, "charges")
        subscribe("battery_state", BatteryState, battery_seconds_of, seconds, senders=_one())
        subscribe("battery_state", BatteryState, charges_of, charges, senders=_one())
        supervisor = OnlyFrom(SUPERVISOR)
        subscribe("trouble", String, data_of, partial(self._set, "trouble"), senders=supervisor)
        subscribe("line_trouble", LineTrouble, line_trouble_of, partial(self._set, "unreached"))
        self.held.start()
        subscribe("scan", LaserScan, self._decoder.decode, self._on_scan)
        subscribe("plan", Path, shown_path_of, self._on_path)
        subscribe("station_pose", PoseStamped, pose_in_map, self._on_station)
        subscribe("rooms", RoomArray, room_views_of, self._on_rooms)
        subscribe("zones", ZoneArray, zone_views_of, self._on_zones)
        subscribe("low_things", LowThingArray, low_things_of, self._on_low_things)
        subscribe("carpets", CarpetArray, carpets_of, self._on_carpets)
        subscribe("map/update", MapUpdate, changes_of, self._on_changes)
        subscribe("clean/result", CleanActionResult, clean_report_of, self._on_report)
        subscribe("explore/result", ExploreActionResult, exploration_report_of, self._on_report)
        layers: tuple[tuple[str, LayerName, Callable[[Any], OccupancyMap]], ...] = (
            ("map", LayerName.MAP, known_cells_of),
            ("coverage_map", LayerName.COVERAGE, covered_cells_of),
            ("dirt_map", LayerName.DIRT, dirt_cells_of),
        )
        for topic, name, convert in layers:
            subscribe(topic, OccupancyGrid, convert, partial(self._on_layer, name))
        subscribe("sim/pose", PoseStamped, pose_in_map, self._on_true_pose)
        subscribe("sim/home", SimHome, sim_home_of, partial(self._set, "_true_home"))
        subscribe("sim/dirt", OccupancyGrid, sim_dirt_of, self._on_true_dirt)

    def pose(self) -> Pose:
        """Return where the robot is; raises RobotUnavailableError when it does not tell."""
        silent = time.monotonic() - self._pose_heard
        if self._pose is None:
            raise RobotUnavailableError("nothing came on /pose yet: the robot is starting")
        if silent > _OLDEST_POSE:
            raise RobotUnavailableError(
                f"nothing came on /pose for {silent:.0f} s; is the robot running (`./roomba run`)?"
            )
        return self._pose

    def truth(self) -> TruthView | None:
        """Return the simulation's truth; None without a simulation."""
        is_old = time.monotonic() - self._true_pose_heard > _OLDEST_POSE
        pose, home = self._true_pose, self._true_home
        if pose is None or home is None or is_old:
            return None
        return TruthView((pose.x, pose.y, pose.theta), *home)

    def home(self) -> HomeView:
        """Return rooms, zones and station."""
        with self._lock:
            return self._home

    def reached(self, vacuum: VacuumSnapshot) -> VacuumSnapshot:
        """Return a state with why the robot is unreachable: its mission does not know that."""
        why = self.unreached
        return replace(vacuum, message=why.text, hindrance=why.hindrance) if why else vacuum

    def layer(self, name: LayerName) -> GridLayer | None:
        """Return the newest grid of a layer."""
        with self._lock:
            return self._layers.get(name)

    def path(self) -> NDArray[np.float32]:
        """Return the present plan, float32 [n, 2], m."""
        return self._path

    def scan_at(self, pose: Pose) -> NDArray[np.float32]:
        """Return where beams of the newest scan end, float32 [n, 2], m, as seen from a pose."""
        scan = self._scan
        if scan is None:
            return NO_POINTS
        return scan.lidar.view(scan.ranges).ends_at(pose)

    def _set(self, name: str, value: object) -> None:
        setattr(self, name, value)

    def _on_pose(self, pose: Pose) -> None:
        self._pose, self._pose_heard = pose, time.monotonic()

    def _on_true_pose(self, pose: Pose) -> None:
        self._true_pose, self._true_pose_heard = pose, time.monotonic()

    def _on_bin_level(self, level: float) -> None:
        self.in_bin = level * self._config.brush.bin_capacity

    def _on_scan(self, scan: ScanReading) -> None:
        self._scan = scan

    def _on_report(self, report: CleanReport | None) -> None:
        self.last = report or self.last

    def _on_path(self, path: NDArray[np.float32]) -> None:
        self._path = path

    def _on_station(self, pose: Pose) -> None:
        self._change(station=(pose.x, pose.y, pose.theta))

    def _on_rooms(self, rooms: tuple[RoomView, ...]) -> None:
        self._change(rooms=rooms)

    def _on_zones(self, zones: tuple[ZoneView, ...]) -> None:
        self._change(zones=zones)

    def _on_low_things(self, things: tuple[LowThingView, ...]) -> None:
        self._change(low_things=things)

    def _on_carpets(self, carpets: tuple[tuple[Point, ...], ...]) -> None:
        self._change(felt_carpets=carpets)

    def _on_changes(self, changes: tuple[ChangeView, ...]) -> None:
        self._change(changes=changes)

    def _change(self, **changes: Any) -> None:
        with self._lock:
            before = self._home
            self._home = replace(before, version=before.version + 1, **changes)

    def _on_layer(self, name: LayerName, grid: OccupancyMap) -> None:
        self._take_layer(name, grid.frame, grid.values.astype(np.uint8))

    def _on_true_dirt(self, dirt: tuple[GridFrame, NDArray[np.uint8]]) -> None:
        self._take_layer(LayerName.TRUE_DIRT, *dirt)

    def _take_layer(self, name: LayerName, frame: GridFrame, cells: NDArray[np.uint8]) -> None:
        with self._lock:
            before = self._layers.get(name)
            shape = 1 if before is None else before.shape
            if before is not None and not _lies_as(before, frame):
                shape += 1
            self._layers[name] = GridLayer.over(frame, cells, shape)


def _lies_as(before: GridLayer, frame: GridFrame) -> bool:
    return before.cells.shape == frame.shape and (
        before.resolution,
        before.origin_x,
        before.origin_y,
    ) == (frame.resolution, frame.origin_x, frame.origin_y)


def _one() -> OneSender:
    """Return a rule that accepts one node as the body at a time, as in all nodes."""
    return OneSender(SELDOM_SILENT_AFTER)
