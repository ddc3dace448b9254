"""Validated, frozen configuration of the mission: ``configuration/mission.yaml``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from roomba.configuration.body import BodyConfig, Speed
from roomba.configuration.coverage import CoverageConfig
from roomba.configuration.frozen import (
    Angle,
    AtLeastOne,
    Clearance,
    Count,
    Duration,
    Frozen,
    Length,
    NotNegative,
    Patience,
    Positive,
    Ratio,
    ShortWay,
    TurningSpeed,
    Wait,
    WaitOrNone,
    load_config,
)
from roomba.errors import ConfigError

Share = Annotated[float, Field(ge=-1.0, le=1.0, allow_inf_nan=False)]
Move = tuple[Share, Share, Positive]
"""Speed and turning speed as shares of those of a recovery, and for how many s."""
Moves = Annotated[tuple[Move, ...], Field(min_length=1)]


class RecoveryConfig(Frozen):
    """Getting free: motions that are tried one after the other while there is no progress."""

    turning_speed: TurningSpeed = 1.5
    """rad/s."""
    moves: Annotated[tuple[Moves, ...], Field(min_length=1)] = (
        ((-1.0, 0.0, 1.0), (0.0, 1.0, 0.8)),
        ((-1.0, 0.0, 1.0), (0.0, -1.0, 1.6)),
        ((1.0, 0.0, 0.6), (-1.0, 0.6, 1.2), (-1.0, -0.6, 1.2)),
        ((0.0, 1.0, 2.1), (1.0, 0.0, 1.0)),
        ((0.0, -1.0, 4.2), (1.0, 0.0, 1.0)),
    )
    """For each attempt its moves: shares of ``driving.backing_speed`` and of ``turning_speed``, -1
    to 1, and s."""
    freed_way: Length = 0.03
    """m; a robot that moved farther in an attempt is free."""
    freed_turn: Angle = 0.3
    """rad; the same of turning."""


class GivingWayConfig(Frozen):
    """Making room for a person who waits for the robot to go: m."""

    beside: Length = 1.2
    """A person or thing nearer to the robot than this may want to pass."""
    room: Length = 1.2
    """The distance to that person or thing at which the robot goes no farther aside."""
    least_room: Length = 0.5
    """The least distance that lets others pass; with less the robot stays."""
    per_way: NotNegative = 0.25
    """m of room that a metre of way is worth: it does not squeeze past what it makes room for."""
    farthest: Length = 3.0
    """The longest way aside."""


class WaitingConfig(Frozen):
    """Waiting where no way leads on, until one opens: s."""

    most_ways_home: Count = 5
    """Attempts to find a way home before it begins to wait."""
    first_waits: Count = 2
    """The first so many waits are short: people pass sooner than doors are opened."""
    first_wait: Wait = 10.0
    """The length of each of them."""
    wait: Wait = 30.0
    """The length of the others."""
    look_period: Duration = 2.0
    """From one look whether the way is clear to the next."""
    most_waits: AtLeastOne = 41
    """After so many it gives up: twenty minutes in all."""


class LowThingsConfig(Frozen):
    """Things that are felt again and again and that neither map nor lidar shows."""

    same: Length = 0.25
    """m; what is felt nearer to a low thing than this is that thing."""
    longest: Length = 1.5
    """m; a cable may be longer: it is several things then."""
    seen_near: Length = 0.15
    """m; what the lidar sees as near to where something was felt was seen, and is not low."""
    offered: AtLeastOne = 3
    """Times that a thing is felt before it is offered as a no-go zone."""
    margin: Positive = 0.08
    """m; such a zone is so much wider on each side: the bumper tells to 5 cm where a thing is."""


class DrivingConfig(Frozen):
    """Driving a path, and around what the map does not show: m, m/s, s."""

    speed: Speed = 0.30
    clearance: Clearance = 0.005
    way_clearance: Clearance = 0.04
    look_ahead: ShortWay = 0.15
    thing_clearance: Clearance = 0.004
    off_path: Length = 0.12
    backing_way: Length = 0.08
    backing_speed: Speed = 0.10
    progress_timeout: Patience = 5.0
    most_recoveries: AtLeastOne = 6
    felt_memory: Duration = 180.0
    mean_speed: Annotated[float, Field(gt=0.0, le=1.0)] = 0.65
    """Mean speed of a clean as a share of ``speed``, by which the time to go is told."""
    least_progress: Length = 0.02
    """m along the path; less is no progress."""
    least_turn: Angle = 0.2
    """rad of a turn on the spot; less is no progress either."""
    leaves_trouble: Length = 0.5
    """m of progress after which earlier recoveries count no more."""
    most_futile: AtLeastOne = 3
    """New paths from one place; after these it tries recoveries."""
    touch_radius: Length = 0.10
    """m; touches from places nearer to each other are of the same thing."""
    most_touches: AtLeastOne = 4
    """Consecutive touches of the same thing, after which a path is given up."""
    lasting_radius: Length = 0.06
    """m; what is felt again from a place nearer than this is a lasting obstacle, as is what is felt
    where nothing is seen."""
    lasting_memory: Duration = 1800.0
    """s; how long a lasting obstacle is remembered."""
    gap_spare: NotNegative = 0.06
    """m; more room than the body needs that a gap between two things must have."""
    most_nudge: Length = 0.08
    """m; a path along a thing is moved aside by this at most; more is left to the planner."""
    out_of_pocket: Length = 1.0
    """m of the way home, after which the robot is out of where it was shut in."""
    low_things: LowThingsConfig = LowThingsConfig()
    recovery: RecoveryConfig = RecoveryConfig()
    giving_way: GivingWayConfig = GivingWayConfig()
    waiting: WaitingConfig = WaitingConfig()

    @property
    def tight_clearance(self) -> float:
        """The least distance from walls on a way, m: as near as swaths, to join them."""
        return 0.5 * self.clearance

    @model_validator(mode="after")
    def _ways_keep_no_less_than_swaths(self) -> DrivingConfig:
        if self.way_clearance < self.tight_clearance:
            raise ValueError(
                f"expected a way_clearance of at least half of clearance "
                f"({self.tight_clearance:g} m), got {self.way_clearance:g} m; raise it, or lower "
                "clearance"
            )
        return self


class CleaningConfig(Frozen):
    """Covering the floor: shares 0..1, m2."""

    enough: Ratio = 0.9955
    least_patch: Positive = 0.004
    least_while_growing: Positive = 0.5
    most_rounds: Count = 4
    dirty_times: Positive = 6.0
    least_dirt: Positive = 500.0
    """Grains/m2; floor with fewer of them is not dirty."""
    dirty_near: Length = 1.5
    """m; dirty floor as near as this is cleaned once more in passing."""
    dirty_ahead: Length = 25.0
    """m of the path ahead on which the place that is nearest to such floor is looked for."""
    dirty_period: Duration = 5.0
    """s; from one look for dirty floor close by to the next."""
    least_dirty: Positive = 0.08
    """m2; smaller dirty patches are not cleaned once more."""
    usual_floor: Positive = 4.0
    """m2; with less of it swept it is not known how dirty floor usually is."""
    usual_period: Duration = 30.0
    """s; from one measurement of that, for looks close by, to the next."""
    little_gain: Ratio = 0.05
    """Share of what was missed; a round that gains less of it ends the retries."""
    least_area_to_retry: Positive = 0.5
    """m2; smaller floor out of reach is not tried again."""
    least_for_round: Positive = 0.02
    """m2; a patch as large as this is worth another round, even if ``enough`` is clean."""
    worth_way: Positive = 100.0
    """m of way for each m2; once ``enough`` is clean, a round that takes more is not driven, and a
    new plan leaves slivers that take more: polishing a plan leaves floor by the same measure."""
    worth_way_to_enough: Positive = 500.0
    """The same of a round while less than ``enough`` is clean."""
    worth_way_again: Positive = 20.0
    """The same of dirty floor that is cleaned once more, in passing or at the end."""
    most_ways_out: Count = 40
    """Times, in a clean, that it leaves a place where it is shut in, or waits."""
    most_cut_offs: Count = 12
    """Paths that were given up and do not count as rounds, in a clean."""
    replan_period: Duration = 20.0
    """s; the least time between two new plans because of things on the path."""
    most_replans: Count = 40
    """Such plans in a clean."""
    least_way_to_replan: Length = 8.0
    """m; with less of it left a path is driven to its end."""
    spot_size: Length = 1.5
    """m; side of the square around a spot."""
    detours: Annotated[float, Field(ge=1.0, allow_inf_nan=False)] = 1.2
    """Length of a clean's way as a multiple of floor by width of the tool, for its energy."""


class ExploringConfig(Frozen):
    """Driving where the map is being made: m, m/s."""

    speed: Speed = 0.40
    stand_first: WaitOrNone = 8.0
    """s; on its station, before it leaves it: the gyro shows its bias."""
    seeing_speed: Positive = 0.25
    """rad/s; where the map shows no way, it turns once to see more: scans should be as sharp."""
    clearance: Clearance = 0.12
    careful_clearance: Clearance = 0.025
    """m; kept wherever a way can keep it: the map may have a surface 0.4 of a cell too far back."""
    tight_clearance: Clearance = 0.005
    cleaning_clearance: Clearance = 0.015
    """The same as ``driving.clearance``, for a clean while the map is being made."""
    look_first: Duration = 10.0
    most_stuck: Count = 3
    viewpoint_tolerance: Length = 0.12
    """m; as near to a viewpoint it has seen all that is to be seen from there."""
    frontier_radius: Length = 0.25
    """m; around the middle of a frontier: whether something of it is left is looked up there."""
    least_unknown: Positive = 0.03
    """m2; smaller patches of the unknown are not driven to."""
    look_from: Length = 1.2
    """m; the farthest viewpoint from its frontier."""
    look_nearer: Length = 0.15
    """m; a long frontier that was left is looked at again from a place that is so much nearer."""
    nearer_worth: NotNegative = 2.0
    """m of way that one metre nearer to the frontier is worth."""
    small_frontier: NotNegative = 0.4
    """m; a shorter frontier comes later: it costs ``small_cost``, m of way, more."""
    small_cost: NotNegative = 1.0
    open_edge: Length = 0.7
    """m; a frontier that stays unseen is told if it is at least as long: hardly a doorway."""
    tight_cost: NotNegative = 0.5
    """m of way that a viewpoint nearer to walls than ``clearance`` costs more."""
    least_cells: AtLeastOne = 3
    """Cells of the map; a frontier of fewer is none: a gap between two beams."""
    frontier_stride: Length = 0.3
    """m; about so far apart are the places of a frontier from which viewpoints are looked for."""
    same_frontier: Length = 0.3
    """m; frontiers nearer to one that was given up are the same."""
    most_returns: Annotated[int, Field(ge=0, le=100)] = 3
    """Times that a frontier may come back where one vanished, as glass and mirrors make it do."""
    patience: Duration = 120.0
    """s; a frontier is given up if it is not reached within this plus twice the time of the way."""
    map_wait: Duration = 120.0
    """s; how long a clean waits for the whole map when all is seen."""

    in_order: ClassVar[tuple[str, ...]] = ("tight_clearance <= careful_clearance <= clearance",)


class EnergyConfig(Frozen):
    """When to go home for energy: shares of the capacity 0..1, Wh/m."""

    reserve: Ratio = 0.08
    margin: Positive = 1.3
    per_metre: Positive = 0.02
    full_enough: Ratio = 0.90
    least_to_start: Ratio = 0.15
    measured_after: Length = 10.0
    """m of way, after which the robot goes by its own consumption, not by ``per_metre``."""
    empty: Ratio = 0.005
    """With less than this share of the capacity the drive stops by itself."""
    check_period: Duration = 5.0
    """s; from one look at how far it is home to the next."""
    ample: Ratio = 0.35
    """With so much of the capacity besides the reserve no way home is too far in most homes."""
    least_gain: Positive = 0.05
    """m2; a charge after which a job gains less floor counts as in vain."""
    most_in_vain: AtLeastOne = 2
    """Charges in vain in a row, after which the rest counts as too far from the station."""

    in_order: ClassVar[tuple[str, ...]] = ("reserve < full_enough",)


class BinConfig(Frozen):
    """When the dust bin is full: shares of its capacity 0..1, m2."""

    full: Annotated[float, Field(ge=0.1, le=1.0)] = 0.98
    nearly_full: Ratio = 0.80
    silent: Duration = 2.0
    least_grains: Positive = 1.0
    """Grains/s; with fewer, none counts as coming in."""
    fading_way: Length = 0.6
    """m; driven while the dirt sensor's rate fades away after the last grain."""
    dusty: Positive = 500.0
    """Grains/m2; where fewer are usual, floor without a grain tells nothing."""
    emptied: Ratio = 0.5
    """Share of the level at which the bin was full; below that it was emptied."""


class MissionConfig(Frozen):
    """All of ``configuration/mission.yaml``; the defaults are the shipped file's values."""

    driving: DrivingConfig = DrivingConfig()
    cleaning: CleaningConfig = CleaningConfig()
    coverage: CoverageConfig = CoverageConfig()
    exploring: ExploringConfig = ExploringConfig()
    energy: EnergyConfig = EnergyConfig()
    bin: BinConfig = BinConfig()

    @property
    def top_speed(self) -> float:
        """The fastest that it wants to drive, m/s."""
        return max(self.driving.speed, self.exploring.speed)

    def slowed_for(self, body: BodyConfig) -> MissionConfig:
        """Return the same with speeds that a body can do."""
        most = body.max_speed
        driving, exploring = (
            part.model_copy(update={"speed": min(part.speed, most)})
            for part in (self.driving, self.exploring)
        )
        return self.model_copy(update={"driving": driving, "exploring": exploring})

    def require_possible(self, body: BodyConfig) -> None:
        """Raise ConfigError when a speed is more than a body can do."""
        for name, speed in (
            ("driving.speed", self.driving.speed),
            ("exploring.speed", self.exploring.speed),
        ):
            if speed > body.max_speed:
                raise ConfigError(
                    f"{name}: expected at most {body.max_speed:g} m/s, the robot's body.max_speed, "
                    f"got {speed:g}; lower it, or raise body.max_speed if the drive can do more"
                )


def load_mission_config(path: Path, body: BodyConfig) -> MissionConfig:
    """Read ``configuration/mission.yaml`` or a file like it; raises ConfigError with the reason.

    A speed that the ``body`` cannot do is such a reason.
    """
    config = load_config(MissionConfig, path)
    try:
        config.require_possible(body)
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from error
    return config
