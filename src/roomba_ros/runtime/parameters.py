"""The report's parameters on the ROS parameter server: read, validated, and watched."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import rospkg
import rospy

from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig, load_mission_config
from roomba.configuration.nodes import NodesConfig
from roomba.configuration.robot import RobotConfig, load_robot_config
from roomba.configuration.rooms import RoomsConfig
from roomba.configuration.seed import SEED_SPELLINGS, SeedParameters, parse_seed_parameters
from roomba.configuration.simulation import SimulatedRobotConfig, load_simulated_config
from roomba.configuration.things import ThingConfig
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

_LOOK_PERIOD = 0.5
"""s of wall time between two looks for parameters that are newly set."""
_READ_PERIOD = 0.04
"""s of wall time between two reads by a node that is not the guardian: less than a tick in real
time. On a faster clock a read at each tick would take a tenth of the tick."""


def read_seed_parameters() -> SeedParameters:
    """Return the parameters as set now; raises ConfigError for a wrong one."""
    found = {}
    for spellings in SEED_SPELLINGS.values():
        for spelling in spellings:
            key = rospy.search_param(spelling)
            if key is not None:
                found[spelling] = rospy.get_param(key)
    return parse_seed_parameters(found)


def read_robot_config() -> RobotConfig:
    """Return the configuration named by the parameter ``robot_config``, or the shipped one.

    It is a path, or the name of a robot in ``data/configuration/robots``.
    """
    return load_robot_config(_configuration_file("robot"))


def read_simulated_config() -> SimulatedRobotConfig:
    """Return the configuration of ``robot_config``, with what is true of the simulated robot.

    Where that file has no part ``simulation``, the file of the parameter ``simulation_config`` has
    it, or the shipped one.
    """
    return load_simulated_config(_configuration_file("robot"), _configuration_file("simulation"))


def read_mapping_config() -> MappingConfig:
    """Return the configuration named by the parameter ``mapping_config``, or the shipped one."""
    return load_config(MappingConfig, _configuration_file("mapping"))


def read_docking_config() -> DockingConfig:
    """Return the configuration named by the parameter ``docking_config``, or the shipped one."""
    return load_config(DockingConfig, _configuration_file("docking"))


def read_rooms_config() -> RoomsConfig:
    """Return the configuration named by the parameter ``rooms_config``, or the shipped one."""
    return load_config(RoomsConfig, _configuration_file("rooms"))


def read_nodes_config() -> NodesConfig:
    """Return the configuration named by the parameter ``nodes_config``, or the shipped one."""
    return load_config(NodesConfig, _configuration_file("nodes"))


def read_thing_config() -> ThingConfig:
    """Return the configuration named by the parameter ``things_config``, or the shipped one."""
    return load_config(ThingConfig, _configuration_file("things"))


def read_mission_config(robot: RobotConfig) -> MissionConfig:
    """Return the configuration named by the parameter ``mission_config``, or the shipped one.

    The shipped one is slowed down for a slower robot. A named one is not: ConfigError is raised if
    it has speeds that the robot cannot reach.
    """
    if rospy.search_param("mission_config"):
        return load_mission_config(_configuration_file("mission"), robot.body)
    return load_config(MissionConfig, _configuration_file("mission")).slowed_for(robot.body)


def _configuration_file(part: str) -> Path:
    """Return the file of a part; its parameter may also be the name of a shipped robot."""
    key = rospy.search_param(f"{part}_config")
    if not key:
        return CONFIGURATION / f"{part}.yaml"
    named = str(rospy.get_param(key))
    shipped = CONFIGURATION / "robots" / f"{named}.yaml"
    return shipped if named.isidentifier() and shipped.is_file() else Path(named)


def bool_parameter(name: str, default: bool) -> bool:
    """Return a parameter that is true or false; raises ConfigError for any other value."""
    value = rospy.get_param(name, default)
    if not isinstance(value, bool):
        raise ConfigError(f"parameter {name}: expected true or false, got {value!r}")
    return value


def folder_of(parameter: str, name: str) -> Path:
    """Return the folder that a parameter names; by default one of that name for this robot's files,
    in roomba_robot in the ROS home folder.
    """
    return folder_for(str(rospy.get_param(parameter, "")), name)


def folder_for(given: str, name: str) -> Path:
    """Return the folder that was given, or the one of that name for this robot's files."""
    return Path(given or Path(rospkg.get_ros_home()) / "roomba_robot" / name)


def robot_name() -> str:
    """Return the robot's namespace as the name of a file; ``robot`` where it has none."""
    return rospy.get_namespace().strip("/").replace("/", "_") or "robot"


def robot_run() -> str:
    """Return the name of this run of the robot: work of another run is not resumed in it.

    The launch file gives each start a new name. Without one the name is that of the master's run,
    which outlives runs of the robot.
    """
    return str(rospy.get_param("robot_run", "") or rospy.get_param("/run_id", ""))


def package_folder() -> Path:
    """Return where this package's launch, config and homes folders are."""
    return Path(rospkg.RosPack().get_path("roomba_robot"))


class LiveSeedParameters:
    """The parameters in force: a good change is obeyed, a bad one is refused with a warning.

    The master tells this node of changes, so that reading a parameter costs no call. One node of a
    robot is the ``guardian``. It reads at each tick, restores the value before a refused one, and
    copies values of the report's other spellings to the parameters' own names, which all nodes
    watch.
    """

    def __init__(self, *, guardian: bool = False) -> None:
        """Read them all; raises ConfigError."""
        self._guardian = guardian
        self.values = read_seed_parameters()
        self._keys = {
            name: rospy.search_param(name) or rospy.resolve_name(name) for name in SEED_SPELLINGS
        }
        self._unset: dict[str, float] = {}
        self._looked = self._read = time.monotonic()
        self._seen = self._raw()

    def refresh(self) -> SeedParameters:
        """Take over what was changed since the last look; return what is in force.

        But for the guardian there are 0.04 s of wall time between two looks.
        """
        now = time.monotonic()
        if not self._guardian and now - self._read < _READ_PERIOD:
            return self.values
        self._read = now
        try:
            if self._guardian:
                self._adopt_other_spellings()
            raw = self._raw()
            if raw != self._seen:
                self._take_over(raw)
        except OSError as error:
            rospy.logwarn_throttle(10.0, "the master does not answer, parameters stay: %s", error)
        return self.values

    def _take_over(self, raw: dict[str, Any]) -> None:
        changed = {name: raw.get(name) for name in raw if raw.get(name) != self._seen.get(name)}
        self._seen = raw
        try:
            self.values = parse_seed_parameters(raw)
            rospy.loginfo("parameters changed: %s", changed)
        except ConfigError as error:
            rospy.logwarn("refused: %s; the old value stays in force", error)
            if self._guardian:
                for name in changed:
                    rospy.set_param(self._keys[name], getattr(self.values, name))

    def _raw(self) -> dict[str, Any]:
        raw = {}
        now = time.monotonic()
        for name, key in self._keys.items():
            if now < self._unset.get(name, 0.0):
                continue
            try:
                value = rospy.get_param_cached(key)
            except KeyError:
                value = {}
            # By an empty dictionary the master tells that a parameter is not set; each further read
            # of it would be a call of the master.
            if value == {}:
                self._unset[name] = now + _LOOK_PERIOD
            else:
                raw[name] = value
        return raw

    def _adopt_other_spellings(self) -> None:
        now = time.monotonic()
        if now - self._looked < _LOOK_PERIOD:
            return
        self._looked = now
        names = set(rospy.get_param_names())
        for name, (_, *others) in SEED_SPELLINGS.items():
            for other in others:
                key = f"{self._keys[name].rpartition('/')[0]}/{other}"
                if key in names:
                    rospy.set_param(self._keys[name], rospy.get_param(key))
                    rospy.delete_param(key)
                    rospy.loginfo("%s is taken for %s", key, self._keys[name])
