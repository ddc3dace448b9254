"""Numbers of a robot without a lidar: ``configuration/bumping.yaml``."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.body import Speed
from roomba.configuration.frozen import (
    Acute,
    Angle,
    AtLeastOne,
    Cell,
    Duration,
    Frozen,
    Length,
    Positive,
    Ratio,
    TurningSpeed,
)


class BumpingConfig(Frozen):
    """Sweeping by bumps, and going home by beams: m, m/s, rad, rad/s, s."""

    speed: Speed = 0.25
    turning_speed: TurningSpeed = 1.5
    backing_way: Length = 0.05
    backing_time: Duration = 1.5
    aimed: Angle = 0.1
    spiral_start: Length = 0.12
    spiral_pitch: Length = 0.16
    spiral_end: Length = 0.9
    spiral_pause: Duration = 180.0
    spiral_room: Ratio = 0.6
    look_ahead: Length = 2.0
    headings: AtLeastOne = 8
    least_turn: Acute = 0.7
    wall_every: AtLeastOne = 5
    wall_touches: AtLeastOne = 8
    wall_time: Duration = 40.0
    wall_speed: Speed = 0.2
    wall_signal: Ratio = 0.4
    wall_turning: TurningSpeed = 0.8
    wall_gain: Positive = 0.4
    wall_damping: Positive = 0.6
    wall_smoothing: Duration = 0.15
    wall_passed: Ratio = 0.1
    wall_gap: Length = 0.6
    wall_radius: Length = 0.24
    corner_turn: Acute = 1.2
    most_touches: AtLeastOne = 80
    free_way: Length = 0.3
    cell: Cell = 0.05
    floor_size: Annotated[float, Field(ge=1.0, le=100.0)] = 40.0
    home_level: Ratio = 0.2
    home_time: Duration = 240.0
    home_wall_time: Duration = 90.0
    near_home: Length = 0.3
    before_home: Length = 0.6
    detour: Length = 0.8
    search_growth: Positive = 0.4
    beam_speed: Speed = 0.12
    beam_way: Length = 1.2
    beams_gone: Duration = 1.0
    blind_time: Duration = 3.0
    middles_apart: Length = 0.15
    beam_back: Length = 0.3
    beam_attempts: AtLeastOne = 6
    beam_learning: Positive = 0.4
    beam_doubt: Acute = 0.8
    beam_aside: Acute = 0.3
    leaving_turn: Angle = 2.2
    compass_way: Length = 1.0
    compass_aside: Length = 0.05
    compass_most: Acute = 0.5
    compass_due: Duration = 12.0
    compass_turns: Positive = 15.0
    compass_learning: Ratio = 0.5
    compass_far: Length = 10.0
    driven_cell: Cell = 0.1
    driven_ahead: Length = 0.6
    driven_again: Duration = 20.0

    in_order: ClassVar[tuple[str, ...]] = ("spiral_start <= spiral_end",)
