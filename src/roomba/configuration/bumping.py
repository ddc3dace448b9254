"""Numbers of a robot without a lidar: ``configuration/bumping.yaml``."""

from __future__ import annotations

from typing import ClassVar

from roomba.configuration.frozen import Acute, AtLeastOne, Frozen, Positive, Ratio


class BumpingConfig(Frozen):
    """Sweeping by bumps, and going home by beams: m, m/s, rad, rad/s, s."""

    speed: Positive = 0.25
    turning_speed: Positive = 1.5
    backing_way: Positive = 0.05
    backing_time: Positive = 1.5
    aimed: Positive = 0.1
    spiral_start: Positive = 0.12
    spiral_pitch: Positive = 0.16
    spiral_end: Positive = 0.9
    spiral_pause: Positive = 180.0
    spiral_room: Ratio = 0.6
    look_ahead: Positive = 2.0
    headings: AtLeastOne = 8
    least_turn: Acute = 0.7
    wall_every: AtLeastOne = 5
    wall_touches: AtLeastOne = 8
    wall_time: Positive = 40.0
    wall_speed: Positive = 0.2
    wall_signal: Ratio = 0.4
    wall_turning: Positive = 0.8
    wall_gain: Positive = 0.4
    wall_damping: Positive = 0.6
    wall_smoothing: Positive = 0.15
    wall_passed: Ratio = 0.1
    wall_gap: Positive = 0.6
    wall_radius: Positive = 0.24
    corner_turn: Acute = 1.2
    most_touches: AtLeastOne = 80
    free_way: Positive = 0.3
    cell: Positive = 0.05
    floor_size: Positive = 40.0
    home_level: Ratio = 0.2
    home_time: Positive = 240.0
    home_wall_time: Positive = 90.0
    near_home: Positive = 0.3
    before_home: Positive = 0.6
    detour: Positive = 0.8
    search_growth: Positive = 0.4
    beam_speed: Positive = 0.12
    beam_way: Positive = 1.2
    beams_gone: Positive = 1.0
    blind_time: Positive = 3.0
    middles_apart: Positive = 0.15
    beam_back: Positive = 0.3
    beam_attempts: AtLeastOne = 6
    beam_learning: Positive = 0.4
    beam_doubt: Acute = 0.8
    beam_aside: Acute = 0.3
    leaving_turn: Positive = 2.2
    compass_way: Positive = 1.0
    compass_aside: Positive = 0.05
    compass_most: Acute = 0.5
    compass_due: Positive = 12.0
    compass_turns: Positive = 15.0
    compass_learning: Ratio = 0.5
    compass_far: Positive = 10.0
    driven_cell: Positive = 0.1
    driven_ahead: Positive = 0.6
    driven_again: Positive = 20.0

    in_order: ClassVar[tuple[str, ...]] = ("spiral_start <= spiral_end",)
