"""Numbers of the loops that drive the robot: to a point, along a path, by what is in sight."""

from __future__ import annotations

from typing import ClassVar

from roomba.configuration.body import Speed
from roomba.configuration.frozen import (
    Acceleration,
    Acute,
    Angle,
    Clearance,
    Count,
    Duration,
    Frozen,
    Length,
    NotNegative,
    Patience,
    Positive,
    ShortWay,
    TurningSpeed,
    Wait,
)


class ControlConfig(Frozen):
    """The position loop."""

    approach_deceleration: Acceleration = 0.5
    heading_gain: Positive = 4.0
    turn_in_place_angle: Acute = 0.9
    arrival_tolerance: Length = 0.02
    restart_distance: Length = 0.03
    turning_speed: TurningSpeed = 2.5
    stream_timeout: Duration = 0.15
    given_up_after: Duration = 10.0


class WalkConfig(Frozen):
    """Walking to a point: the path, the setpoint moving along it, and when to give up."""

    lookahead: Length = 0.25
    clearance: Clearance = 0.04
    tight_clearance: Clearance = 0.01
    look_ahead: Length = 0.5
    corner_speed: Speed = 0.25
    careful_speed: Speed = 0.15
    astray_timeout: Duration = 60.0
    search_wait: Duration = 2.0
    """s; how long a robot that stood lost and is told to drive waits for a search to begin anew."""
    arrival_tolerance: Length = 0.03
    bump_radius: Length = 0.06
    progress_timeout: Patience = 6.0
    max_replans: Count = 12
    max_ways_around: Count = 60
    blocked_wait: Wait = 10.0
    look_period: Duration = 1.0
    """s; from one look for a way around, while it waits, to the next."""
    off_path: Length = 0.35
    """m; farther off its path the robot was carried or pushed, and plans anew."""
    carried: Length = 1.0
    """m; a robot that finds itself farther from its last known place was carried: what it
    remembers of things is of another place. Cleans use it, too."""
    hanging_wheel: Duration = 1.5
    """s; one wheel may hang in the air for so long, as at a sill, until an errand fails; when both
    do it fails at once."""
    tipping: Duration = 1.0
    """s; if the floor ended so shortly before both wheels hang, that was no edge: the robot was
    picked up nose first. Cleans use it, too."""
    least_progress: Length = 0.05
    """m; coming nearer to the goal by less is no progress."""
    least_turn: Angle = 0.2
    """rad of a turn towards the way; less is no progress either."""
    standstill: Speed = 0.03
    """m/s; slower than this the robot stands."""
    sharp_corner: Acute = 0.3
    """rad; at a sharper corner the setpoint waits for the robot; softer ones are cut."""
    corner_cut: Length = 0.005
    """m; the straight way to the setpoint leaves the path by this at most."""
    corner_reached: Length = 0.04
    """m; the setpoint goes on when the robot is as near to a sharp corner."""
    braking: Acceleration = 0.4
    """m/s2; before corners."""
    slowest: Speed = 0.08
    """m/s; never slower than this before the goal."""

    in_order: ClassVar[tuple[str, ...]] = ("tight_clearance <= clearance",)


class LookingAroundConfig(Frozen):
    """Driving by what is in sight while the place is not known: m, m/s, rad, rad/s, s."""

    speed: Speed = 0.25
    turning_speed: TurningSpeed = 1.5
    backing_speed: Speed = 0.1
    """Away from what it touched."""
    backing_time: Duration = 0.8
    clearance: Clearance = 0.06
    """Between the body and all that is in sight."""
    tight_clearance: Clearance = 0.02
    """The same where there is no other way to go."""
    longest_leg: Length = 1.5
    shortest_leg: Length = 0.15
    """Shorter legs are driven only where there is no longer one."""
    arrival_tolerance: Length = 0.02
    """A leg ends as near as this to its goal, or to what is in the way."""
    aimed: Angle = 0.08
    """Tolerance of the heading before it drives."""

    in_order: ClassVar[tuple[str, ...]] = (
        "tight_clearance <= clearance",
        "shortest_leg <= longest_leg",
    )


class TrackingConfig(Frozen):
    """Following a path exactly, as cleaning does: m, s, rad."""

    sharp_corner: Acute = 0.5
    """Sharper corners of a path are turned on the spot."""
    off_corner: Length = 0.002
    """m; the curve that rounds off a path leaves the path by this at most."""
    braking: Acceleration = 1.8
    reach: Length = 0.06
    """Length of path over which a slow robot corrects an offset to the side."""
    reach_time: NotNegative = 0.07
    """s; a faster one takes in addition what it drives in this time."""
    heading_gain: Positive = 6.0
    turning_speed: TurningSpeed = 4.0
    spot_braking: Acceleration = 13.6
    """rad/s2; with which a turn on the spot ends."""
    corner_turning: TurningSpeed = 2.0
    """rad/s; the most in bends."""
    corner_acceleration: Acceleration = 7.0
    """rad/s2; by which the turning speed grows, in bends."""
    corner_braking: Acceleration = 10.0
    """rad/s2; by which it falls, in bends."""
    slowest_corner: Speed = 0.08
    """m/s; in the tightest bends."""
    longest_blend: ShortWay = 0.05
    """m; each point of the curve is a mean over at most this way to each side."""
    aimed: Angle = 0.02
    """rad; what is left of a turn on the spot when the robot begins to drive."""
    arrival_tolerance: Length = 0.003
    turn_in_place_angle: Acute = 0.6
    """rad; with a larger error of the heading it turns on the spot first."""
    turning_delay: NotNegative = 0.05
    """s; until the drive has the turning speed that it is told."""
    late_ticks: NotNegative = 2.0
    """Ticks; by so much the drive is expected to brake late."""
    slowest: Speed = 0.015
    """m/s and rad/s; slower than this drives do not turn reliably."""

    in_order: ClassVar[tuple[str, ...]] = ("slowest <= slowest_corner",)
