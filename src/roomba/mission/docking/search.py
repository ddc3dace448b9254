"""The search for the station's beams, place by place."""

from __future__ import annotations

import math

from roomba.configuration.docking import DockingConfig
from roomba.geometry import TWO_PI, Twist
from roomba.mission.docking.track import StationTrack


class BeamSearch:
    """Looks from where it should see beams, all around, from nearer by, and from both sides."""

    def __init__(self, config: DockingConfig) -> None:
        """Plan the places, in the frame of the docked robot."""
        far, reach = config.staging_distance, config.search_reach
        self._config = config
        self._turned = 0.0
        self._places: list[tuple[float, float] | None] = [
            (-far, 0.0),
            None,  # all around
            (-0.5 * far, 0.0),
            (-0.75 * far, reach),
            (-0.75 * far, -reach),
            (-far, 0.0),
        ]

    def skip(self) -> None:
        """Go on to the next place: this one cannot be reached."""
        del self._places[:1]

    def tick(self, track: StationTrack, dt: float) -> Twist | None:
        """Return the wanted twist, or None after the last place. ``dt``: s since the last tick."""
        while self._places:
            place = self._places[0]
            if place is not None and track.pose.distance_to(*place) > self._config.place_tolerance:
                return drive_to(track, self._config, *place)
            if place is None and self._turned < TWO_PI:
                self._turned += self._config.turning_speed * dt
                return Twist(0.0, self._config.turning_speed)
            self.skip()
        return None


def is_at_staging(track: StationTrack, config: DockingConfig) -> bool:
    """Tell whether the robot is where it begins to drive at the station."""
    return track.pose.distance_to(-config.staging_distance, 0.0) <= config.place_tolerance


def drive_to(track: StationTrack, config: DockingConfig, x: float, y: float) -> Twist:
    """Return the twist that leads to a point of the docked robot's frame, m."""
    wrong = track.pose.bearing_to(x, y)
    speed = min(config.speed, track.pose.distance_to(x, y) + config.creep_speed)
    return steered(config, speed, wrong)


def steered(config: DockingConfig, speed: float, wrong: float) -> Twist:
    """Return a twist whose heading is put right by ``wrong``, rad; on the spot if that is much."""
    most = config.turning_speed
    angular = min(max(config.steering_gain * wrong, -most), most)
    share = max(0.0, 1.0 - math.fabs(wrong) / config.turn_in_place_angle)
    return Twist(speed * share, angular)
