"""What can be done to the home of a live headless robot, for teaching; and the truth of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from roomba.client.observed import STATION_BOX
from roomba.client.protocol import RequestRefusedError
from roomba.client.view import DoorView, GridLayer, PlayAct, TruthView
from roomba.geometry import Pose
from roomba.headless.live.camera import LiveCamera
from roomba.headless.mission import HeadlessMission
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator
from roomba.world.truth import HomeTruth


class Playing:
    """The :class:`roomba.headless.live.live_home.LiveHome` of a simulated robot.

    It does to a home what a hand would do, and tells what is really so.
    """

    def __init__(self, home: Home, robot: HeadlessMission) -> None:
        """Play in the home of a robot."""
        self._home, self._robot = home, robot
        self._truth = HomeTruth(home)
        self.name = home.name
        self.camera = LiveCamera(home, robot.robot_config.camera, robot.simulator)

    @property
    def acts(self) -> tuple[str, ...]:
        """What is offered: values of :class:`roomba.client.view.PlayAct`."""
        leaves = self._truth.has_doors
        return tuple(act.value for act in PlayAct if act is not PlayAct.DOOR or leaves)

    @property
    def plan(self) -> Home | None:
        """The home, if the robot goes by its map."""
        return self._home if self._robot.brain.mapper is None else None

    def play(self, act: Callable[[Simulator], None]) -> None:
        """Let a hand reach into the world."""
        robot = self._robot
        act(robot.simulator)
        robot.body.seen = robot.simulator.observe()

    def empty_bin(self) -> None:
        """Empty the dust bin."""
        self._robot.simulator.empty_bin()
        self._robot.look()

    def truth(self) -> TruthView:
        """Return what is really so."""
        now, pose = self._truth.now(self._robot.simulator), self._robot.seen.pose
        doors = tuple(DoorView(door.name, door.opening, door.is_shut) for door in now.doors)
        return TruthView((pose.x, pose.y, pose.theta), now.things, doors, now.is_lifted)

    def dirt(self) -> GridLayer | None:
        """Return the dirt that lies on the floor; None for a home that was turned."""
        told = self._truth.dirt(self._robot.simulator)
        if told is None:
            return None
        frame, share = told
        return GridLayer.over(frame, (255.0 * share).astype(np.uint8), 1)


def replace_bag(simulator: Simulator) -> None:
    """Put an empty bag into the station; raises RequestRefusedError where there is none."""
    if simulator.emptying is None:
        raise RequestRefusedError("its station has no bag: it empties no bin")
    simulator.emptying.replace_bag()


def block_station(simulator: Simulator) -> None:
    """Put a box before the station; raises ValueError where the robot stands."""
    before, radius = STATION_BOX
    place = simulator.home.station.compose(Pose(-before, 0.0, 0.0))
    simulator.place_obstacle(place.x, place.y, radius)


def lift(simulator: Simulator) -> None:
    """Lift the robot: its wheels hang."""
    simulator.inject(Fault.LIFTED, 1.0)


def put_down(simulator: Simulator, pose: Pose) -> None:
    """Put the robot on the floor; raises HomeError where it does not fit."""
    simulator.put(pose)
    simulator.inject(Fault.LIFTED, 0.0)
