"""Makes planning contexts in the background: each takes a while, and the mission must go on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import rospy

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError, RoomsError
from roomba.geometry import Pose
from roomba.grid import FREE, OccupancyMap
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zones, ZonesError
from roomba.planning.coverage.stages import OUR_STAGES
from roomba_ros.convert.rooms import RoomOutlines
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.timing.heart import HEART

MOST_FINE_CELLS: Final = 40_000_000
"""Of a map that is cleaned: 4,000 m2, its walls and surroundings included."""


@dataclass(frozen=True, slots=True, eq=False)
class ContextInputs:
    """The inputs of a context; ``zones`` None: they cannot be read, and ``unreadable`` says why."""

    occupancy: OccupancyMap
    digest: str
    station: Pose
    outlines: RoomOutlines | None
    zones: Zones | None
    unreadable: str


class ContextMaker:
    """Makes contexts of what is known when their turn comes; of several requests only the last.

    ``lock`` also guards the inputs of a context: hold it to request one.
    """

    def __init__(
        self,
        robot: RobotConfig,
        mission: MissionConfig,
        docking: DockingConfig,
        background: Background,
        lock: threading.Lock,
        inputs: Callable[[], ContextInputs | None],
    ) -> None:
        """Make none yet; ``inputs`` returns what is known now, None if too little is.

        It is called with the lock held.
        """
        self._robot, self._mission, self._docking = robot, mission, docking
        self._background, self._lock, self._inputs = background, lock, inputs
        self._wanted = self._tried = 0
        self._make_after: float | None = None
        self._is_edited = False
        self._made: KnownHome | None = None
        self._field: tuple[OccupancyMap, SurfaceField] | None = None
        """The newest map with its surface field; only the background's thread uses it."""
        self.trouble = ""
        """Why there is no context of this map, in words; empty while one may still come."""

    @property
    def has_begun(self) -> bool:
        """Whether any context was wanted; hold the lock."""
        return self._wanted > 0

    @property
    def is_changing(self) -> bool:
        """Whether a context that differs by more than new floor of a growing map is being made."""
        with self._lock:
            is_another = self._wanted != self._tried or self._made is not None
            return is_another and self._is_edited

    def take(self) -> KnownHome | None:
        """Return a context that was made since the last call."""
        with self._lock:
            if self._wanted != self._tried:
                return None
            made, self._made = self._made, None
            return made

    def make(self, *, is_edited: bool = True, wait: float = 0.0) -> None:
        """Let a context be made ``wait`` s from now, of what is known then; hold the lock."""
        self._is_edited = is_edited or (self._is_edited and self._wanted != self._tried)
        self._wanted += 1
        if wait > 0.0:
            self._make_after = time.monotonic() + wait
        else:
            self._make_soon()

    def tick(self) -> None:
        """Begin the context that was to wait, if it waited long enough; hold the lock."""
        if self._make_after is not None and time.monotonic() > self._make_after:
            self._make_soon()

    def _make_soon(self) -> None:
        self._make_after = None
        self._background.do("no context for the mission", self._make_now)

    def _make_now(self) -> None:
        with self._lock:
            wanted, inputs = self._wanted, self._inputs()
        made, trouble = None, ""
        began = time.monotonic()
        try:
            if inputs is not None:
                made = self._home_of(inputs)
        except (RoombaError, ValueError, MemoryError) as error:
            trouble = f"nothing can be cleaned in this map: {error}"
            rospy.logwarn(trouble)
        rospy.logdebug("a context was made in %.2f s", time.monotonic() - began)
        with self._lock:
            # If a newer one was requested meanwhile, it is in the queue already.
            if wanted == self._wanted:
                self._tried, self._made, self.trouble = wanted, made, trouble

    def _home_of(self, inputs: ContextInputs) -> KnownHome:
        """Return what is made of the inputs; raises RoombaError, ValueError, MemoryError."""
        if inputs.zones is None:
            raise ZonesError(inputs.unreadable)
        _require_small(inputs.occupancy, self._mission.coverage.cell)
        field = self._field_of(inputs.occupancy)
        context = PlanningContext(
            inputs.occupancy,
            inputs.station,
            self._robot,
            self._mission,
            self._docking,
            _rooms(inputs.outlines, inputs.occupancy),
            inputs.zones,
            is_growing=inputs.digest == GROWING,
            # The main loop waits for the plan, so the plan's stages give the sign of life.
            stages=OUR_STAGES.telling(HEART.beat),
        )
        if not context.is_growing:
            # Computed here, in the background: it takes a while, and the mission shall not wait for
            # it.
            _ = context.coverage
        return KnownHome(context, field, inputs.digest)

    def _field_of(self, occupancy: OccupancyMap) -> SurfaceField:
        """Return the surface field of a map, which edits of zones and rooms do not change."""
        if self._field is None or self._field[0] is not occupancy:
            self._field = occupancy, SurfaceField.of(occupancy)
        return self._field[1]


def _require_small(occupancy: OccupancyMap, cell: float) -> None:
    frame = occupancy.frame
    cells = frame.rows * frame.columns * max(1, round(frame.resolution / cell)) ** 2
    if cells > MOST_FINE_CELLS:
        raise RoombaError(
            f"expected a map of {MOST_FINE_CELLS * cell**2:g} m2 at most, got one of "
            f"{cells * cell**2:g} m2; cut it to what is to be cleaned"
        )


def _rooms(outlines: RoomOutlines | None, occupancy: OccupancyMap) -> Rooms | None:
    if not outlines:
        return None
    try:
        return Rooms.from_outlines(occupancy.frame, occupancy.values == FREE, outlines)
    except (RoomsError, ValueError) as error:
        rospy.logwarn("the mission knows no rooms: %s", error)
        return None
