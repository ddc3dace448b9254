"""Numbers of docking, how near, how fast, how long: ``configuration/docking.yaml``."""

from __future__ import annotations

from roomba.configuration.body import Speed
from roomba.configuration.frozen import (
    Acute,
    Angle,
    AtLeastOne,
    Frozen,
    Length,
    Positive,
    Ratio,
    TurningSpeed,
    Wait,
)


class DockingConfig(Frozen):
    """Driving into the charging station and out of it: m, m/s, rad/s, s.

    Distances to the station count from the robot's middle to where it is when it is docked.
    """

    staging_distance: Length = 0.65
    """In front of the station, where path planning hands over: within its beams."""
    plate_gap: Length = 0.03
    """Between the docked robot's front and the station."""
    farthest: Length = 2.5
    """From the station; farther away path planning has to bring the robot first."""
    search_reach: Length = 0.3
    """To either side of the way to the station, where it looks for beams."""

    speed: Speed = 0.2
    """While it is not near."""
    creep_speed: Speed = 0.05
    """Over the last of the way: late senses still stop it within the contacts' tolerance."""
    feeling_speed: Speed = 0.02
    """Past the docked place, where the contacts should have touched: current may be told late."""
    creep_distance: Length = 0.08
    """Last part of the way; the believed place and the halo's edge may be off by so much."""
    braking: Positive = 0.8
    """1/s; how much faster it is for each metre that is left before it creeps."""
    turning_speed: TurningSpeed = 1.0
    steering_gain: Positive = 2.0
    """1/s; the turning speed for each radian that the heading is wrong."""

    contact_margin: Length = 0.08
    """What is felt nearer to the docked place than this is the station."""
    overrun: Length = 0.10
    """Past the docked place; when nothing is felt so far, no station is there."""
    contact_wait: Wait = 2.0
    """For the charging current after contact."""
    settle_time: Wait = 0.4
    """The current must last so long before the robot counts as docked."""
    nudge: Length = 0.05
    """Way that it first creeps when it backs off: current comes if it was pressed in too far."""
    back_distance: Length = 0.4
    back_turn: Ratio = 0.2
    """rad; it turns as it backs off, and so crosses the edge of the beams on the next try."""
    blocked_wait: Wait = 2.0
    """Before the next attempt, so that what stands in the way can leave."""

    max_attempts: AtLeastOne = 4
    beam_wait: Wait = 0.5
    """How long it goes on without a beam."""
    lost_timeout: Wait = 10.0
    """How long it waits while its place is not known and no beam is seen."""
    stuck_timeout: Wait = 3.0
    """How long it may drive without moving."""
    left_standing: Length = 0.2
    """A robot that failed for want of beams waits for them until it is moved farther."""
    emptying_timeout: Wait = 5.0
    """For a station to begin to empty the bin."""
    time_limit: Wait = 150.0

    undock_distance: Length = 0.35
    undock_speed: Speed = 0.15
    undocked_distance: Length = 0.25
    """From the station; a robot that is farther away is undocked already."""
    undocked_turn: Acute = 0.5
    """rad; a robot turned away from the station by more is undocked, too: nothing holds it."""
    undock_time_limit: Wait = 10.0

    place_tolerance: Length = 0.08
    """Arriving at the staging place, or at one from which it looks for beams."""
    turn_in_place_angle: Acute = 0.5
    """rad; when its heading is wrong by more, it turns on the spot."""
    shortest_reach: Length = 0.15
    """Look-ahead for aiming at the middle of the beams; it is longer while the robot is far."""
    most_aside: Acute = 0.5
    """rad; the largest angle to the straight way at which it aims; smaller when it is near."""
    least_aside: Angle = 0.09
    """rad; the same angle at the end: within what the contacts tolerate."""
    narrow: Ratio = 0.3
    """Share of the way left that it may be aside; beyond it drives to the staging place first."""
    shortest_way: Length = 0.2
    """With less way left it cannot get straight any more."""
    side_step: Length = 0.15
    """How far it backs off from what it meets while it looks for beams."""
    standstill_way: Length = 0.02
    """A robot that moved less stands still."""
    standstill_turn: Angle = 0.1
    """rad; the same of turning."""
    longest_step: Length = 0.3
    """A larger change of the believed place in a tick is a new belief."""
    farthest_off: Length = 0.5
    """If beams say that the belief is wrong by more, they are from another place or time."""
    heading_doubt: Angle = 0.1
    """rad; possible error of the heading: the longer a robot sees one beam alone, the farther aside
    it is."""
    late_beams: Wait = 0.3
    """s; after a new belief, beams may still be those that were seen before it."""
