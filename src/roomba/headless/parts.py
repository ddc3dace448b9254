"""What headless robots have in common: from what is simulated to senses, from wishes to wheels."""

from __future__ import annotations

from typing import Final

from roomba.configuration.robot import RobotConfig
from roomba.control.speed_loop import SpeedLoop
from roomba.errors import RoombaError
from roomba.geometry import Twist
from roomba.mission.inputs.senses import Battery, Senses, StationBeams
from roomba.perception.localization.estimate import Estimate
from roomba.world.engine.state.arrays import Infrared
from roomba.world.home.home import Home
from roomba.world.simulator import Observation

_LONGEST_CLEAN: Final = 12 * 3600.0
_LONGEST_PER_AREA: Final = 150.0
"""s, and s for each m2 of floor: more than twice what an office of 1,476 m2 takes, 26 hours with
ten charges."""


def require_end(spent: float, home: Home) -> None:
    """Raise RoombaError if nothing but a fault lets a clean last so long, ``spent`` s."""
    longest = _LONGEST_CLEAN + _LONGEST_PER_AREA * home.map.free_area
    if spent > longest:
        raise RoombaError(
            f"expected a clean to end within {longest / 3600.0:.0f} h of the robot's time, it is "
            "still under way; that is a fault of the program"
        )


def senses_of(seen: Observation, estimate: Estimate) -> Senses:
    """Return what a mission senses, of what is seen and what is known of the place."""
    infrared = seen.infrared
    return Senses(
        seen.time,
        estimate.pose,
        Twist(seen.odometry_twist.linear, seen.angular_velocity),
        estimate.knowledge,
        estimate.reason,
        seen.bumper.left,
        seen.bumper.right,
        seen.cliff.left or seen.cliff.front_left,
        seen.cliff.right or seen.cliff.front_right,
        seen.wheels.dropped,
        StationBeams(
            Infrared.HALO in infrared, Infrared.GREEN in infrared, Infrared.RED in infrared
        ),
        Battery(seen.battery.level, seen.battery.capacity, seen.battery.is_docked),
        seen.grains,
        seen.in_bin,
    )


class SafeDrive:
    """The speed loop, told of hazards before each command."""

    def __init__(self, robot: RobotConfig, max_speed: float) -> None:
        """Begin standing; ``max_speed`` in m/s."""
        body = robot.body
        self._loop = SpeedLoop(body.command_timeout, max_speed, body.max_angular_speed)

    def command(self, seen: Observation, twist: Twist) -> Twist:
        """Return the twist that the wheels get when ``twist`` is wanted."""
        loop = self._loop
        loop.set_bumper(seen.bumper.pressed)
        loop.set_cliff(seen.cliff.any)
        loop.set_wheel_drop(seen.wheels.dropped)
        loop.command(seen.time, twist)
        return loop.tick(seen.time)[0]
