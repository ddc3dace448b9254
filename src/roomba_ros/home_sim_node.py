"""The simulated home on ROS: it owns the clock, the body and its sensors."""

from __future__ import annotations

import math
import threading
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import Twist as TwistMessage
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import Bumper as BumperMessage
from roomba_robot.srv import (
    SpillDirt,
    SpillDirtRequest,
    SpillDirtResponse,
    TurnCamera,
    TurnCameraRequest,
    TurnCameraResponse,
)
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float32
from tf2_msgs.msg import TFMessage

from roomba.config import SeedParameters
from roomba.errors import ConfigError, RoombaError
from roomba.geometry import Pose, Twist
from roomba.world.camera import Camera, Scene
from roomba.world.home import Home
from roomba.world.layer import load_home
from roomba.world.simulator import Bumper, Observation, Simulator
from roomba_ros.convert import (
    bumper_message,
    image_message,
    map_message,
    odometry_message,
    transform_message,
    twist_of,
)
from roomba_ros.node import frame_id, give_up, leave, register, require_master, told_to_end
from roomba_ros.parameters import LiveSeedParameters, package_folder, read_robot_config

TICK_NANOSECONDS = 50_000_000
"""Robot time between two messages of the clock: a whole part of every period in the graph."""
STEPS_PER_TICK = 2
STEP = TICK_NANOSECONDS / STEPS_PER_TICK / 1e9
"""s of robot time of one step of the world."""
_DIRT_EVERY = 2
_BUMPER_EVERY = 4
"""Ticks between two messages of an unchanged bumper; a change is told at once."""
_LATEST = 0.5
"""s of wall time; farther behind than this the simulation runs slower than asked for."""
_FASTEST = 100.0


class HomeSimNode:
    """Steps the world and publishes what the robot's drive and sensors say.

    Publishes: ``/clock`` (20 Hz), ``map`` (latched), ``odom`` (20 Hz), ``bumper`` (at each change,
    and 5 Hz), ``/tf`` (odom -> base_link), ``dirt_raw`` (Float32, g under the body, 10 Hz).
    Subscribes: ``cmd_vel_out`` (Twist; older than the drive's time-out it stops).
    Services: ``camera/capture`` (TurnCamera, exactly at the angle), ``sim/spill`` (SpillDirt).
    Parameters: ``~home`` (name or path), ``~homes_directory``, ``~speed`` (robot seconds per second
    of wall time), ``~seed``, ``~clock`` (false for all but one of several robots),
    ``robot_max_speed``, ``initial_post_x``, ``initial_post_y``.
    """

    def start(self) -> None:
        """Load the home, put the robot in it, connect; raises RoombaError."""
        self._parameters = LiveSeedParameters()
        self._config = read_robot_config()
        self._speed = _speed_parameter()
        self._owns_clock = rospy.get_param("~clock", True)
        if not isinstance(self._owns_clock, bool):
            raise ConfigError(f"parameter ~clock: expected true or false, got {self._owns_clock!r}")
        self._simulator = self._make_simulator()
        self._camera = Camera(Scene.of(self._simulator.home), self._config.camera)
        self._lock = threading.Lock()
        self._camera_lock = threading.Lock()
        self._command = Twist()
        self._command_age = float("inf")
        self._clock = time.time_ns() // TICK_NANOSECONDS * TICK_NANOSECONDS
        self._ticks = 0
        self._told_bumper = Bumper()
        self._odom_frame, self._base_frame = frame_id("odom"), frame_id("base_link")
        self._connect()

    def run(self) -> None:
        """Step in real time, or as many times faster as asked for, until shutdown."""
        period = TICK_NANOSECONDS / 1e9 / self._speed
        due = time.monotonic() + period
        late = False
        while not told_to_end():
            wait = due - time.monotonic()
            if wait > 0.0:
                time.sleep(wait)
            elif wait < -_LATEST:
                if not late:
                    rospy.logwarn(
                        "this machine is too slow for speed %g; going on slower", self._speed
                    )
                late = True
                due = time.monotonic()
            due += period
            self._tick()

    def _tick(self) -> None:
        self._simulator.max_speed = self._parameters.refresh().robot_max_speed
        with self._lock:
            for _ in range(STEPS_PER_TICK):
                observation = self._simulator.step(self._fresh_command(), STEP)
            self._clock += TICK_NANOSECONDS
        self._ticks += 1
        self._publish(observation)

    def _fresh_command(self) -> Twist:
        self._command_age += STEP
        if self._command_age > self._config.body.command_timeout:
            self._command = Twist()
        return self._command

    def _publish(self, observation: Observation) -> None:
        now = self._now()
        if self._owns_clock:
            self._clock_publisher.publish(rospy.Time(nsecs=self._clock))
        odometry = observation.odometry
        self._odometry.publish(
            odometry_message(now, odometry, observation.twist, self._odom_frame, self._base_frame)
        )
        self._transforms.publish(
            [transform_message(now, odometry, self._odom_frame, self._base_frame)]
        )
        bumper = observation.bumper
        if bumper != self._told_bumper or self._ticks % _BUMPER_EVERY == 0:
            self._told_bumper = bumper
            self._bumper.publish(bumper_message(now, bumper.left, bumper.right, self._base_frame))
        if self._ticks % _DIRT_EVERY == 0:
            self._dirt.publish(observation.dirt_under)

    def _now(self) -> float:
        """Return the time for stamps, s: that of the clock, whoever owns it."""
        return self._clock / 1e9 if self._owns_clock else float(rospy.get_time())

    def _make_simulator(self) -> Simulator:
        directory = Path(rospy.get_param("~homes_directory", str(package_folder() / "homes")))
        home = load_home(str(rospy.get_param("~home", "flat")), directory)
        seed = rospy.get_param("~seed", 0)
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise ConfigError(
                f"parameter ~seed: expected a whole number of 0 or more, got {seed!r}"
            )
        parameters = self._parameters.values
        start = _start_pose(home, parameters)
        simulator = Simulator(
            home, self._config, seed=seed, max_speed=parameters.robot_max_speed, start=start
        )
        for name, value in (("x", start.x), ("y", start.y), ("theta", start.theta)):
            rospy.set_param(f"initial_post_{name}", value)
        rospy.loginfo("home %s: the robot starts at (%.2f, %.2f)", home.name, start.x, start.y)
        return simulator

    def _connect(self) -> None:
        if self._owns_clock:
            self._clock_publisher = rospy.Publisher("/clock", Clock, queue_size=1, tcp_nodelay=True)
        self._odometry = rospy.Publisher("odom", Odometry, queue_size=1, tcp_nodelay=True)
        self._bumper = rospy.Publisher("bumper", BumperMessage, queue_size=1, tcp_nodelay=True)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._dirt = rospy.Publisher("dirt_raw", Float32, queue_size=1)
        self._map = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._map.publish(map_message(self._now(), self._simulator.home.map, "map"))
        rospy.Subscriber(
            "cmd_vel_out", TwistMessage, self._on_command, queue_size=1, tcp_nodelay=True
        )
        rospy.Service("camera/capture", TurnCamera, self._on_capture)
        rospy.Service("sim/spill", SpillDirt, self._on_spill)

    def _on_command(self, message: TwistMessage) -> None:
        twist = twist_of(message)
        if not twist.is_finite:
            rospy.logwarn("cmd_vel_out refused: expected finite velocities, got %s", twist)
            return
        self._command, self._command_age = twist, 0.0

    def _on_capture(self, request: TurnCameraRequest) -> TurnCameraResponse:
        angle, most = request.turn_degrees, self._config.camera.max_pan
        if not abs(angle) <= most:
            raise rospy.ServiceException(
                f"expected an angle from {-most:g} to {most:g} degrees, got {angle:g}"
            )
        with self._lock:
            now, pose = self._now(), self._simulator.pose
        dirt = self._simulator.dirt
        # Not under the simulation's lock: taking a picture must not hold up time.
        with self._camera_lock:
            picture = self._camera.picture(pose, math.radians(angle), dirt.micrograms, dirt.frame)
            return TurnCameraResponse(image_message(now, picture, frame_id("camera")))

    def _on_spill(self, request: SpillDirtRequest) -> SpillDirtResponse:
        try:
            with self._lock:
                self._simulator.spill(request.x, request.y, request.radius, request.amount)
        except ValueError as error:
            return SpillDirtResponse(False, str(error))
        return SpillDirtResponse(
            True, f"{request.amount:g} g lie around ({request.x:.2f}, {request.y:.2f})"
        )


def _speed_parameter() -> float:
    speed = rospy.get_param("~speed", 1.0)
    if isinstance(speed, bool) or not isinstance(speed, int | float) or not 0 < speed <= _FASTEST:
        raise ConfigError(
            f"parameter ~speed: expected a number above 0 and up to {_FASTEST:g}, got {speed!r}"
        )
    return float(speed)


def _start_pose(home: Home, parameters: SeedParameters) -> Pose:
    """Return where the robot starts; (0, 0), the parameters' default, means at the station."""
    x, y = parameters.initial_post_x, parameters.initial_post_y
    if (x, y) == (0.0, 0.0):
        return home.station
    return Pose(x, y, parameters.initial_post_theta)


def main() -> None:
    """Run the node."""
    require_master()
    register("home_sim_node")
    node = HomeSimNode()
    try:
        node.start()
    except RoombaError as error:
        give_up(str(error))
    node.run()
    leave(0)
