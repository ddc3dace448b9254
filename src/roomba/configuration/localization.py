"""Numbers of knowing where the robot is."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.frozen import AtLeastOne, Frozen, Positive


class LocalizationConfig(Frozen):
    """Knowing where the robot is: how much motion and scans are trusted, and when not at all.

    Noises of way, side and wheels grow with the square root of the way (per sqrt(m)), that of turns
    with that of the turn, the gyro's with that of the time; deviations are standard ones, m;
    time-outs in s; evidence is the natural logarithm of how much likelier.
    """

    way_noise: Positive = 0.02
    side_noise: Positive = 0.005
    wheel_turn_noise: Positive = 0.012
    turn_noise: Positive = 0.01
    gyro_drift: Positive = 0.001
    beam_deviation: Positive = 0.03
    known_deviation: Positive = 0.06
    lost_deviation: Positive = 1.0
    least_beams: AtLeastOne = 30
    scan_timeout: Positive = 0.5
    search_timeout: Positive = 30.0
    needed_evidence: Annotated[float, Field(gt=0.0, le=12.0)] = 8.0

    in_order: ClassVar = ("known_deviation < lost_deviation",)
