"""What a burst works on: a row of its own state, and the arrays of the parts that it advances."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.control.curve_kernels import Course
from roomba.perception.localization.recent_sight_kernels import Sights
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.reckoned_path import ReckonedPath
from roomba.perception.slam.following.scan_kernels import Following
from roomba.perception.things.state import Things
from roomba.world.engine.lidar.projection import ScanBuffers
from roomba.world.engine.state.arrays import State

Rows = NDArray[np.void]

BURST: Final = np.dtype(
    [
        # what does not change
        ("step", "f8"),  # s of the world
        ("steps", "i8"),  # of the world in a tick
        ("apart", "f8"),  # s; the least between two scans that are processed
        ("stride", "i8"),  # scans that a processed one stands for
        ("unsure", "f8"),  # m; deviation of a mapper's position
        ("bin_capacity", "f8"),  # micrograms
        ("is_late", "?"),  # whether scans are older than the tick at which they arrive
        ("is_turned", "?"),  # whether poses are told in another frame than the world's
        ("axes", "f8", (4,)),  # of the world's frame in that one: x, y, cosine, sine of turn
        ("turn", "f8"),  # rad
        # what ends a burst
        ("drives", "?"),  # whether it drives along a path; else it stands on its station
        ("limit", "f8"),  # m/s
        ("until", "f8"),  # s
        ("least_charge", "f8"),  # Wh
        ("most_charge", "f8"),
        ("goal", "f8", (2,)),  # m
        ("near", "f8"),  # m
        ("watches_dirt", "?"),  # whether dirty floor close by ends the burst
        ("most_in_bin", "f8"),  # micrograms
        ("most_silent", "f8"),  # m2 that became clean without a grain
        ("cell_area", "f8"),  # m2
        ("off_path", "f8"),  # m
        ("felt_version", "i8"),  # of what the bumper felt in the way
        # what changes
        ("clock", "f8"),  # s; the robot's time minus the world's
        ("scans", "i8"),  # how many came so far
        ("seen_at", "f8"),  # s; the stamp of the last scan that was processed
        ("submap", "f8", (3,)),  # m, rad; pose of the submap in which a mapper follows the robot
        ("at_scan", "f8", (3,)),  # m, rad; a mapper's pose at the last processed scan
        ("seen_from", "f8", (3,)),  # m, rad; a localizer's pose at the newest scan
        ("last", "f8", (3,)),  # time, s, and place, m, as believed, when the last tick began
        ("way", "f8"),  # m; driven in the burst, as believed
        ("sweeps", "?"),  # whether floor that is driven over counts as cleaned
        ("swept_at", "f8", (2,)),  # m; where floor counted last, as believed
        ("true_at", "f8", (2,)),  # m; the same in truth
        ("swept", "i8"),  # wanted cells that became clean
        ("truth_swept", "i8"),
        # what the classes have to finish
        ("is_left", "?"),  # whether the rest of the newest scan is left to the classes
        ("is_followed", "?"),  # whether a mapper has followed its pose by that scan already
    ],
    align=True,
)
"""State and numbers of a burst, one row."""


class World(NamedTuple):
    """The world of one robot: those of ``state`` from ``first`` to before ``last``."""

    state: State
    numbers: Rows
    quantiles: NDArray[np.float32]
    buffers: ScanBuffers
    first: int
    last: int


class PlaceParts(NamedTuple):
    """What knows the robot's pose: a localizer has ``sights``, a mapper has ``following``.

    ``still``, float32 [beams], and ``work``, [SWEEP_WORK, beams], are room for turning a late scan
    into one from a single pose.
    """

    belief: Rows
    numbers: Rows
    path: ReckonedPath
    beams: LidarBeams
    sights: Sights | None
    following: Following | None
    still: NDArray[np.float32]
    work: Floats


class Sight(NamedTuple):
    """What is seen that the map does not show; ``field`` and ``place`` are that map's."""

    things: Things
    field: NDArray[np.float32]
    place: Floats


class Drive(NamedTuple):
    """The path tracker, its path, its progress on the path, and how far the path is clear.

    ``before`` is room for the tracker's state before a tick.
    """

    state: Rows
    before: Rows
    course: Course
    progress: Rows
    ahead: Rows


class Floor(NamedTuple):
    """Floor that is clean by belief and in truth, how dirty it was, and what came into the bin."""

    cells: NDArray[np.uint8]
    place: Floats
    true_cells: NDArray[np.uint8]
    true_place: Floats
    radius: float
    grains: NDArray[np.float32]
    way: NDArray[np.float32]
    dirt_place: Floats
    dust: Rows
    carpet: Rows
    watch: Rows
    done: NDArray[np.bool_]
