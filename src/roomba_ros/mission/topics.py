"""The topics of the mission: its state, coverage and dirt maps, and its path."""

from __future__ import annotations

import copy
import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np
import rospy
import shapely
from nav_msgs.msg import OccupancyGrid, Path
from numpy.typing import NDArray
from roomba_robot.msg import VacuumState
from std_msgs.msg import String

from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import PeriodsConfig
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import VACUUM_STATES
from roomba.perception.swept.dirt_map import dirty_from
from roomba.shares import share_of
from roomba.vocabulary import Reason
from roomba_ros.convert.clean_action import put_reason, way_codes
from roomba_ros.convert.client import BATTERY_NOT_HEARD
from roomba_ros.convert.common import header, path_message
from roomba_ros.convert.mapping import coverage_message, dirt_message
from roomba_ros.convert.values import data_of
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.senders import SUPERVISOR, OnlyFrom
from roomba_ros.runtime.subscriptions import subscribe

STARTING: Final = "starting"
"""The phase that is told until there is a mission."""
_DRAWN = 0.003
"""m; the published path is as near to the driven one, with fewer points."""


class MissionTopics:
    """Publishes ``vacuum/state`` (VacuumState, latched, at each change and 1 Hz), ``plan`` (Path,
    latched: what it drives now), ``coverage_map`` and ``dirt_map`` (OccupancyGrid, latched, 1 Hz
    while it cleans and has subscribers, and at the end of a clean).

    Subscribes: ``trouble`` (String: what is wrong with the robot's processes).
    """

    def __init__(
        self, config: MissionConfig, periods: PeriodsConfig, background: Background
    ) -> None:
        """Connect nothing yet."""
        self._config, self._periods, self._background = config, periods, background
        self._said: tuple[object, ...] = ()
        self._told = self._mapped = -math.inf
        self._mapped_wall = 0.0
        self._points: NDArray[np.float64] | None = None
        self._cleaned = False
        self._trouble = ""
        self._newest: tuple[VacuumState, Reason] | None = None

    def start(self) -> None:
        """Connect."""
        self._state = rospy.Publisher("vacuum/state", VacuumState, queue_size=5, latch=True)
        self._plan = rospy.Publisher("plan", Path, queue_size=1, latch=True)
        self._coverage = rospy.Publisher("coverage_map", OccupancyGrid, queue_size=1, latch=True)
        self._dirt = rospy.Publisher("dirt_map", OccupancyGrid, queue_size=1, latch=True)
        supervisor = OnlyFrom(SUPERVISOR)
        subscribe("trouble", String, data_of, self._on_trouble, senders=supervisor)

    def wait(self, now: float, reason: str) -> None:
        """Tell that there is no mission yet, and why."""
        said = (STARTING, reason)
        if self._is_due(now, said):
            self._state.publish(
                VacuumState(
                    header=header(now, ""),
                    state="idle",
                    phase=STARTING,
                    message=reason,
                    battery=BATTERY_NOT_HEARD,
                )
            )

    def tell(self, now: float, mission: Mission, senses: Senses) -> VacuumState | None:
        """Publish what is due; return the state if it is told now."""
        self._show_plan(now, mission)
        self._show_maps(now, mission)
        reason = mission.reason
        text = "; ".join(filter(None, (reason.text, self._background.trouble)))
        own = replace(reason, text=text)
        if not self._is_due(
            now,
            (
                mission.state,
                mission.queue,
                mission.queue_ways,
                mission.is_on_carpet,
                self._trouble,
                own,
            ),
        ):
            return None
        self._newest = (state_of(now, mission, senses), own)
        return self._tell_newest(*self._newest)

    def _tell_newest(self, state: VacuumState, own: Reason) -> VacuumState:
        put_reason(state, with_trouble(self._trouble, own))
        self._state.publish(state)
        return state

    def _on_trouble(self, trouble: str) -> None:
        """Publish at once: a simulated clock stands while a node is stopped, so no tick comes."""
        self._trouble = trouble
        newest = self._newest
        if newest is not None:
            self._tell_newest(copy.copy(newest[0]), newest[1])

    def _is_due(self, now: float, said: tuple[object, ...]) -> bool:
        if said == self._said and 0.0 <= now - self._told < self._periods.mission_state:
            return False
        self._said, self._told = said, now
        return True

    def _show_plan(self, now: float, mission: Mission) -> None:
        points = None if mission.driver is None else mission.driver.tracker.course.points
        if points is self._points:
            return
        self._points = points
        if points is not None:
            self._background.do(
                "no plan is shown",
                lambda: self._plan.publish(path_message(now, shown(points), "map")),
            )

    def _show_maps(self, now: float, mission: Mission) -> None:
        cleans = mission.cleaning is not None and mission.state.drives
        has_ended, self._cleaned = self._cleaned and not cleans, cleans
        since, since_wall = now - self._mapped, time.monotonic() - self._mapped_wall
        periods = self._periods
        is_due = not 0.0 <= since < periods.mission_map and since_wall >= periods.mission_map_wall
        if not (has_ended or (cleans and is_due)):
            return
        self._mapped, self._mapped_wall = now, time.monotonic()
        rows = mission.context.known.frame.rows
        if mission.cleaning is not None and (has_ended or self._coverage.get_num_connections()):
            coverage = mission.cleaning.ledger.coverage
            cells, frame = coverage.cells.copy(), coverage.frame
            self._show(self._coverage, lambda: coverage_message(now, cells, frame, rows, "map"))
        if has_ended or self._dirt.get_num_connections():
            dirt, config = mission.dirt, self._config.cleaning
            density = dirt.known()
            dirty = dirty_from(density, config.dirty_times, config.least_dirt)
            self._show(self._dirt, lambda: dirt_message(now, density, dirt.frame, dirty, "map"))

    def _show(self, publisher: rospy.Publisher, message: Callable[[], OccupancyGrid]) -> None:
        self._background.do(f"no {publisher.name} is shown", lambda: publisher.publish(message()))


def with_trouble(trouble: str, own: Reason) -> Reason:
    """Return the reason with the trouble of the robot's processes, if there is any, before it.

    A trouble has no hindrance, and comes first: it may be the cause of all else.
    """
    return Reason("; ".join(filter(None, (trouble, own.text)))) if trouble else own


def state_of(now: float, mission: Mission, senses: Senses) -> VacuumState:
    """Return the mission's state, in the words of smart homes."""
    passes, fans = way_codes(mission.queue_ways)
    state = VacuumState(
        header=header(now, ""),
        state=VACUUM_STATES[mission.state.phase],
        phase=mission.state.phase.value,
        battery=senses.battery.level,
        queue=mission.queue,
        queue_passes=passes,
        queue_fans=fans,
        on_carpet=mission.is_on_carpet,
    )
    put_reason(state, mission.reason)
    if senses.knowledge.is_usable:
        state.room = mission.context.room_at(senses.pose.x, senses.pose.y)
    if mission.cleaning is not None:
        # Stored once: each call looks at every cell of the floor.
        state.covered = mission.cleaning.ledger.clean_area
        state.wanted = mission.cleaning.ledger.coverage.wanted_area
        state.fraction = share_of(state.covered, state.wanted)
        state.seconds_to_go = mission.seconds_to_go()
    return state


def shown(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a path, float64 [n, 2], with as few points as it needs to be drawn."""
    if len(points) < 3:
        return points
    line = shapely.LineString(points).simplify(_DRAWN, preserve_topology=False)
    return np.asarray(line.coords, np.float64)
