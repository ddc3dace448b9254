"""Cleaning, docking and undocking on ROS: the mission, fed with what the robot senses."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import rospy
from std_srvs.srv import Trigger

from roomba.geometry import STANDSTILL
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.ticks import MissionStep
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.mapped_mission import MappedMission
from roomba.storage.checkpoint import Checkpoint
from roomba.storage.free_space import require_free_space
from roomba.vocabulary import Phase, listed
from roomba_ros.mission.carpets import CarpetTopics
from roomba_ros.mission.drive import MissionDrive
from roomba_ros.mission.felt_on_maps import CARPETS, LOW_THINGS, FeltOnMaps
from roomba_ros.mission.goals import Ended
from roomba_ros.mission.home import HomeTopics
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.mission.low_things import LowThingTopics
from roomba_ros.mission.memory import MissionMemory
from roomba_ros.mission.orders import MissionOrders
from roomba_ros.mission.round import MissionRound
from roomba_ros.mission.topics import MissionTopics
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.calls import call_service
from roomba_ros.runtime.graph.alone import refuse_second
from roomba_ros.runtime.heap import give_back
from roomba_ros.runtime.node import require_master, run_node
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    folder_of,
    read_docking_config,
    read_mission_config,
    read_nodes_config,
    read_robot_config,
    read_thing_config,
)
from roomba_ros.senses.senses import HeardSenses

NAME = "mission_node"
_NEEDED = ("odom", "battery_state", "dock_status")
"""The topics of the body without which no errand can begin."""
_HEARD = (
    *_NEEDED,
    "imu",
    "scan",
    "bumper",
    "cliff",
    "wheel_drop",
    "ir_omni",
    "dirt_detect",
    "bin_level",
    "brush_current",
    "emptying_station",
)
_SILENT = "no message tells its place; is position_pub_node running?"


class MissionNode:
    """Ticks one mission for each map; a restarted node resumes the errand that was under way.

    Publishes, subscribes and serves what :class:`HeardSenses`, :class:`HomeTopics`,
    :class:`LowThingTopics`, :class:`CarpetTopics`, :class:`MissionOrders`, :class:`MissionDrive`
    and :class:`MissionTopics` say. Of the body it hears ``odom``, ``imu``, ``scan``, ``bumper``,
    ``cliff``, ``wheel_drop``, ``battery_state``, ``dock_status``, ``ir_omni``, ``dirt_detect``,
    ``bin_level``, ``brush_current`` and ``emptying_station``.
    Parameters: ``robot_config``, ``mission_config``, ``docking_config``, ``things_config``,
    ``nodes_config`` (paths of configuration files; by default the shipped ones),
    ``~memory_folder`` (default: roomba_robot/mission in the ROS home folder, and in it a folder for
    each robot's namespace),
    ``~zones_folder`` (default: roomba_robot/zones there), ``robot_max_speed`` (m/s; it may change
    at any time).
    """

    period: float

    def start(self) -> None:
        """Read the configuration and connect."""
        self._config, self._nodes = read_robot_config(), read_nodes_config()
        self._mission_config = read_mission_config(self._config)
        self._parameters = LiveSeedParameters()
        self.period = self._config.timing.tick
        self._longest_silence = self._config.longest_silence_at(self._mission_config.top_speed)
        docking = read_docking_config()
        self._mapped = MappedMission(
            self._config,
            self._mission_config,
            docking,
            self._parameters.values.robot_max_speed,
            read_thing_config(),
        )
        self._background = Background()
        self._memory_folder = folder_of("~memory_folder", "mission")
        self._home: KnownHome | None = None
        self._newer: KnownHome | None = None
        self._memory: MissionMemory | None = None
        self._finished = -self._nodes.periods.finish
        self._looked_at_disk = -math.inf
        self._senses = HeardSenses(self._config, self._nodes.hearing, *_HEARD)
        zones_folder = folder_of("~zones_folder", "zones")
        self._context = HomeTopics(
            self._config,
            self._mission_config,
            docking,
            self._nodes.deadlines,
            self._background,
            zones_folder,
        )
        self._low_things = LowThingTopics(FeltOnMaps(LOW_THINGS, self._background, zones_folder))
        self._carpets = CarpetTopics(FeltOnMaps(CARPETS, self._background, zones_folder))
        self._drive = MissionDrive(self._config, self._nodes.deadlines.ending)
        self._orders = MissionOrders(self._drive.take, self._nodes.deadlines)
        self._topics = MissionTopics(self._mission_config, self._nodes.periods, self._background)
        self._round = MissionRound(self._orders, self._topics, self._drive, self._step)
        for part in (
            self._background,
            self._topics,
            self._drive,
            self._senses,
            self._context,
            self._low_things,
            self._carpets,
            self._orders,
        ):
            part.start()

    def tick(self, now: float) -> None:
        """Sense, obey, answer, act, publish, save."""
        self._drive.follow_clock(now)
        senses = self._sense(now)
        self._mapped.limit_speed(self._parameters.refresh().robot_max_speed)
        self._follow_home(now, senses)
        self._watch_disk()
        mission = self._mapped.mission
        self._orders.serve(mission is not None)
        if mission is None or senses is None:
            self._wait(now)
            return
        if self._home is not None:
            self._low_things.tick(now, mission, self._home)
            self._carpets.tick(now, mission, self._home)
        begins = not self._context.is_changing
        step, ended = self._round.tick(now, mission, senses, begins=begins)
        self._finish_map(ended, is_waited_for=step.wants_whole_map)
        self._remember(mission, senses, has_learned=ended.clean is not None)
        if ended.clean is not None or ended.exploration is not None:
            # Planning leaves many free pieces of heap, which would stay with the process for good.
            give_back()

    def stop(self) -> None:
        """Stop the drive; the goals under way are given up."""
        self._drive.stop()
        self._orders.give_up("the mission node was told to end")
        self._background.wait(1.0)

    def _sense(self, now: float) -> Senses | None:
        """Return what is sensed, and look in the scan for things that the map does not show."""
        senses = self._senses.at(now)
        self._senses.show(self._mapped.lookout)
        if senses is None or self._senses.missing(*_NEEDED):
            return None
        if self._senses.place.is_silent(now):
            return replace(senses, knowledge=Knowledge.SEARCHING, trouble=_SILENT)
        return senses

    def _wait(self, now: float) -> None:
        """Tell what is still missing."""
        missing = self._context.missing + self._senses.missing(*_NEEDED)
        reason = self._context.trouble or (
            f"waits for {listed(missing)}" if missing else "gets to know its map"
        )
        self._orders.refuse(f"the robot is not ready: it {reason}")
        self._topics.wait(now, reason)

    def _follow_home(self, now: float, senses: Senses | None) -> None:
        """Take over a new context, or begin a new mission for another map."""
        self._context.tick()
        if senses is None:
            return
        home = self._newer = self._context.take() or self._newer
        if home is None:
            return
        mission, before = self._mapped.mission, self._home
        if mission is not None and before is not None:
            if before.context.is_growing:
                self._grow(mission, senses, before, home)
                return
            if home.digest == before.digest:
                self._newer = None
                mission.use_context(home.context)
                return
            self._orders.give_up("the robot was given another map")
            if self._memory is not None:
                self._memory.forget_errand()
        self._home, self._newer = home, None
        self._begin(home, senses)

    def _grow(self, mission: Mission, senses: Senses, before: KnownHome, home: KnownHome) -> None:
        """Let the mission go on with another state of its map, if that matters to it."""
        if home.context.occupancy is before.context.occupancy:
            mission.use_context(home.context)
        elif home.context.is_growing and not (
            home.is_edit_of(before) or mission.wants_map(home.context.occupancy)
        ):
            return
        else:
            self._mapped.go_on(home.context, home.field)
            if home.digest != before.digest:
                self._remember_by(home, mission, senses)
        self._home, self._newer = home, None

    def _remember_by(self, home: KnownHome, mission: Mission, senses: Senses) -> None:
        """Save the errand under way by the finished map, which takes the growing map's place."""
        assert self._memory is not None
        before, self._memory = self._memory, self._memory_by(home.digest)
        self._memory.keep(mission, senses, self._orders.goal)
        before.forget_errand()

    def _begin(self, home: KnownHome, senses: Senses) -> None:
        """Begin a mission for a map; resume the errand that was under way there."""
        mission = self._mapped.begin(home.context, home.field, senses)
        self._memory = self._memory_by(home.digest)
        if not home.context.is_growing:
            self._memory.recall_dirt(mission.dirt)
        found = self._memory.recall_errand(mission, senses)
        found = found or self._recall_growing(mission, senses)
        if found is not None:
            self._orders.adopt(found.goal)
            self._drive.take()

    def _recall_growing(self, mission: Mission, senses: Senses) -> Checkpoint | None:
        """Resume the errand that was under way on this map while it was being made."""
        if mission.context.is_growing:
            return None
        memory = self._memory_by(GROWING)
        found = memory.recall_errand(mission, senses)
        if found is not None:
            assert self._memory is not None
            self._memory.keep(mission, senses, found.goal)
            memory.forget_errand()
        return found

    def _memory_by(self, digest: str) -> MissionMemory:
        robot = rospy.get_namespace().strip("/") or "robot"
        folder = self._memory_folder / robot
        return MissionMemory(folder, digest, self._nodes.memory, self._background)

    def _watch_disk(self) -> None:
        """Report while the disk is full."""
        memory, now = self._nodes.memory, time.monotonic()
        if now - self._looked_at_disk < memory.free_space_period:
            return
        self._looked_at_disk = now
        self._background.do(
            "maps, pictures and the errand may not be kept",
            lambda: require_free_space(self._memory_folder, memory.free_space),
        )

    def _step(self, mission: Mission, senses: Senses) -> MissionStep:
        if self._context.is_changing and mission.state.drives:
            # Edited zones are obeyed at once: until they are in use the robot stands.
            return MissionStep()
        step = mission.tick(senses)
        is_late = self._senses.place.is_late(senses.now, self._longest_silence)
        # Docking needs no pose: it goes by the station's beams.
        if is_late and mission.state.phase is not Phase.DOCKING:
            return replace(step, twist=STANDSTILL)
        return step

    def _finish_map(self, ended: Ended, *, is_waited_for: bool) -> None:
        """Ask the maker of the map to finish it once everything was explored."""
        is_explored = ended.exploration is not None and ended.exploration.is_completed
        since = time.monotonic() - self._finished
        if is_explored or (is_waited_for and since > self._nodes.periods.finish):
            self._finished = time.monotonic()
            whole = rospy.ServiceProxy("map/finish", Trigger)
            self._background.do("the map is not finished", lambda: call_service(whole))

    def _remember(self, mission: Mission, senses: Senses, *, has_learned: bool) -> None:
        assert self._memory is not None
        self._memory.keep(mission, senses, self._orders.goal)
        if has_learned:
            self._memory.keep_dirt(mission.dirt)


def main() -> None:
    """Run the node, unless another one serves this robot already."""
    require_master()
    refuse_second(NAME, "vacuum/state")
    run_node(NAME, MissionNode)
