"""A mission and its map: begun on the first one, gone on with on newer ones."""

from __future__ import annotations

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.things import ThingConfig
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.dirt_map import DirtMap
from roomba.robot.lookout import Lookout
from roomba.vocabulary import CarpetWay, FanLevel, Phase


class MappedMission:
    """Keeps the ``mission``, None before the first map, and the ``lookout`` beside its map."""

    def __init__(
        self,
        robot: RobotConfig,
        config: MissionConfig,
        docking: DockingConfig,
        max_speed: float,
        things: ThingConfig | None = None,
    ) -> None:
        """Begin without a map; ``max_speed`` is the robot's top speed, m/s."""
        self._configs = robot, config, docking
        self._max_speed = max_speed
        self.lookout = Lookout(robot, things)
        self.mission: Mission | None = None

    def begin(self, context: PlanningContext, field: SurfaceField, senses: Senses) -> Mission:
        """Begin a mission on a map, whose surfaces ``field`` has; return it."""
        things = self.lookout.look_beside(field)
        dirt = DirtMap(context.occupancy)
        self.mission = Mission(context, *self._configs, things, dirt, senses, self._max_speed)
        return self.mission

    def go_on(self, context: PlanningContext, field: SurfaceField) -> None:
        """Go on with more of the map, or with the whole one; there must be a mission."""
        assert self.mission is not None
        things = self.lookout.look_beside(field)
        self.mission.use_map(context, things, DirtMap(context.occupancy))

    def limit_speed(self, max_speed: float) -> None:
        """Set the robot's top speed, m/s."""
        self._max_speed = max_speed
        if self.mission is not None:
            self.mission.max_speed = max_speed


def fan_of(mission: Mission) -> FanLevel | None:
    """Return the fan's level that a clean asks for where the robot is; None without one."""
    cleaning = mission.cleaning
    if cleaning is None or mission.state.phase in (Phase.ERROR, Phase.EMERGENCY):
        return None
    stage, request = cleaning.ledger.stage, cleaning.ledger.request
    asked = request.way_of("" if stage is None else stage.name).fan
    boosts = request.carpets is CarpetWay.BOOST and asked is not FanLevel.QUIET
    return FanLevel.STRONG if boosts and mission.is_on_carpet else asked
