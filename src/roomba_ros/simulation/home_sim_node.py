"""The simulated home on ROS: it owns the clock, the body and its sensors."""

from __future__ import annotations

import threading
import time
from functools import partial
from itertools import groupby
from pathlib import Path

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float32, Time
from tf2_msgs.msg import TFMessage

from roomba.clock import ClockJumps
from roomba.configuration.body import BodyConfig
from roomba.configuration.seed import SeedParameters
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import ConfigError, RoombaError
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.world.home.doors import with_leaves
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator
from roomba_ros.body.drive_link import DriveLink
from roomba_ros.body.frames import BodyFrames
from roomba_ros.convert.common import (
    map_message,
    pose_message,
    transform_message,
)
from roomba_ros.convert.readings import StampedPose, stamped_pose_of
from roomba_ros.convert.values import duty_of, time_of
from roomba_ros.localization import kept_pose
from roomba_ros.runtime.graph.alone import other_publishers
from roomba_ros.runtime.node import (
    frame_id,
    give_up,
    leave,
    register,
    require_master,
    settle,
    told_to_end,
)
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    bool_parameter,
    read_nodes_config,
    read_simulated_config,
)
from roomba_ros.runtime.subscriptions import subscribe, tell_refusals
from roomba_ros.runtime.timing import progress
from roomba_ros.runtime.timing.pace import Pace
from roomba_ros.runtime.timing.ticker import Ticker
from roomba_ros.simulation.camera_topics import CameraTopics
from roomba_ros.simulation.sensor_topics import SensorTopics
from roomba_ros.simulation.sim_services import SimServices
from roomba_ros.simulation.station_link import StationLink
from roomba_ros.simulation.truth_topics import TruthTopics

_FASTEST = 100.0
_LONGEST_STEP = 5.0
"""s; a clock that went on by more than this at once was set."""
_POSE = "pose"
"""The name by which the pace knows the node that publishes the pose."""


class HomeSimNode:
    """Steps the world and publishes what the robot's drive and sensors say.

    Publishes: ``/clock`` (20 Hz), ``map`` (latched), ``station_pose`` (PoseStamped, latched: where
    the docked robot stands on that map, its nose to the station),
    ``/tf`` (while heard: odom -> base_link, and of that the wheels),
    ``/tf_static`` (where the sensors are on the body), and what :class:`SensorTopics`,
    :class:`StationLink`, :class:`CameraTopics` and :class:`TruthTopics` tell.
    Subscribes: what :class:`DriveLink` hears (``cmd_vel_out``, ``emergency_stop``), and
    :class:`StationLink` (``emptying_wanted``); ``pose``
    (PoseStamped) and the ``progress`` (Time) of :data:`progress.NODES`: a robot that is late, on a
    busy machine, is waited for; ``main_brush_motor``, ``vacuum_motor`` (Float32, duty 0..1, of
    brush and fan).
    Services: those of :class:`CameraTopics` and :class:`SimServices`.
    Parameters: ``~home`` (name or path), ``~homes_directory``, ``~speed`` (robot seconds per second
    of wall time), ``~seed``, ``~clock`` (false for all but one of several robots, which go by that
    one's clock and do not wait), ``~drive_owner`` (the node that may drive, or any),
    ``~frames`` (false: robot_state_publisher tells those below base_link),
    ``~sensors`` (ideal or noisy) and ``~wheels`` (factory or worn),
    by default what ``robot_config`` says, ``~empties`` (true: its station empties the bin, also
    where ``robot_config`` does not say so), ``robot_max_speed``, ``initial_post_x``,
    ``initial_post_y``.
    """

    period: float
    """s of the ROS clock between two ticks."""

    def start(self) -> None:
        """Load the home, put the robot in it, connect; raises RoombaError."""
        self._parameters = LiveSeedParameters()
        self._config = _config_as_wanted(read_simulated_config())
        self._nodes = read_nodes_config()
        self._timing = self._config.timing
        self.period = self._timing.tick
        self._nanoseconds = round(self._timing.tick * 1e9)
        self._speed = _speed_parameter()
        self._owns_clock = bool_parameter("~clock", True)
        if self._owns_clock:
            _require_no_other_clock()
        self._lock = threading.Lock()
        self._drive = DriveLink(self._config.body.command_timeout, self._lock)
        self._simulator = self._make_simulator()
        self._station = StationLink(
            self._simulator.emptying, self._nodes.deadlines.emptying, self._lock
        )
        self._clock = self._first_clock()
        self._jumps = ClockJumps(last=self._now(), longest=_LONGEST_STEP)
        self._ticks = 0
        self._told = 0.0
        self._pace = Pace(self._timing.tick, self._speed, self._nodes.pace, self._is_there)
        self._odom_frame, self._base_frame = frame_id("odom"), frame_id("base_link")
        self._frames = BodyFrames(self._config) if bool_parameter("~frames", True) else None
        self._connect()

    def run(self) -> None:
        """Step until shutdown."""
        if self._owns_clock:
            self._keep_clock()
        else:
            Ticker(self._timing.tick, told_to_end).run(self.tick)

    def stop(self) -> None:
        """Nothing is left to do: without commands the body comes to rest by itself."""

    def _keep_clock(self) -> None:
        """Step in real time, or as many times faster as asked for."""
        was_late = False
        while not told_to_end():
            self._pace.wait(self._told, told_to_end)
            if self._pace.is_late and not was_late:
                was_late = True
                rospy.logwarn("this machine is too slow for speed %g; going on slower", self._speed)
            self._tick()

    def tick(self, now: float) -> None:
        """Step to the time ``now``, s, of the ROS clock, which another node publishes."""
        if self._jumps.at(now):
            self._clock = round(now * 1e9) - self._nanoseconds
        for _ in range(round((now * 1e9 - self._clock) / self._nanoseconds)):
            self._tick()

    def _tick(self) -> None:
        max_speed = self._parameters.refresh().robot_max_speed
        with self._lock:
            self._simulator.max_speed = max_speed
            self._station.step(self._timing.tick)
            self._advance()
            observation = self._simulator.observe()
            self._clock += self._nanoseconds
            now = self._told = self._now()
            self._camera.set_time(now)
        self._ticks += 1
        self._publish(now, observation)

    def _advance(self) -> None:
        """Advance by one tick; the newest command may become too old within the tick."""
        step = self._timing.world_step
        twists = [self._drive.step(step) for _ in range(self._timing.steps_per_tick)]
        for twist, steps in groupby(twists):
            self._simulator.advance(twist, step, len(list(steps)))

    def _publish(self, now: float, observation: Observation) -> None:
        if self._transforms.get_num_connections() > 0:
            self._tell_transforms(now, observation)
        self._sensors.tell(now, self._ticks, observation)
        self._station.tell(self._ticks)
        self._truth.tell(now, self._ticks, observation)
        if self._owns_clock:
            # Published last, so that a node that ticks by it has mostly received the sensors'
            # messages.
            self._clock_publisher.publish(rospy.Time(nsecs=self._clock))

    def _tell_transforms(self, now: float, observation: Observation) -> None:
        place = observation.odometry
        transforms = [transform_message(now, place, self._odom_frame, self._base_frame)]
        if self._frames is not None:
            wheels = observation.wheels
            transforms += self._frames.wheels(now, wheels.left, wheels.right)
        self._transforms.publish(transforms)

    def _now(self) -> float:
        """Return the time for stamps, s of the ROS clock."""
        return self._clock / 1e9

    def _first_clock(self) -> int:
        if not self._owns_clock:
            return int(rospy.get_rostime().to_nsec())
        return time.time_ns() // self._nanoseconds * self._nanoseconds

    def _make_simulator(self) -> Simulator:
        directory = Path(rospy.get_param("~homes_directory", str(HOMES)))
        name = str(rospy.get_param("~home", "flat"))
        home = with_leaves(load_home(name, directory, self._config.body))
        seed = rospy.get_param("~seed", 0)
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise ConfigError(
                f"parameter ~seed: expected a whole number of 0 or more, got {seed!r}"
            )
        parameters = self._parameters.values
        start = _start_pose(home, self._config.body, parameters)
        simulator = Simulator(
            home, self._config, seed=seed, max_speed=parameters.robot_max_speed, start=start
        )
        for name, value in (("x", start.x), ("y", start.y), ("theta", start.theta)):
            rospy.set_param(f"initial_post_{name}", value)
        if rospy.has_param(kept_pose.PARAMETER):
            # A kept pose is of a robot that started elsewhere, as did its odometry.
            rospy.delete_param(kept_pose.PARAMETER)
        rospy.loginfo("home %s: the robot starts at (%.2f, %.2f)", home.name, start.x, start.y)
        return simulator

    def _connect(self) -> None:
        if self._owns_clock:
            self._clock_publisher = rospy.Publisher("/clock", Clock, queue_size=1, tcp_nodelay=True)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        if self._frames is not None:
            self._mounts = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
            self._mounts.publish(self._frames.mounted())
        if _tells_map_parameter():
            self._tell_map()
        self._sensors = SensorTopics(
            self._config, self._simulator, self._parameters.values.robot_name
        )
        self._camera = CameraTopics(
            self._simulator, self._config.camera, self._nodes.periods.pictures, self._lock
        )
        self._truth = TruthTopics(self._simulator, self._nodes.periods)
        self._services = SimServices(self._simulator, self._lock)
        self._drive.start()
        self._station.start()
        self._services.start()
        self._parts = {
            _POSE: subscribe("pose", PoseStamped, stamped_pose_of, self._on_pose, tcp_nodelay=True)
        }
        for name in progress.NODES:
            self._parts[name] = subscribe(
                f"{name}/progress",
                Time,
                time_of,
                partial(self._pace.heard, name),
                tcp_nodelay=True,
            )
        for topic, motor in (("main_brush_motor", "brush"), ("vacuum_motor", "fan")):
            subscribe(topic, Float32, duty_of, partial(self._on_power, motor))

    def _tell_map(self) -> None:
        """Give the robot the map of its home, and the place of its station."""
        home = self._simulator.home
        self._map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._map.publish(map_message(self._now(), home.map, "map"))
        self._place = rospy.Publisher("station_pose", PoseStamped, queue_size=1, latch=True)
        self._place.publish(pose_message(self._now(), home.station, "map"))

    def _is_there(self, part: str) -> bool:
        return bool(self._parts[part].get_num_connections() > 0)

    def _on_pose(self, told: StampedPose) -> None:
        self._pace.heard(_POSE, told.stamp)

    def _on_power(self, motor: str, duty: float) -> None:
        with self._lock:
            self._simulator.set_power(**{motor: duty})


def _config_as_wanted(config: SimulatedRobotConfig) -> SimulatedRobotConfig:
    sensors = rospy.get_param("~sensors", "") or config.simulation.sensors
    if sensors not in ("ideal", "noisy"):
        raise ConfigError(f"parameter ~sensors: expected ideal or noisy, got {sensors!r}")
    wheels = rospy.get_param("~wheels", "") or config.simulation.condition
    if wheels not in ("factory", "worn"):
        raise ConfigError(f"parameter ~wheels: expected factory or worn, got {wheels!r}")
    empties = bool_parameter("~empties", False)
    config = config.with_sensors(sensors).with_wheels(wheels)
    return config.with_emptying_station() if empties else config


def _tells_map_parameter() -> bool:
    """Return whether the robot is given the map; if not it makes its own."""
    value = rospy.get_param("~map", "given")
    if not isinstance(value, str) or not value:
        raise ConfigError(f"parameter ~map: expected given, none, own or a name, got {value!r}")
    return value == "given"


def _require_no_other_clock() -> None:
    """Raise RoombaError when another node publishes the clock: there is one for all."""
    if others := other_publishers("/clock"):
        raise RoombaError(
            f"expected no other clock, but {', '.join(others)} publishes /clock; say clock:=false "
            "for a further robot, which goes by that one, or end that one first"
        )


def _speed_parameter() -> float:
    speed = rospy.get_param("~speed", 1.0)
    if isinstance(speed, bool) or not isinstance(speed, int | float) or not 0 < speed <= _FASTEST:
        raise ConfigError(
            f"parameter ~speed: expected a number above 0 and up to {_FASTEST:g}, got {speed!r}"
        )
    return float(speed)


def _start_pose(home: Home, body: BodyConfig, parameters: SeedParameters) -> Pose:
    """Return where the robot starts; (0, 0), the parameters' default, means at the station."""
    x, y = parameters.initial_post_x, parameters.initial_post_y
    if (x, y) == (0.0, 0.0):
        return body.docked_at(home.station)
    return Pose(x, y, parameters.initial_post_theta)


def main() -> None:
    """Run the node."""
    require_master()
    register("home_sim_node")
    node = HomeSimNode()
    tell_refusals()
    try:
        node.start()
    except RoombaError as error:
        give_up(str(error))
    settle()
    node.run()
    leave(0)
