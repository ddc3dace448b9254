"""The robot of the running graph as a page observes and commands it."""

from __future__ import annotations

import math
import threading
import time
from typing import Any, Final

import numpy as np
import rospy
from geometry_msgs.msg import Point as PointMessage
from geometry_msgs.msg import Twist as TwistMessage
from numpy.typing import NDArray
from roomba_robot.srv import (
    EmergencyStop,
    IgnoreLowThing,
    InjectFault,
    JoinRooms,
    RemoveZone,
    RenameRoom,
    SetDoor,
    SetZone,
    SpillDirt,
    SplitRoom,
)
from std_srvs.srv import Trigger

from roomba.clean_request import CleanRequest
from roomba.client import view
from roomba.client.observed import HAND_SILENCE, SPILL, STATION_BOX
from roomba.client.protocol import (
    ErrandOutcome,
    RequestRefusedError,
    WalkHandle,
    WalkOutcome,
)
from roomba.configuration.robot import RobotConfig
from roomba.geometry import STANDSTILL, Point, Pose, Twist
from roomba.vocabulary import RoomWay
from roomba_ros.client.ros_client import RosCamera, RosRobot
from roomba_ros.convert.common import twist_message
from roomba_ros.convert.page import zone_message_of
from roomba_ros.dashboard.graph_maps import GraphMaps
from roomba_ros.dashboard.page_topics import PageTopics
from roomba_ros.runtime.calls import call_service, is_offered
from roomba_ros.runtime.parameters import LiveSeedParameters

_REFUSED_WITHIN: Final = 1.0
"""s of wall time within which an action server refuses a goal that it will not take."""
_STOPS: Final = 3
"""How often a stop is sent before this node leaves the drive to others."""


class GraphRobot(GraphMaps):
    """Observes topics; commands by actions, services and ``cmd_vel``.

    Publishes: ``cmd_vel`` (Twist, while it is driven by hand), and what :class:`RosRobot` does.
    Calls: ``emergency_stop``, ``set_zone``, ``remove_zone``, ``ignore_low_thing``,
    ``rooms/rename``, ``rooms/join``, ``rooms/split``, ``rooms/undo``, ``sim/spill``,
    ``sim/inject_fault``, ``sim/set_door``, ``sim/replace_bag``, ``empty_at_station``,
    ``turn_camera``, and what :class:`RosRobot` and
    :class:`GraphMaps` do.
    """

    def __init__(self, config: RobotConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._topics = PageTopics(config)
        self._vacuum = RosRobot()
        self._walk: WalkHandle | None = None
        self._hand_lock = threading.Lock()
        self._by_hand, self._hand_heard, self._stops_left = STANDSTILL, -math.inf, 0
        self._drive: rospy.Publisher | None = None

    def start(self) -> None:
        """Connect."""
        self._parameters = LiveSeedParameters()
        super().start()
        self._topics.start()
        self._camera = RosCamera()
        self._vacuum.start()
        kinds = {
            "emergency_stop": EmergencyStop,
            "set_zone": SetZone,
            "remove_zone": RemoveZone,
            "ignore_low_thing": IgnoreLowThing,
            "rooms/rename": RenameRoom,
            "rooms/join": JoinRooms,
            "rooms/split": SplitRoom,
            "rooms/undo": Trigger,
            "sim/spill": SpillDirt,
            "sim/inject_fault": InjectFault,
            "sim/set_door": SetDoor,
            "empty_at_station": Trigger,
            "sim/replace_bag": Trigger,
        }
        self._services = {name: rospy.ServiceProxy(name, kind) for name, kind in kinds.items()}

    def tick(self) -> None:
        """Repeat the twist of the person who drives by hand, or stop when that person let go."""
        self._parameters.refresh()
        with self._hand_lock:
            if time.monotonic() - self._hand_heard < HAND_SILENCE:
                self._stops_left = _STOPS
                twist = self._by_hand
            elif self._stops_left:
                self._stops_left -= 1
                twist = STANDSTILL
            else:
                return
        self._publish(twist)

    def stop_hand(self) -> None:
        """Publish one standstill, and take no more twists of the person who drives by hand."""
        with self._hand_lock:
            self._hand_heard = -math.inf
            if self._drive is not None:
                self._drive.publish(TwistMessage())

    def _publish(self, twist: Twist) -> None:
        """Publish a twist.

        ``cmd_vel`` is advertised only until the last stop is sent, so that afterwards other writers
        are the only publishers of that topic.
        """
        if self._drive is None:
            self._drive = rospy.Publisher("cmd_vel", TwistMessage, queue_size=1, tcp_nodelay=True)
        self._drive.publish(twist_message(twist))
        if self._stops_left == 0:
            self._drive.unregister()
            self._drive = None

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""
        body = self._config.body
        return view.PageLimits(
            body.max_speed,
            body.max_angular_speed,
            camera_angles=view.camera_angles(self._config.camera.max_pan),
            play=self._acts(),
        )

    def robot(self) -> view.RobotView:
        """Return the newest state."""
        pose = self._topics.pose()
        return view.RobotView(
            time=rospy.get_time(),
            pose=(pose.x, pose.y, pose.theta),
            doubt=self._topics.trouble or self._topics.doubt,
            speed=self._topics.speed,
            dirt=self._topics.in_bin,
            held=self._topics.held.reason,
            vacuum=self._topics.reached(self._vacuum.vacuum(0.0)),
            scan=self._topics.scan_at(pose),
            path=self._topics.path(),
            last=self._topics.last,
            battery_seconds=self._topics.battery_seconds,
            top_speed=self._top_speed,
            truth=self._topics.truth(),
            charges=self._topics.charges,
            bag=self._topics.bag,
        )

    @property
    def _top_speed(self) -> float:
        return min(self._parameters.values.robot_max_speed, self._config.body.max_speed)

    def home(self) -> view.HomeView:
        """Return what seldom changes."""
        return self._topics.home()

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return the newest grid of a layer."""
        return self._topics.layer(name)

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return the newest picture of the angle nearest to one, uint8 [height, width, 3] RGB."""
        return self._camera.picture(degrees)

    def clean(self, request: CleanRequest) -> None:
        """Begin a clean."""
        _require_taken(self._vacuum.begin_clean(request))

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Let the clean of rooms under way go on with these."""
        self._vacuum.change_rooms(rooms, each)

    def explore(self) -> None:
        """Begin to look at what the map does not show yet."""
        _require_taken(self._vacuum.explore())

    def go_to(self, x: float, y: float) -> None:
        """Walk to a point."""
        if self._vacuum.vacuum().state == "cleaning":
            self._vacuum.pause()
        walk = self._vacuum.walk_to(x, y)
        walk.next_feedback(_REFUSED_WITHIN)
        report = walk.report()
        if report is not None and report.outcome is WalkOutcome.REFUSED:
            raise RequestRefusedError(report.message)
        self._walk = walk

    def dock(self) -> None:
        """Go to the charging station."""
        _require_taken(self._vacuum.dock())

    def pause(self) -> None:
        """Stand until told to go on."""
        self._vacuum.pause()

    def resume(self) -> None:
        """Go on."""
        self._vacuum.resume()

    def stop(self) -> None:
        """End the errand, or the walk, and stay."""
        if self._walk is not None:
            self._walk.cancel()
            self._walk = None
        self._vacuum.stop()

    def locate(self) -> None:
        """Beep."""
        self._vacuum.locate()

    def empty_at_station(self) -> None:
        """Let its station empty its bin."""
        self._call("empty_at_station")

    def replace_bag(self) -> None:
        """Put an empty bag into its station; a simulated home only."""
        if not is_offered("sim/replace_bag"):
            raise RequestRefusedError("its station is no simulated one: put a bag in by hand")
        self._call("sim/replace_bag")

    def empty_bin(self) -> None:
        """Tell that the dust bin was emptied."""
        self._vacuum.empty_bin()

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive until it is released."""
        self._call("emergency_stop", True, reason)

    def release(self) -> None:
        """Release the emergency stop."""
        self._call("emergency_stop", False, "")

    def drive(self, linear: float, angular: float) -> None:
        """Drive by hand; the mission pauses for it by itself."""
        if self._topics.held.reason:
            raise RequestRefusedError("the emergency stop holds the drive; release it first")
        with self._hand_lock:
            self._by_hand, self._hand_heard = Twist(linear, angular), time.monotonic()

    def set_top_speed(self, speed: float) -> None:
        """Set the report's parameter, which all nodes look at."""
        self.limits().require_speed(speed)
        key = rospy.search_param("robot_max_speed") or "/robot_max_speed"
        rospy.set_param(key, speed)

    def put_zone(self, zone: view.ZoneView) -> None:
        """Add a zone, or replace the one of the same name."""
        view.require_another_zone(zone.name, [other.name for other in self.home().zones])
        self._call("set_zone", zone_message_of(zone))

    def remove_zone(self, name: str) -> None:
        """Remove a zone."""
        self._call("remove_zone", name)

    def ignore_low_thing(self, x: float, y: float) -> None:
        """Stop offering a zone for what the robot felt there."""
        self._call("ignore_low_thing", x, y)

    def rename_room(self, name: str, new_name: str) -> None:
        """Give a room another name."""
        self._call("rooms/rename", name, new_name)

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Make rooms that touch one."""
        self._call("rooms/join", list(names))

    def split_room(self, name: str, start: Point, end: Point) -> None:
        """Cut a room along a line."""
        self._call("rooms/split", name, PointMessage(*start, 0.0), PointMessage(*end, 0.0))

    def undo_rooms(self) -> None:
        """Take back the newest edit of the rooms."""
        self._call("rooms/undo")

    def spill_dirt(self, x: float, y: float) -> None:
        """Spill a heap of dirt; a simulated home only."""
        self._call("sim/spill", x, y, *SPILL)

    def place_chair(self, x: float, y: float) -> None:
        """Put a chair in the way; a simulated home only."""
        self._interfere("moved_chair", 1.0, x, y)

    def block_station(self) -> None:
        """Put a box before the station."""
        before, radius = STATION_BOX
        place = Pose(*self.home().station).compose(Pose(-before, 0.0, 0.0))
        self._interfere("obstacle", radius, place.x, place.y)

    def clear_away(self) -> None:
        """Take away all that was put down."""
        self._interfere("no_obstacles")

    def set_door(self, name: str, *, is_shut: bool) -> None:
        """Shut or open a door; it shuts as soon as the robot is out of its way."""
        self._call("sim/set_door", name, is_shut)

    def lift(self) -> None:
        """Lift the robot: its wheels hang."""
        self._interfere("lifted", 1.0)

    def put_down(self, x: float, y: float, theta: float) -> None:
        """Put the robot on the floor."""
        self._interfere("put", 1.0, x, y, theta)

    def _interfere(
        self, fault: str, value: float = 1.0, x: float = 0.0, y: float = 0.0, theta: float = 0.0
    ) -> None:
        self._call("sim/inject_fault", fault, value, x, y, theta)

    def _acts(self) -> tuple[str, ...]:
        """Return what can be done to a simulated home; empty for a real one."""
        if not is_offered("sim/inject_fault"):
            return ()
        return tuple(act.value for act in view.PlayAct)

    def _call(self, name: str, *arguments: Any) -> None:
        answer = call_service(self._services[name], *arguments)
        if not answer.success:
            raise RequestRefusedError(answer.message)


def _require_taken(errand: Any) -> None:
    """Wait until a goal is under way; raises RequestRefusedError when its server refuses it."""
    errand.next_feedback(_REFUSED_WITHIN)
    report = errand.report()
    if report is not None and report.outcome is ErrandOutcome.REFUSED:
        raise RequestRefusedError(report.message)
