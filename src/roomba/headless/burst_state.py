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
        ("apart", "f8"),  # s; at least, between two scans that are looked at
        ("stride", "i8"),  # scans that such a one stands for
        ("unsure", "f8"),  # m; deviation of the place of a mapper
        ("bin_capacity", "f8"),  # micrograms
        ("is_late", "?"),  # whether scans are older than the tick at which they come
        ("is_turned", "?"),  # whether poses are told in another frame than the world's
        ("axes", "f8", (4,)),  # where the world's lies in it: x, y, cosine and sine of the turn
        ("turn", "f8"),  # rad
        # what ends it
        ("drives", "?"),  # along a path; else it stands on its station
        ("limit", "f8"),  # m/s
        ("until", "f8"),  # s
        ("least_charge", "f8"),  # Wh
        ("most_charge", "f8"),
        ("goal", "f8", (2,)),  # m
        ("near", "f8"),  # m
        ("watches_dirt", "?"),  # whether dirty floor close by ends it
        ("most_in_bin", "f8"),  # micrograms
        ("most_silent", "f8"),  # m2 that became clean without a grain
        ("cell_area", "f8"),  # m2
        ("off_path", "f8"),  # m
        ("felt_version", "i8"),  # of what the bumper felt in the way
        # what goes on
        ("clock", "f8"),  # s; of the robot, beside the world's
        ("scans", "i8"),  # that came so far
        ("seen_at", "f8"),  # s; when the last one that was looked at came
        ("submap", "f8", (3,)),  # m, rad; where a mapper follows it
        ("at_scan", "f8", (3,)),  # a mapper's place at that one
        ("seen_from", "f8", (3,)),  # where the newest scan was taken, as a localizer has it
        ("last", "f8", (3,)),  # time, s, and place, m, as believed, when the last tick began
        ("way", "f8"),  # m; driven between these, as believed
        ("sweeps", "?"),  # whether what is driven over counts
        ("swept_at", "f8", (2,)),  # m; where it counted last, as believed
        ("true_at", "f8", (2,)),  # m; the same in truth
        ("swept", "i8"),  # wanted cells that became clean
        ("truth_swept", "i8"),
        # what the classes have to finish
        ("is_left", "?"),  # the newest scan
        ("is_followed", "?"),  # though a mapper's place was followed by it
    ],
    align=True,
)
"""State and numbers of a burst, one row."""


class World(NamedTuple):
    """The simulated one, of one robot: of those of ``state`` from ``first`` to before ``last``."""

    state: State
    numbers: Rows
    quantiles: NDArray[np.float32]
    buffers: ScanBuffers
    first: int
    last: int


class PlaceParts(NamedTuple):
    """What knows the place: a localizer has ``sights``, a mapper what it is ``following``.

    In ``still``, float32 [beams], and ``work``, [SWEEP_WORK, beams], late scans are put together.
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
    """The tracker, its path, how it comes farther on it, and how far that is clear.

    ``before`` is room for the tracker's state as it was before a tick.
    """

    state: Rows
    before: Rows
    course: Course
    progress: Rows
    ahead: Rows


class Floor(NamedTuple):
    """What is cleaned as the robot believes and in truth, how dirty it was, and what came in."""

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
