"""``./roomba sim --bag FILE.bag``: a headless run as a bag, with the live robot's topics.

Topics: ``/map`` and ``/tf_static`` once; ``/clock``, ``/tf`` (map -> odom -> base_link), ``/odom``,
``/pose`` (where the robot took itself to be) and ``/ground_truth/pose`` 10 Hz; ``/scan`` as often
as the lidar has one; ``/battery_state`` 1 Hz; ``/plan`` whenever it drives another way;
``/coverage_map`` (0: wanted, 100: swept, -1: neither; cells of the map) every 10 s and at the end.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Final

import numpy as np
import rosbag
from numpy.typing import NDArray
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from roomba.commands.process_end import quiet_end
from roomba.commands.sim.command import main as simulate
from roomba.commands.trials.runs import TrialSetup
from roomba.control.path_tracker import PathTracker
from roomba.grid import FREE, OCCUPIED, UNKNOWN, OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba_ros.body.frames import BodyFrames
from roomba_ros.convert.common import (
    map_message,
    odometry_message,
    path_message,
    pose_message,
    stamp_of,
    transform_message,
)
from roomba_ros.convert.sensors import measured_battery_message, scan_message

_BATTERY_PERIOD: Final = 1.0
_COVERAGE_PERIOD: Final = 10.0
"""s between two messages."""
_EARLIEST: Final = 0.001
"""s; a bag knows no time 0."""
_MAP, _ODOM, _BASE, _LASER = "map", "odom", "base_link", "laser"


def main(arguments: list[str] | None = None) -> int:
    """Simulate; returns the exit status."""
    return simulate(arguments, SimBag)


class SimBag:
    """A bag of one run, as a context; call it with the robot to write what that tells now."""

    def __init__(self, path: Path, setup: TrialSetup) -> None:
        """Begin the bag; raises OSError."""
        self._bag = rosbag.Bag(str(path), "w", compression=rosbag.Compression.LZ4)
        self._scene = setup
        self._scans = -1
        self._tracker: PathTracker | None = None
        self._battery_at = self._coverage_at = -np.inf

    def __enter__(self) -> SimBag:
        """Write what never changes."""
        robot = self._scene.robot
        now = robot.seen.time
        # A bag of no namespace, also where the shell has one.
        mounted = BodyFrames(self._scene.config, named=str).mounted()
        self._put("/tf_static", TFMessage(mounted), now)
        self._put("/map", map_message(now, self._scene.home.map, _MAP), now)
        self(robot)
        return self

    def __exit__(self, *_: object) -> None:
        """Write the floor as it is at the end, and close the bag with its index."""
        try:
            self._write_coverage(self._scene.robot)
        finally:
            self._bag.close()

    def __call__(self, robot: HeadlessMission) -> None:
        """Write what the robot would tell now."""
        seen, config = robot.seen, self._scene.config
        now, believed = seen.time, robot.localizer.estimate.pose
        self._put("/clock", Clock(stamp_of(now)), now)
        drift = believed.compose(seen.odometry.inverse())
        self._put(
            "/tf",
            TFMessage(
                [
                    transform_message(now, drift, _MAP, _ODOM),
                    transform_message(now, seen.odometry, _ODOM, _BASE),
                ]
            ),
            now,
        )
        odometry = odometry_message(now, seen.odometry, seen.odometry_twist, _ODOM, _BASE)
        self._put("/odom", odometry, now)
        self._put("/pose", pose_message(now, believed, _MAP), now)
        self._put("/ground_truth/pose", pose_message(now, seen.pose, _MAP), now)
        if seen.scans != self._scans:
            self._scans = seen.scans
            scan = scan_message(seen.scan_stamp, robot.simulator.ranges, config.lidar, _LASER)
            self._put("/scan", scan, now)
        if now - self._battery_at >= _BATTERY_PERIOD - 1e-6:
            self._battery_at = now
            battery = measured_battery_message(now, seen.battery, config.battery)
            self._put("/battery_state", battery, now)
        driver = robot.mission.driver
        tracker = None if driver is None else driver.tracker
        if tracker is not None and tracker is not self._tracker:
            self._put("/plan", path_message(now, tracker.course.points, _MAP), now)
        self._tracker = tracker
        if now - self._coverage_at >= _COVERAGE_PERIOD - 1e-6:
            self._coverage_at = now
            self._write_coverage(robot)

    def _write_coverage(self, robot: HeadlessMission) -> None:
        now = robot.seen.time
        self._put("/coverage_map", map_message(now, coverage_on_map(self._scene), _MAP), now)

    def _put(self, topic: str, message: Any, now: float) -> None:
        self._bag.write(topic, message, stamp_of(max(now, _EARLIEST)))


def coverage_on_map(setup: TrialSetup) -> OccupancyMap:
    """Return what was swept, on the map's cells: one counts if half its wanted floor was."""
    frame = setup.home.frame
    factor = setup.robot.context.frame.rows // frame.rows

    def share(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
        blocks = mask.reshape(frame.rows, factor, frame.columns, factor)
        shares: NDArray[np.float64] = blocks.mean(axis=(1, 3))
        return shares

    wanted = share(setup.coverable)
    swept = share(setup.robot.truth.swept & setup.coverable)
    values = np.full(frame.shape, UNKNOWN, np.int8)
    values[wanted > 0.0] = FREE
    values[(wanted > 0.0) & (swept >= 0.5 * wanted)] = OCCUPIED
    return OccupancyMap(frame, values)


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
