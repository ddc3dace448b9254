"""The belief of the robot's pose, and the numbers of the models: rows that kernels read and write.

Both are arrays of one row. Lengths in m, angles in rad, times in s of the robot's clock; "map" and
"own" are frames: that of the map, and that of dead reckoning, in which the pose never jumps.
"""

from __future__ import annotations

from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.sensors import GyroConfig
from roomba.perception.calibration.state import CALIBRATION
from roomba.perception.matching.match_kernels import MATCH_WORK

Row: TypeAlias = Any
"""One row of an array below, in a kernel."""
Rows: TypeAlias = NDArray[np.void]

AGREE: Final = 0
SHORT: Final = 1
THROUGH: Final = 2
EVIDENCE: Final = 3
"""Places in ``fit``, whose numbers are those of
:class:`roomba.perception.matching.scan_view.Fit`."""

BELIEF: Final = np.dtype(
    [
        ("pose", "f8", (3,)),  # x, y, theta, map
        ("covariance", "f8", (3, 3)),  # of these, m2 and rad2
        ("unmatched", "f8", (3,)),  # both as they were before the newest scan was matched
        ("unmatched_covariance", "f8", (3, 3)),
        ("map_spread", "f8", (3, 3)),  # covariance by the map's errors here, m2 and rad2
        ("wall_offset", "f8", (2,)),  # of walls against the map's: beams times m, and beams
        ("unlike", "f8"),  # 0..1, how far the view has changed since the newest scan
        ("walls_apart", "f8", (2,)),  # offsets of single walls: sum of squares, m2, and walls
        ("pulls", "f8", (3,)),  # means for weak_kernels: pull back, its square, seeming information
        ("reckoned", "f8", (3,)),  # x, y, theta, own
        ("spread", "f8", (3,)),  # variances ahead, left, of the turn, since the newest scan
        ("reckoned_spread", "f8", (3,)),  # the same, up to that scan
        ("off", "f8", (3,)),  # what that scan corrected: ahead, left, m, and of theta
        ("odometry_scale", "f8", (3,)),  # factors on dead reckoning's variances, learned
        ("odometry", "f8", (3,)),  # the wheels' newest, in their frame
        ("stamp", "f8"),  # of these; -inf: none came yet
        ("turning", "f8"),  # what the gyro said then, rad/s; nan: nothing
        ("bias", "f8"),  # of the gyro, as learned, rad/s
        ("samples", "i8"),  # that the bias was learned from, since the wheels stand
        ("still_since", "f8"),  # inf: the wheels turn
        ("seen", "f8"),  # s, when the newest scan came in which anything was seen
        ("beams", "i8"),  # that met something in the newest scan
        ("is_judged", "?"),  # whether a fit is known
        ("is_doubtful", "?"),  # whether scans fit so badly that the robot may be elsewhere
        ("fit", "f8", (4,)),  # of the newest scan that was judged
        ("agree", "f8"),  # shares of beams (see Fit), of about the last three scans
        ("through", "f8"),
        ("usual_agree", "f8"),  # and of about the last 5 s
        ("usual_through", "f8"),
        ("counts", "f8", (5,)),  # what the kernels work in; means nothing between them
        ("work", "f8", (MATCH_WORK + 2, 3)),
        ("calibration", CALIBRATION),  # how far wheels, gyro and lidar are off what is told
    ],
    align=True,
)
NUMBERS: Final = np.dtype(
    [
        ("way_variance", "f8"),  # m2 per m of way
        ("side_variance", "f8"),
        ("turn_way_variance", "f8"),
        ("wheel_variance", "f8"),  # rad2 per m of way, of turns by the wheels
        ("turn_variance", "f8"),  # rad2 per rad, of every turn
        ("drift_variance", "f8"),  # rad2 per s, of turns by the gyro
        ("gyro_noise", "f8"),  # rad/s
        ("worst_bias", "f8"),  # rad/s
        ("beam_variance", "f8"),  # m2, but for that of the map's cells
        ("least_beams", "f8"),
        ("known_deviation", "f8"),  # m
        ("unsure_deviation", "f8"),
        ("astray_deviation", "f8"),
        ("scan_timeout", "f8"),  # s
        ("newest_share", "f8"),  # of a scan, in what the fit is now
        ("adapting_share", "f8"),  # and in what is usual
        ("doubt_worse", "f8"),  # shares of beams at which the pose is doubted: see FitConfig
        ("doubt_through", "f8"),
        ("doubt_agree", "f8"),
        ("settling", "f8"),  # s, of the gyro after a stop, and so on: see ReckoningConfig
        ("jolt", "f8"),
        ("longest_step", "f8"),
        ("same_way", "f8"),
        ("same_turn", "f8"),
    ]
)

SMOOTHING: Final = 0.4
"""Share of the newest scan in what the fit is now: about the last three scans count."""
ADAPTING: Final = 0.02
"""Share of the newest scan in the usual fit: about the last 5 s count."""
_MOST_SMOOTHING: Final = 0.5
"""Limit of :data:`SMOOTHING` if few scans are used: one that fits half as well raises no doubt."""


def unknown_belief() -> Rows:
    """Return the initial belief: at the origin, without variance."""
    belief = np.zeros(1, BELIEF)
    belief["stamp"] = belief["seen"] = -np.inf
    belief["odometry_scale"] = 1.0
    belief["turning"], belief["still_since"] = np.nan, np.inf
    return belief


def numbers_of(config: LocalizationConfig, gyro: GyroConfig, every: int = 1) -> Rows:
    """Return the numbers for kernels that are shown each ``every``-th scan of a lidar."""
    fields: dict[str, float] = {
        "way_variance": config.way_noise**2,
        "side_variance": config.side_noise**2,
        "turn_way_variance": config.turn_way_noise**2,
        "wheel_variance": config.wheel_turn_noise**2,
        "turn_variance": config.turn_noise**2,
        "drift_variance": config.gyro_drift**2,
        "gyro_noise": gyro.noise,
        "worst_bias": 4.0 * gyro.bias + 4.0 * gyro.noise,
        "beam_variance": config.beam_deviation**2,
        "least_beams": config.least_beams,
        "known_deviation": config.known_deviation,
        "unsure_deviation": config.unsure_deviation,
        "astray_deviation": config.astray_deviation,
        "scan_timeout": config.scan_timeout,
        "newest_share": share_of(SMOOTHING, every, _MOST_SMOOTHING),
        "adapting_share": share_of(ADAPTING, every, 1.0),
        "doubt_worse": config.fit.doubt_worse,
        "doubt_through": config.fit.doubt_through,
        "doubt_agree": config.fit.doubt_agree,
        **config.reckoning.model_dump(),
    }
    numbers = np.zeros(1, NUMBERS)
    for name, value in fields.items():
        numbers[name] = value
    return numbers


def share_of(share: float, scans: int, most: float) -> float:
    """Return the share of a scan that stands for ``scans`` ones, of which each counts ``share``."""
    return share if scans == 1 else min(most, 1.0 - (1.0 - share) ** scans)
