"""Driving one path after the other through the home, and what is remembered on the way."""

from __future__ import annotations

from collections.abc import Callable

from roomba.arrays import Floats
from roomba.configuration.mission import DrivingConfig
from roomba.configuration.robot import RobotConfig
from roomba.mission.driving.give_way import way_aside
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.path_driver import PathDriver
from roomba.mission.driving.rejoin import Rejoin
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.planning.path.planner import NoPathError, NoPathReason


class Drives:
    """``driver`` drives the present path, None without one; ``context`` is what it plans on.

    ``is_round``: the path is one over the floor that a clean planned.
    """

    def __init__(
        self,
        context: PlanningContext,
        robot: RobotConfig,
        config: DrivingConfig,
        obstacles: Obstacles,
    ) -> None:
        """Begin without a path."""
        self._robot, self._config = robot, config
        self.obstacles, self.trail = obstacles, Trail()
        self.driver: PathDriver | None = None
        self.is_round = False
        self.use_context(context)

    def use_context(self, context: PlanningContext) -> None:
        """Plan there from now on; the present path is driven on."""
        self.context = context
        self._rejoin = Rejoin(context, self._robot.body.radius, self._config)

    def begin(
        self,
        points: Floats,
        senses: Senses,
        plans_anew: Callable[[float, Floats], bool] | None = None,
    ) -> None:
        """Begin to drive along points, float64 [n, 2], m.

        A round of a clean has ``plans_anew``: see :class:`PathDriver`.
        """
        self.is_round = plans_anew is not None
        self.driver = PathDriver(
            points,
            self._rejoin,
            self.obstacles,
            self.trail,
            self._config,
            self._robot,
            senses,
            plans_anew or _never,
        )

    def caught_up(self, senses: Senses, places: Floats) -> None:
        """Go on after ticks that only the tracker ran, begun at ``places``, float64 [n, 2], m."""
        if self.driver is not None:
            self.trail.add_all(places)
            self.driver.caught_up(senses)

    def begin_to_leave_zone(self, senses: Senses) -> bool:
        """Begin to drive out of the no-go zone that the robot is in; return whether a drive began.

        None does outside of zones, nor where no way leads out.
        """
        here = (senses.pose.x, senses.pose.y)
        if not self.context.is_in_zone(here):
            return False
        try:
            points = self.context.way_out_of_zone(here, self.obstacles.standing(senses.now))
        except NoPathError:
            return False
        self.begin(points, senses)
        return True

    def way_home(self, senses: Senses) -> Floats:
        """Return the way to the place before the station; raises NoPathError without one."""
        return self._rejoin.way_home(senses, self.obstacles, self.trail)

    def way_out(self, senses: Senses) -> Floats | None:
        """Return the beginning of the way home, for a place that no path leads out of, or None."""
        return self._rejoin.way_out(senses, self.obstacles, self.trail)

    def make_room(self, senses: Senses) -> None:
        """Begin to drive aside, so that a person beside the robot can pass; if there is room."""
        config = self._config.giving_way
        points = way_aside(self.context.paths, senses, self.obstacles, self.trail, config)
        if points is not None:
            self.begin(points, senses)

    def may_go_home(self, senses: Senses) -> bool:
        """Whether a way leads home, by what is known to stand in it now."""
        return self._length_home(senses) is not None

    def is_parted_from_home(self, senses: Senses) -> bool:
        """Whether walls and zones, which stay, part the robot from its station.

        False while the map grows: it may show a way yet.
        """
        context = self.context
        if context.is_growing:
            return False
        try:
            context.squeeze(
                (senses.pose.x, senses.pose.y), (context.staging.x, context.staging.y), ()
            )
        except NoPathError as error:
            return error.reason is NoPathReason.GOAL_UNREACHABLE
        return False

    def distance_home(self, senses: Senses) -> float:
        """Return how far it is home, m; the map's width plus its height where no way is known."""
        length = self._length_home(senses)
        if length is None:
            left, right, low, high = self.context.known.frame.extent
            return right - left + high - low
        return length

    def _length_home(self, senses: Senses) -> float | None:
        here, staging = (senses.pose.x, senses.pose.y), self.context.staging
        obstacles = self.obstacles.standing(senses.now)
        try:
            return self.context.paths.plan(here, (staging.x, staging.y), obstacles).length
        except NoPathError:
            return None

    def forget_place(self) -> None:
        """Forget trail and obstacles: the robot is elsewhere, and they are of another place."""
        self.trail.forget()
        self.obstacles.forget()


def _never(now: float, rest: Floats) -> bool:
    return False
