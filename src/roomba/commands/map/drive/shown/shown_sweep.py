"""How a lidar measures its beams one after the other, as its scans show while the robot turns.

Some drivers reverse scans but not their ``time_increment`` (Slamtec/rplidar_ros, issue 55), some
give a wrong one, many none. A scan that is taken in a turn is bent, unless it is corrected by the
sweep that it was measured with; one that is taken while the robot hardly turns is straight. So bent
scans are corrected by one possible sweep after the other, and matched to straight ones: the right
sweep makes them fit.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples, Sample, laid_on
from roomba.recordings.drives.sweeps import Sweep

_TURNING: Final = 0.03
"""rad; the robot turns at least so far during a scan that counts as bent."""
_STRAIGHT: Final = 0.25
"""Share of that angle by which the robot turns at most during a straight scan."""
_NEAR_WAY, _NEAR_TURN = 1.0, 1.0
"""m, rad; scans that are farther apart show other places."""
_PAIRS, _LEAST_PAIRS = 80, 10
"""The most pairs of scans that are compared, and the least that are needed."""
_LATE: Final = (0.0, 0.1, 0.2, 0.3, 0.4)
"""s; delays of the stamps that are tried with each sweep, since drivers stamp scans late: the delay
that fits best counts."""
_WINDOW, _TURN = 0.2, 0.2
"""m, rad; by which odometry may be off between two scans."""
_CLEAR: Final = 4.0
"""Standard errors by which another sweep must fit better than the driver's."""
_SAME: Final = 0.3
"""Share by which two times of a whole turn must differ to count as two."""


def shown_sweep(samples: LidarSamples) -> Sweep | None:
    """Return the sweep that fits clearly better than the driver's; None if none does."""
    pairs = _pairs(samples)
    if len(pairs) < _LEAST_PAIRS:
        return None
    told = _fits(samples, pairs, None)
    best, best_fits = None, told
    for sweep in _sweeps(samples):
        fits = _fits(samples, pairs, sweep)
        better = fits - told
        error = float(better.std()) / math.sqrt(len(better))
        if better.mean() > _CLEAR * error and fits.mean() > best_fits.mean():
            best, best_fits = sweep, fits
    return best


def _pairs(samples: LidarSamples) -> list[tuple[Sample, Sample]]:
    """Return pairs of a straight and a bent scan of about the same place, over the whole drive."""
    scans = samples.scans
    stamps = np.array([sample.stamp for sample in scans])
    turns = np.array([abs(samples.turning(sample)) for sample in scans])
    pairs = []
    for number in np.flatnonzero(turns > _TURNING).tolist():
        straight = np.flatnonzero(turns < _STRAIGHT * turns[number])
        if not len(straight):
            continue
        nearest = straight[np.argmin(np.abs(stamps[straight] - stamps[number]))]
        x, y, turn = samples.between(scans[nearest], scans[number]).tolist()
        if math.hypot(x, y) < _NEAR_WAY and abs(turn) < _NEAR_TURN:
            pairs.append((scans[nearest], scans[number]))
    chosen = np.linspace(0, len(pairs) - 1, min(len(pairs), _PAIRS)).round().astype(int)
    return [pairs[number] for number in chosen.tolist()]


def _sweeps(samples: LidarSamples) -> list[Sweep]:
    """Return the sweeps that may be true instead of the driver's."""
    lidar = samples.scans[0].scan.lidar
    told = lidar.time_increment * math.tau / abs(lidar.step)
    sweeps = []
    if told:
        sweeps += [Sweep(turn=0.0), Sweep(is_backwards=True)]
    if told < 0.0:
        sweeps.append(Sweep())
    if abs(abs(told) - samples.period) > _SAME * samples.period:
        # Most lidars turn evenly, once for each scan.
        sweeps += [Sweep(is_backwards, samples.period) for is_backwards in (False, True)]
    return sweeps


def _fits(samples: LidarSamples, pairs: list[tuple[Sample, Sample]], sweep: Sweep | None) -> Floats:
    """Return how well the scans of pairs fit each other, [pairs], 0..1."""
    fits = [[_fit(samples, *pair, sweep, late) for pair in pairs] for late in _LATE]
    return np.array(max(fits, key=sum))


def _fit(
    samples: LidarSamples, straight: Sample, bent: Sample, sweep: Sweep | None, late: float
) -> float:
    """Return how well a bent scan fits a straight one, where it fits best, 0..1."""
    place, points = (samples.points(each, sweep, late) for each in (straight, bent))
    match = laid_on(place, points, samples.between(straight, bent, late), _WINDOW, _TURN)
    return 0.0 if match is None else match.score
