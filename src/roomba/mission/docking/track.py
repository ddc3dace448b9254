"""Tracking of the robot before its charging station, by its believed pose and the beams it sees.

In the frame of the docked robot: x ahead into the station, y to its left. So the robot comes from
negative x, and a heading of 0 looks straight at the station. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math

from roomba.configuration.body import BodyConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.sensors import StationConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.mission.docking.beams import StationBeams


class StationTrack:
    """Follows the robot in the station's frame: predicted by its belief, corrected by beams.

    The believed pose may be wrong by some cm and degrees. Each beam that is seen or not limits
    where the robot can be, and it is taken to be at the nearest such place.
    """

    def __init__(
        self, body: BodyConfig, beams: StationConfig, config: DockingConfig, docked: Pose
    ) -> None:
        """``docked`` is where the docked robot stands, map frame."""
        self._docked, self._config = docked, config
        self._front = body.radius + config.plate_gap
        self._halo = beams.halo
        self._slope = math.tan(math.radians(0.5 * beams.overlap))
        self._wide = math.tan(math.radians(beams.beam_angle))
        self._believed: Pose | None = None
        self._last = StationBeams()
        self._waits = 0.0
        self._way_aside = 0.0
        self.pose = Pose()
        self.is_known = False
        """Whether the pose means anything: it was known once."""

    @property
    def left(self) -> float:
        """How far it has to go ahead, m; negative past the docked place."""
        return -self.pose.x

    @property
    def away(self) -> float:
        """Distance to the docked place, m."""
        return math.hypot(self.pose.x, self.pose.y)

    def move(self, pose: Pose | None, wanted: Twist, dt: float) -> None:
        """Follow the believed pose, map frame; without one, what was ``wanted`` for ``dt`` s."""
        if pose is None:
            self._believed = None
            turn = wanted.angular * dt
            way, middle = wanted.linear * dt, 0.5 * turn
            self._go(Pose(way * math.cos(middle), way * math.sin(middle), turn))
            return
        believed = self._docked.inverse().compose(pose)
        before, self._believed = self._believed, believed
        self._waits = max(0.0, self._waits - dt)
        config = self._config
        if before is not None and before.distance_to(believed.x, believed.y) <= config.longest_step:
            self._go(before.inverse().compose(believed))
            if self.pose.distance_to(believed.x, believed.y) > config.farthest_off:
                self.forget_beams()
        else:
            self.forget_beams()
            self._waits = config.late_beams if self.is_known else 0.0
        self.is_known = True

    def _go(self, step: Pose) -> None:
        self.pose = self.pose.compose(step)
        self._way_aside = max(0.0, self._way_aside + step.x)

    def forget_beams(self) -> None:
        """Go by the believed pose alone, if there is one; beams put it right from now on."""
        self._last = StationBeams()
        self._way_aside = 0.0
        self.pose = self._believed or self.pose

    def see(self, beams: StationBeams) -> None:
        """Go to the nearest place at which these beams are seen."""
        before, self._last = self._last, beams
        ahead = self._front - self.pose.x
        if (beams.green, beams.red) != (before.green, before.red):
            self._way_aside = 0.0
        if self._waits > 0.0 or ahead <= 0.0:
            return
        if beams.leads:
            ahead = self._range(ahead, beams.halo)
        self.pose = Pose(self._front - ahead, self._aside(ahead, before, beams), self.pose.theta)

    def _range(self, ahead: float, halo: bool) -> float:
        """Return the way to the front of the station, m: the halo tells whether it is short."""
        edge = math.sqrt(max(self._halo**2 - self.pose.y**2, 0.0))
        return min(ahead, edge) if halo else max(ahead, edge)

    def _aside(self, ahead: float, before: StationBeams, beams: StationBeams) -> float:
        """Return y, ``ahead`` m before the station's front, by the beams seen now or just lost."""
        y, inner, outer = self.pose.y, self._slope * ahead, self._wide * ahead
        if beams.green and beams.red:
            return min(max(y, -inner), inner)
        if beams.leads:
            side = 1.0 if beams.green else -1.0
            inner = min(inner + self._config.heading_doubt * self._way_aside, outer)
            return side * min(max(side * y, inner), outer)
        if before.red != before.green:
            # It left the beam on the outer side: towards the middle it would see both.
            return outer if before.green else -outer
        return y

    def steering(self, reach: float, most: float) -> float:
        """Return how much the heading is wrong for coming to the middle within ``reach`` m, rad.

        ``most`` is the most that it may look aside, rad.
        """
        aim = math.atan2(-self.pose.y, reach)
        return wrap_angle(min(max(aim, -most), most) - self.pose.theta)
