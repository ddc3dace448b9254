"""The errands of a live robot, a class each: walk, clean, explore, dock and undock."""

from __future__ import annotations

from collections.abc import Callable

from roomba.clean_request import CleanRequest
from roomba.client.protocol import (
    CleanProgress,
    CleanReport,
    DockReport,
    ErrandOutcome,
    ExploreReport,
    WalkOutcome,
    WalkReport,
)
from roomba.configuration.nodes import WalkEndConfig
from roomba.grid import OccupancyMap
from roomba.headless.embodied import Embodied
from roomba.headless.live.errand import LiveErrand, Obey
from roomba.headless.live.snapshots import ErrandsEnded
from roomba.headless.live.views import vacuum_snapshot
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Errand, Event
from roomba.mission.walking.walk import WalkState, expected_duration, feedback_period
from roomba.vocabulary import OVERTAKEN


class LiveWalk(LiveErrand[float, WalkReport]):
    """A walk to a point, m."""

    def __init__(
        self, obey: Obey, ending: Callable[[], str], pace: float, goal: tuple[float, float]
    ) -> None:
        """Begin nothing yet."""
        super().__init__(obey, ending, pace)
        self._goal = goal
        self._way_before = self._way = self._duration = 0.0
        self._rest_by: float | None = None

    def _begin(self, robot: Embodied) -> None:
        walk = robot.brain.walk(*self._goal)
        duration = expected_duration(walk.path, robot.robot_config.body.max_speed)
        self._period = feedback_period(duration) * self._slowness
        self._way_before = robot.distance
        if self._is_due(robot):
            self._tell(walk.path.length)

    def follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Tell what is left of the path, or how it ended; a cancelled walk ends at standstill."""
        self._way = robot.distance - self._way_before
        self._duration = robot.now.time - self._began
        walking = robot.brain.walking
        if walking.is_under_way:
            if self._is_due(robot):
                self._tell(walking.newest.distance_left)
        elif walking.ended is None:
            self._come_to_rest(robot)
        elif walking.ended.state is WalkState.ARRIVED:
            self._end(self._reported(WalkOutcome.ARRIVED, ""))
        else:
            self._end(self._reported(WalkOutcome.FAILED, walking.ended.reason))

    def give_way(self) -> None:
        """End, because something newer took over."""
        self._end(self._reported(WalkOutcome.CANCELLED, OVERTAKEN))

    def _cancel(self, robot: Embodied) -> None:
        robot.brain.walking.end()

    def _come_to_rest(self, robot: Embodied) -> None:
        end, now = WalkEndConfig(), robot.now.time
        if self._rest_by is None:
            self._rest_by = now + end.longest_braking
        stands = abs(robot.now.twist.linear) <= end.standstill
        if robot.mission.state.drives:
            self.give_way()
        elif stands or now >= self._rest_by:
            self._end(self._reported(WalkOutcome.CANCELLED, ""))

    def _refused(self, reason: str) -> WalkReport:
        return self._reported(WalkOutcome.REFUSED, reason)

    def _lost(self, reason: str) -> WalkReport:
        return self._reported(WalkOutcome.DISCONNECTED, reason)

    def _reported(self, outcome: WalkOutcome, message: str) -> WalkReport:
        return WalkReport(outcome, self._way, self._duration, message)


class LiveClean(LiveErrand[CleanProgress, CleanReport]):
    """A clean."""

    def __init__(
        self, obey: Obey, ending: Callable[[], str], pace: float, request: CleanRequest
    ) -> None:
        """Begin nothing yet."""
        super().__init__(obey, ending, pace)
        self._request = request

    def _begin(self, robot: Embodied) -> None:
        robot.mission.clean(self._request, robot.senses())

    def follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Tell how much is clean."""
        if ended.clean is not None:
            self._end(ended.clean)
        elif self._is_due(robot):
            now = vacuum_snapshot(robot)
            self._tell(
                CleanProgress(
                    now.state,
                    now.room,
                    now.covered,
                    now.wanted,
                    now.fraction,
                    now.seconds_to_go,
                    now.battery,
                )
            )

    def give_way(self) -> None:
        """End, because something newer took over."""
        self._end(_empty_clean(ErrandOutcome.STOPPED, OVERTAKEN))

    def _refused(self, reason: str) -> CleanReport:
        return _empty_clean(ErrandOutcome.REFUSED, reason)

    def _lost(self, reason: str) -> CleanReport:
        return _empty_clean(ErrandOutcome.DISCONNECTED, reason)


class LiveExploring(LiveErrand[float, ExploreReport]):
    """An exploration."""

    _known = 0.0
    _looked_at: OccupancyMap | None = None

    def _begin(self, robot: Embodied) -> None:
        begin_exploring(robot)

    def follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Tell how much floor is known."""
        if ended.exploration is not None:
            self._end(ended.exploration)
            return
        occupancy = robot.mission.context.occupancy
        if occupancy is not self._looked_at:
            self._looked_at, self._known = occupancy, occupancy.free_area
        if self._is_due(robot):
            self._tell(self._known)

    def give_way(self) -> None:
        """End, because something newer took over."""
        self._end(self._reported(ErrandOutcome.STOPPED, OVERTAKEN))

    def _refused(self, reason: str) -> ExploreReport:
        return self._reported(ErrandOutcome.REFUSED, reason)

    def _lost(self, reason: str) -> ExploreReport:
        return self._reported(ErrandOutcome.DISCONNECTED, reason)

    def _reported(self, outcome: ErrandOutcome, reason: str) -> ExploreReport:
        return ExploreReport(outcome, reason, self._known, float("nan"), float("nan"))


class LiveDocking(LiveErrand[str, DockReport]):
    """A way into the station, or out of it with Event.UNDOCK."""

    def __init__(
        self, obey: Obey, ending: Callable[[], str], pace: float, event: Event = Event.DOCK
    ) -> None:
        """Begin nothing yet."""
        super().__init__(obey, ending, pace)
        self._event = event
        self._errand = Errand.DOCK if event is Event.DOCK else Errand.UNDOCK

    def _begin(self, robot: Embodied) -> None:
        robot.mission.command(self._event, robot.senses())

    def follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Tell what it does, or how it ended."""
        outcome = robot.mission.way_ended(self._errand)
        if outcome is CleanOutcome.FAULT:
            self._end(DockReport(ErrandOutcome.FAULT, robot.mission.message))
        elif outcome is CleanOutcome.STOPPED:
            self._end(DockReport(ErrandOutcome.STOPPED, "it was stopped"))
        elif outcome is CleanOutcome.COMPLETED:
            self._end(DockReport(ErrandOutcome.COMPLETED, ""))
        elif self._is_due(robot):
            self._tell(robot.mission.state.phase.value)

    def give_way(self) -> None:
        """End, because something newer took over."""
        self._end(DockReport(ErrandOutcome.STOPPED, OVERTAKEN))

    def _refused(self, reason: str) -> DockReport:
        return DockReport(ErrandOutcome.REFUSED, reason)

    def _lost(self, reason: str) -> DockReport:
        return DockReport(ErrandOutcome.DISCONNECTED, reason)


def begin_exploring(robot: Embodied) -> None:
    """Begin to look at what the map does not show yet; raises CommandRefusedError."""
    if not robot.mission.context.is_growing:
        raise CommandRefusedError(
            "the robot knows the map of this home, so there is nothing to explore; to let it make "
            "one anew, start it with --map none"
        )
    robot.mission.explore(robot.senses())


def _empty_clean(outcome: ErrandOutcome, reason: str) -> CleanReport:
    """Return the report of a clean of which there are no numbers."""
    nan = float("nan")
    return CleanReport(outcome, reason, nan, nan, nan, nan, nan, nan)
