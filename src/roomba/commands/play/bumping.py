"""A robot on a line without a lidar, from take-over to give-back."""

from __future__ import annotations

import argparse

import numpy as np

from roomba.bumping.brain import BumpingBrain
from roomba.commands.play.owned import kind_of
from roomba.configuration.bumping import BumpingConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import load_config
from roomba.drivers.line_body import LineBody
from roomba.drivers.robots.table import OwnedRobot
from roomba.files.shipped import CONFIGURATION
from roomba.headless.live.bumping.client import BumpingClient
from roomba.headless.live.bumping.robot import BumpingRobot


class BumpingLife:
    """A robot on a line that sweeps by bump and go."""

    def __init__(self, kind: OwnedRobot, line: str, lidar_line: str = "") -> None:
        """Take the robot over; raises RoombaError with what to do, after giving it back."""
        config = kind.config()
        bumping = load_config(BumpingConfig, CONFIGURATION / "bumping.yaml")
        docking = load_config(DockingConfig, CONFIGURATION / "docking.yaml")
        self._body: LineBody = kind.body_on(line, config, lidar_line, has_lidar=False)
        try:
            self._body.start(has_lidar=False)
            # Seeded by chance: no two runs are to be alike.
            rng = np.random.default_rng()
            brain = BumpingBrain(config, bumping, docking, config.body.max_speed, rng)
            self.client = BumpingClient(kind.name, BumpingRobot(self._body, brain))
        except BaseException:
            self._body.stop()
            raise

    def end(self) -> None:
        """Let it stand, and give it back."""
        try:
            self.client.end()
        finally:
            self._body.stop()


def bumping_life(wanted: argparse.Namespace) -> BumpingLife:
    """Return the robot that was asked for with ``--lidar none``; raises RoombaError."""
    return BumpingLife(kind_of(wanted), wanted.line, wanted.lidar_line)
