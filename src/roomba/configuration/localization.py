"""Numbers of knowing where the robot is: the part ``localization`` of ``robot.yaml``."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.frozen import (
    Angle,
    AtLeastOne,
    Duration,
    Frozen,
    Length,
    NotNegative,
    Positive,
    Ratio,
    WaitOrNone,
)

HalfTurn = Annotated[float, Field(gt=0.0, le=3.1416)]
"""rad; to each side."""


class ReckoningConfig(Frozen):
    """Going by wheels and gyro between two scans: m, rad, s."""

    settling: WaitOrNone = 0.3
    """After a stop, until the gyro shows its bias alone."""
    jolt: NotNegative = 0.05
    """Tolerance of a step that seems faster than any robot: its time is not exact."""
    longest_step: Duration = 1.0
    """The longest time between two samples over which the gyro is integrated."""
    same_way: Length = 1.0
    same_turn: Angle = 1.0
    """Motion after which the robot sees other parts of the map, with other errors."""


class FitConfig(Frozen):
    """How well a scan must fit the map: shares of beams that ``agree``, or go ``through`` walls."""

    good_agree: Ratio = 0.95
    good_through: Ratio = 0.03
    """With these a pose that was told needs no comparison with all others."""
    fair_agree: Ratio = 0.7
    fair_through: Ratio = 0.12
    """The same of a pose with more evidence than a report. On its station a robot has 0.98 and 0.02
    or better on the map of its home, and at most 0.57 on those of 15 other homes."""
    told_agree: Ratio = 0.5
    """With this the robot goes by a pose that was told until the comparison is done."""
    doubt_worse: Ratio = 0.45
    doubt_through: Ratio = 0.15
    """A pose that fits worse than usual by so much is doubted."""
    doubt_agree: Ratio = 0.35
    """A pose with less than this is doubted, even where less is usual."""
    near_worse: Ratio = 0.2
    near_through: Ratio = 0.06
    """At a place that is found near by, a scan fits worse than usual by so much at most."""
    found_agree: Ratio = 0.7
    found_through: Ratio = 0.15
    """The least ``agree`` and the most ``through`` of a place that is found on the whole map."""
    carried_agree: Ratio = 0.75
    carried_through: Ratio = 0.08
    """The same of a place where the robot is not expected: it was carried there unnoticed."""

    in_order: ClassVar[tuple[str, ...]] = (
        "told_agree <= fair_agree <= good_agree",
        "good_through <= fair_through",
        "found_agree <= carried_agree",
        "carried_through <= found_through",
    )


class ExpectingConfig(Frozen):
    """Where the robot is expected when places are compared: m, rad; evidence is a logarithm."""

    told_radius: Length = 0.5
    told_turn: HalfTurn = 0.5
    """The robot is expected as near as this to a pose that was told."""
    here_radius: Length = 0.04
    here_turn: HalfTurn = 0.04
    """The robot is expected as near as this to a pose that was known."""
    drift: NotNegative = 0.01
    """Both ranges grow by so much for each s of a search, as dead reckoning errs."""
    here_evidence: NotNegative = 14.0
    """Evidence for where the robot is expected, beside what believing a place needs: it stays there
    unless another place is likelier."""
    still_evidence: NotNegative = 60.0
    """The same of a robot that sees what it saw before: it was not carried."""


class SearchingConfig(Frozen):
    """Looking for the robot, near by and on the whole map: m, rad, s; evidence is a logarithm."""

    wait_before_moving: WaitOrNone = 0.5
    """How long it waits for a scan that tells places apart, before it moves to get one."""
    again_after: WaitOrNone = 1.0
    """s after which a search that found nothing is tried anew."""
    compare_after: WaitOrNone = 1.0
    """s after which a place of which no better one was found is compared anew."""
    doubted_way: Length = 1.0
    """m; driven while scans do not correct the pose: from then on the place is ROUGH."""
    follow_after: Duration = 1.0
    """Driven while places are compared; then particles follow all that may be."""
    near_way: Length = 0.6
    near_turn: HalfTurn = 0.7
    """To each side, where it looks first: wheels that slip, a push."""
    new_way: Length = 0.12
    new_turn: HalfTurn = 0.4
    """Motion after which another scan counts."""
    hopeless: Positive = 14.0
    """A place that has so much less evidence than the best is dropped."""


class RecentSightConfig(Frozen):
    """What was seen a moment ago, which tells that the robot was not carried: s, m."""

    apart: WaitOrNone = 0.4
    """Between two scans that are kept, of which there are twelve."""
    newest: WaitOrNone = 1.0
    """The least age of a scan to compare with: later ones may be from after it was carried."""
    oldest: Duration = 6.0
    """The greatest age: by then it may have driven elsewhere."""
    slack: NotNegative = 0.10
    slack_share: Ratio = 0.03
    """m, and share of the range: how far from what was seen a beam may end and mean the same."""
    least_same: Ratio = 0.4
    """Share of all beams that must end where something was seen."""
    most_other: Ratio = 0.2
    """Of beams that end where something or nothing was seen: the largest share of the latter."""

    in_order: ClassVar[tuple[str, ...]] = ("newest < oldest",)


class CalibrationConfig(Frozen):
    """How far wheels, gyro and lidar may be off what is told of them, and when that is corrected.

    Deviations that are expected before anything was measured: ``scale`` of the wheels' way and turn
    and of the gyro, shares; ``drift`` of the heading by unequal wheels, rad/m; the lidar's
    ``shift``, m, and ``turn``, degrees. What is off by less than ``least_...``, in the same units,
    is left alone. A correction is applied when it is ``sure`` times as large as its deviation.
    It is measured over ``window_way``, m, or ``window_turn``, rad, as soon as either is driven.
    After ``forgetting_way``, m, what was measured counts no more than what was expected. In
    ``bias_time``, s, the gyro's bias may change by as much as it is unsure at the start.
    """

    scale: Positive = 0.02
    drift: Positive = 0.1
    shift: Length = 0.02
    turn: Positive = 1.5
    least_scale: Positive = 0.01
    least_gyro: Positive = 0.004
    least_drift: Positive = 0.02
    least_shift: Length = 0.001
    least_turn: Positive = 0.1
    sure: AtLeastOne = 1
    window_way: Length = 1.0
    window_turn: Angle = 1.5
    forgetting_way: Positive = 20_000.0
    bias_time: Duration = 600.0


class LocalizationConfig(Frozen):
    """Knowing where the robot is: how much motion and scans are trusted, and when not at all.

    Noises of way, side and wheels grow with the square root of the way (per sqrt(m)), that of turns
    and of what a turn moves the robot's middle by, ``turn_way_noise``, with that of the turn (per
    sqrt(rad)), the gyro's with that of the time; deviations are standard ones, m; time-outs in s;
    evidence is the natural logarithm of how much likelier.
    """

    way_noise: Positive = 0.02
    side_noise: Positive = 0.005
    turn_way_noise: Positive = 0.01
    wheel_turn_noise: Positive = 0.012
    turn_noise: Positive = 0.01
    gyro_drift: Positive = 0.001
    beam_deviation: Length = 0.03
    known_deviation: Length = 0.06
    unsure_deviation: Length = 0.08
    """Above it a scan is matched from farther away."""
    astray_deviation: Length = 0.3
    """Above it a pose is searched around, as one that was told is."""
    lost_deviation: Length = 1.0
    least_beams: AtLeastOne = 30
    scan_timeout: Duration = 0.9
    search_timeout: Duration = 30.0
    needed_evidence: Annotated[float, Field(gt=0.0, le=12.0)] = 8.0
    calibration: CalibrationConfig = CalibrationConfig()
    reckoning: ReckoningConfig = ReckoningConfig()
    fit: FitConfig = FitConfig()
    expecting: ExpectingConfig = ExpectingConfig()
    searching: SearchingConfig = SearchingConfig()
    recent_sight: RecentSightConfig = RecentSightConfig()

    in_order: ClassVar[tuple[str, ...]] = (
        "known_deviation < lost_deviation",
        "astray_deviation < lost_deviation",
    )
