"""A robot without a lidar in its body, tick by tick: :mod:`roomba.bumping` and a body."""

from __future__ import annotations

from roomba.bumping.brain import BumpingBrain
from roomba.geometry import Twist
from roomba.robot.body import Body
from roomba.robot.command import Command
from roomba.robot.readings import Readings


class BumpingRobot:
    """One robot, whose time passes only while it is ticked."""

    def __init__(self, body: Body, brain: BumpingBrain) -> None:
        """Put a brain in a body, which stands."""
        self.body, self.brain, self.robot_config = body, brain, brain.robot_config
        self.now: Readings = body.read()

    def forget_rows(self) -> None:
        """Do nothing: it keeps none."""

    def advance(self) -> None:
        """Let a tick pass; while its body cannot be reached, the brain waits."""
        self._pass(Command() if self.body.trouble else self.brain.tick(self.now))

    def steer(self, twist: Twist) -> None:
        """Let one tick pass, driven by hand as far as that is safe."""
        self._pass(Command() if self.body.trouble else self.brain.steer(twist, self.now))

    def _pass(self, command: Command) -> None:
        self.body.act(command)
        self.now = self.body.read()
