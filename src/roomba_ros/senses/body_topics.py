"""The readings of the robot's body."""

from __future__ import annotations

import math
import threading
from collections import deque
from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import rospy
from geometry_msgs.msg import Pose2D
from roomba_robot.msg import EmptyingStation
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.inputs.senses import Battery
from roomba.perception.calibration.lidar import CorrectedLidar
from roomba.robot.readings import Readings, ScanReading
from roomba_ros.convert.calibration import correction_of
from roomba_ros.convert.localization import SAME_TIME
from roomba_ros.convert.mounts import Mounts, transforms_of
from roomba_ros.convert.readings import (
    GyroReading,
    OdometryReading,
    emptying_of,
)
from roomba_ros.convert.scan import ScanDecoder
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.senders import SELDOM_SILENT_AFTER, OneSender
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.body_source import BodySource
from roomba_ros.senses.single_topics import SingleTopic, single_topics
from roomba_ros.senses.waiting_scans import WaitingScans

_KEPT: Final = 40
"""Messages of the body, of odometry and of the gyro that wait for the next tick: two seconds."""
_LONGEST_WAIT: Final = 2.0
"""s; a reading that is older than another one by more comes from before the clock was set back."""
_QUEUE: Final = 10
_OF_ANY: Final = frozenset(("scan",))
"""Topics that several nodes may publish: a robot may have two lidars, each with its frame."""
_BESIDE_BODY: Final = ("scan", "emptying_station", "lidar_correction")
"""Topics that can be subscribed to besides the single topics of the body."""


class BodyTopics:
    """Makes readings of what the body tells: one for each message of it, or of odometry.

    Each reading has the newest values of all other sensors; a scan comes with the first odometry
    that is not older than it. There is one body: of two nodes that publish its state, the first
    counts until it is silent.

    Subscribes: ``body``, and without that those of ``topics`` out of ``odom``, ``imu``, ``bumper``,
    ``cliff``, ``wheel_drop``, ``battery_state``, ``dock_status``, ``ir_omni``, ``dirt_detect``,
    ``bin_level`` and ``brush_current``; those out of ``emptying_station`` and ``scan``, with
    ``/tf_static`` (where the lidar is mounted) and ``lidar_correction`` (by what that is moved, as
    the node that finds the robot's place measured it).
    """

    def __init__(self, config: RobotConfig, *topics: str, always: Collection[str] = ()) -> None:
        """Connect nothing yet; the single topics ``always`` are subscribed to besides ``body``.

        Raises ValueError for a topic that there is not.
        """
        self._config, self._topics, self._always = config, topics, always
        self._singles = single_topics(config)
        _require_known(topics, (*self._singles, *_BESIDE_BODY))
        _require_known(always, self._singles)
        self._takers: dict[str, Callable[[Any], object]] = {
            "odom": self._on_odometry,
            "imu": self._on_gyro,
            "battery_state": self._on_battery,
            "dock_status": self._on_dock,
        }
        self._lock = threading.Lock()
        self._senders = OneSender(SELDOM_SILENT_AFTER)
        self._source = BodySource(
            self._on_body,
            self._subscribe_singles,
            self._senders,
            config.brush.bin_capacity,
            _QUEUE,
        )
        self._bodies: deque[Readings] = deque(maxlen=_KEPT)
        self._odometry: deque[OdometryReading] = deque(maxlen=_KEPT)
        self._gyro: deque[GyroReading] = deque(maxlen=_KEPT)
        self._newest = -math.inf
        self._scans = WaitingScans()
        self._battery = Battery()
        self._others: dict[str, Any] = {}
        self._heard: set[str] = set()
        self._lidars = CorrectedLidar()

    def start(self) -> None:
        """Connect."""
        mounts = Mounts()
        decoder = ScanDecoder.on_robot(mounts, frame_id("base_link"))
        if "scan" in self._topics:
            subscribe("/tf_static", TFMessage, transforms_of, mounts.add, queue_size=_QUEUE)
            self._subscribe("scan", LaserScan, decoder.decode, self._scans.put)
        if "emptying_station" in self._topics:
            self._subscribe(
                "emptying_station",
                EmptyingStation,
                emptying_of,
                lambda told: self._note(emptying=told),
            )
        if "lidar_correction" in self._topics:
            self._subscribe("lidar_correction", Pose2D, correction_of, self._on_correction)
        self._subscribe_to(self._always)
        self._source.start()

    def _subscribe_singles(self) -> list[rospy.Subscriber]:
        """Subscribe to the single topics whose values ``body`` has as well."""
        return self._subscribe_to(
            [name for name in self._topics if name in self._singles and name not in self._always]
        )

    def _subscribe_to(self, topics: Collection[str]) -> list[rospy.Subscriber]:
        """Subscribe to single topics of the body."""
        return [self._subscribe_single(name, self._singles[name]) for name in topics]

    def _subscribe_single(self, name: str, single: SingleTopic) -> rospy.Subscriber:
        take = self._takers.get(name, lambda value: self._note(**single.told(value)))
        return self._subscribe(name, single.kind, single.convert, take)

    def _subscribe(
        self,
        topic: str,
        kind: type,
        convert: Callable[[Any], Any],
        take: Callable[[Any], object],
    ) -> rospy.Subscriber:
        return subscribe(
            topic,
            kind,
            convert,
            partial(self._hear, topic, take),
            queue_size=_QUEUE,
            tcp_nodelay=True,
            senders=self._senders_of(topic),
        )

    def _senders_of(self, topic: str) -> OneSender | None:
        """Return which nodes may publish a topic; None: any node."""
        if topic in _OF_ANY:
            return None
        return self._senders if topic == "odom" else OneSender(SELDOM_SILENT_AFTER)

    def missing(self, *topics: str) -> tuple[str, ...]:
        """Return those of the topics of which no message was heard yet."""
        return tuple(topic for topic in topics if topic not in self._heard)

    def take(self) -> list[Readings]:
        """Return the readings since the last call, in the order of time."""
        was_whole = self._source.is_whole
        self._source.follow()
        told = self._new(self._told(with_single=not (was_whole and self._source.is_whole)))
        if told:
            told[-1] = self._with_scan(told[-1])
        return told

    def _told(self, *, with_single: bool) -> list[Readings]:
        """Return the readings since the last call; of equal times, those of ``body`` come last."""
        with self._lock:
            whole, odometry, gyro = list(self._bodies), list(self._odometry), list(self._gyro)
            others = {**self._others, "battery": self._battery}
            self._bodies.clear()
            self._odometry.clear()
        if "emptying" in others:
            whole = [replace(each, emptying=others["emptying"]) for each in whole]
        if not with_single:
            return whole
        return [*_joined(odometry, gyro, others), *whole]

    def _new(self, told: Iterable[Readings]) -> list[Readings]:
        """Return one reading of each new time, in the order of time."""
        of_time = {each.time: each for each in told if self._is_new(each.time)}
        if of_time:
            self._newest = max(of_time)
        return [of_time[stamp] for stamp in sorted(of_time)]

    def _is_new(self, stamp: float) -> bool:
        return not 0.0 <= self._newest - stamp <= _LONGEST_WAIT

    def _with_scan(self, newest: Readings) -> Readings:
        """Return readings with the newest scan that they complete, if there is one."""
        scan = self._scan_by(newest.time)
        return newest if scan is None else replace(newest, scan=scan)

    def _scan_by(self, stamp: float) -> ScanReading | None:
        """Return the newest unused scan whose beams were all measured by a time, s; else None.

        A scan without a stamp is taken to end at that time.
        """
        scan, oldest = self._scans.take(stamp), self._scans.oldest
        if scan is not None:
            taken = scan.stamp or stamp - scan.lidar.sweep
            return replace(scan, stamp=taken, lidar=self._lidars.of(scan.lidar))
        if oldest is not None and oldest > stamp + self._config.localization.scan_timeout:
            rospy.logwarn_throttle(
                10.0,
                "no scan is used: they are of %.2f s, odometry only of %.2f s",
                oldest,
                stamp,
            )
        return None

    def _hear(self, topic: str, take: Callable[[Any], object], value: object) -> None:
        take(value)
        self._heard.add(topic)

    def _note(self, **values: Any) -> None:
        with self._lock:
            self._others.update(values)

    def _on_body(self, told: Readings) -> None:
        with self._lock:
            self._bodies.append(told if told.time else replace(told, time=rospy.get_time()))
            self._battery = told.battery
            for topic in self._singles.keys() & self._topics:
                fields = self._singles[topic].fields
                self._others.update((name, getattr(told, name)) for name in fields)
        self._heard |= self._singles.keys()

    def _on_odometry(self, told: OdometryReading) -> None:
        with self._lock:
            self._odometry.append(told._replace(stamp=told.stamp or rospy.get_time()))

    def _on_gyro(self, told: GyroReading) -> None:
        with self._lock:
            self._gyro.append(told)

    def _on_correction(self, correction: Pose) -> None:
        self._lidars.correction = correction

    def _on_battery(self, battery: Battery) -> None:
        with self._lock:
            self._battery = replace(battery, is_docked=self._battery.is_docked)

    def _on_dock(self, is_docked: bool) -> None:
        with self._lock:
            self._battery = replace(self._battery, is_docked=is_docked)


def _require_known(topics: Collection[str], known: Collection[str]) -> None:
    """Raise ValueError for a topic that there is not."""
    unknown = [name for name in topics if name not in known]
    if unknown:
        raise ValueError(
            f"expected topics of the body out of {', '.join(known)}; got {', '.join(unknown)}"
        )


def _joined(
    odometry: Iterable[OdometryReading], gyro: list[GyroReading], others: dict[str, Any]
) -> list[Readings]:
    """Return readings of the single topics: one for each odometry, with the newest other values."""
    return [
        Readings(
            time=each.stamp,
            odometry=each.pose,
            twist=each.twist,
            turning=_turning_at(each.stamp, gyro),
            **others,
        )
        for each in odometry
    ]


def _turning_at(stamp: float, gyro: list[GyroReading]) -> float | None:
    """Return the gyro's sample of about that time, rad/s."""
    near = [sample for sample in gyro if abs(sample.stamp - stamp) < SAME_TIME]
    if not near:
        return None
    return min(near, key=lambda sample: abs(sample.stamp - stamp)).turning
