"""The pose kept on the parameter server, by which a restarted node knows where the robot is."""

from __future__ import annotations

import http.client
import math
import threading
import time
import xmlrpc.client
from typing import Final

import rospy

from roomba.configuration.nodes import PlacingConfig
from roomba.geometry import Pose
from roomba_ros.runtime.parameters import read_seed_parameters, robot_run

PARAMETER: Final = "map_to_odometry"
"""Name of the parameter: ``pose``, [x, y, theta] of the odometry's frame in the map, m and rad, and
the ``run`` of the robot in which that is so."""


class KeptPose:
    """Keeps the pose, written by a thread of its own: a hanging master must not stop the robot."""

    def __init__(self, period: float, placing: PlacingConfig) -> None:
        """Keep nothing yet; it is written each ``period`` s of wall time."""
        self._period, self._placing = period, placing
        self._newest: Pose | None = None
        self._written: Pose | None = None
        self.was_found = False
        """Whether the start pose is a kept one: an earlier process of this node knew the place."""

    def start(self) -> None:
        """Begin to write what is kept."""
        self._run = robot_run()
        threading.Thread(target=self._write, daemon=True).start()

    @property
    def is_kept(self) -> bool:
        """Whether the master has a pose by which the next process of this node knows the place."""
        return self.was_found or self._written is not None

    def keep(self, map_to_odometry: Pose) -> None:
        """Take what is to be kept now."""
        self._newest = map_to_odometry

    def start_pose(self, odometry: Pose) -> tuple[Pose, tuple[float, float]]:
        """Return where a robot with this odometry is, map frame, and how unsure, m and rad.

        A pose kept in this run is used; without one the parameters, which say where odometry began.
        """
        kept = _kept_in(self._run)
        self.was_found = kept is not None
        if kept is not None:
            return kept.compose(odometry), self._placing.kept
        # Read now, not at the start: the simulator sets them when it puts the robot into its home.
        start = read_seed_parameters()
        began = Pose(start.initial_post_x, start.initial_post_y, start.initial_post_theta)
        return began.compose(odometry), self._placing.start

    def _write(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(self._period)
            newest = self._newest
            if newest is None or newest == self._written:
                continue
            try:
                rospy.set_param(
                    PARAMETER, {"run": self._run, "pose": [newest.x, newest.y, newest.theta]}
                )
                self._written = newest
            except (OSError, http.client.HTTPException, xmlrpc.client.Error) as error:
                rospy.logwarn_throttle(10.0, "the master does not keep the pose: %s", error)


def _kept_in(run: str) -> Pose | None:
    """Return the pose that was kept in this run; in another one odometry began elsewhere."""
    kept = rospy.get_param(PARAMETER, None)
    if not isinstance(kept, dict) or kept.get("run") != run or not _is_pose(kept.get("pose")):
        return None
    return Pose(*kept["pose"])


def _is_pose(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(isinstance(number, int | float) and math.isfinite(number) for number in value)
    )
