"""The state that the compiled step reads and writes, as rows of named numbers.

A *home* is what never changes; a *world* is a home in which time passes, with its own dirt and
moving things; a *robot* lives in a world. Rows refer to each other by number: ``things_at`` and
``things_end`` of a world are the first of its things and the one after the last. Lengths in m,
angles in rad, map frame; times in s; dirt in micrograms; energy in Wh.

A row in a kernel is a pointer, so functions that are given one read ``robot.x`` and write it.
"""

from __future__ import annotations

from enum import Enum, IntFlag
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Row: TypeAlias = Any
"""One row of an array below, in a kernel."""
Rows: TypeAlias = NDArray[np.void]

FLOOR: Final = 0
CARPET: Final = 1
DROP: Final = 2
"""What the ground of a cell is: hard floor, carpet, or a stair down."""

MOST_DISCS: Final = 16
"""Round things that may be put into a world while it runs."""

HOME: Final = np.dtype(
    [
        ("resolution", "f8"),
        ("left", "f8"),  # lower left corner of the grid
        ("bottom", "f8"),
        ("cells_at", "i8"),
        ("squares_at", "i8"),
        ("rows", "i8"),
        ("columns", "i8"),
        ("station_x", "f8"),  # pose of the docked robot
        ("station_y", "f8"),
        ("station_theta", "f8"),
        ("dirt_resolution", "f8"),
        ("floors_at", "i8"),
        ("dirt_rows", "i8"),
        ("dirt_columns", "i8"),
        ("tiles_at", "i8"),
        ("tile_columns", "i8"),
        ("tile_size", "f8"),
        ("has_drops", "f8"),  # 1 if there is a DROP anywhere
        ("faces_at", "i8"),  # of walls free of the grid
        ("clear_at", "i8"),  # the first of them that is glass, a mirror or low
        ("faces_end", "i8"),
    ]
)
CELL: Final = np.dtype(
    [
        ("room", "f4"),  # no solid cell is nearer than this to the cell's middle
        ("solid", "?"),
        ("ground", "u1"),
        ("surface", "u1"),  # what it does to light, 0: as its place says
    ],
    align=True,
)
FACE: Final = np.dtype(
    [
        ("right_x", "f8"),  # its ends as seen from outside: the other side is not seen
        ("right_y", "f8"),
        ("left_x", "f8"),
        ("left_y", "f8"),
        ("finish", "f8"),  # as of roomba.world.home.surface.Finish
        ("reflectivity", "f8"),  # below 0: as its place says
    ]
)
EDGE: Final = np.dtype(
    [
        ("line", "f4"),  # its place across its direction, from the grid's lower left corner
        ("low", "f4"),  # its ends along it
        ("high", "f4"),
        ("leads_to", "i4"),  # the tile behind a portal, -1 for a wall
    ]
)
SOURCE: Final = np.dtype(
    [
        ("x", "f8"),
        ("y", "f8"),
        ("radius", "f8"),
        ("mean_wait", "f8"),  # between two crumbs; inf: never
    ]
)
BOX: Final = np.dtype(
    [
        ("x", "f8"),  # in the frame of its thing
        ("y", "f8"),
        ("theta", "f8"),
        ("half_length", "f8"),
        ("half_width", "f8"),
        ("bottom", "f8"),  # above the floor
        ("top", "f8"),
    ]
)
_WORLD: Final = (
    ("time", "f8", True),
    ("random", "u8", True),
    ("home", "i8", False),
    ("robots_at", "i8", False),
    ("robots_end", "i8", False),
    ("dirt_at", "i8", False),
    ("dirt_end", "i8", False),
    ("brought_in", "i8", True),
    ("falls_at", "i8", False),
    ("falls_end", "i8", False),
    ("things_at", "i8", False),
    ("things_end", "i8", False),
    ("discs_at", "i8", False),
    ("discs_end", "i8", False),
    ("pull_x", "f8", True),  # by carpets, m for each metre rolled
    ("pull_y", "f8", True),
)
"""Name, type, and whether a reset renews it."""
WORLD: Final = np.dtype([(name, kind) for name, kind, _ in _WORLD])
RENEWED: Final = tuple(name for name, _, is_renewed in _WORLD if is_renewed)
"""Fields of a world's row that a reset renews: all but its home and the bounds of its parts."""
FALL: Final = np.dtype([("time", "f8"), ("source", "i8")])
"""When the next crumb of a source falls."""
THING: Final = np.dtype(
    [
        ("x", "f8"),
        ("y", "f8"),
        ("theta", "f8"),
        ("present", "f8"),
        ("time", "f8"),  # its own, which stands still while it waits for a robot
        ("row", "i8"),  # of its track, where it is now
        ("last_row", "i8"),
        ("boxes_at", "i8"),
        ("boxes_end", "i8"),
    ]
)
DISC: Final = np.dtype([("x", "f8"), ("y", "f8"), ("radius", "f8")])
ROBOT: Final = np.dtype(
    [
        # what is true
        ("x", "f8"),
        ("y", "f8"),
        ("theta", "f8"),
        ("linear", "f8"),  # as the drive turns the wheels
        ("angular", "f8"),
        ("hit", "f8"),  # 1 while something stops the body's way
        ("ground_linear", "f8"),  # of the body over the ground
        ("ground_angular", "f8"),
        ("distance", "f8"),  # driven
        ("turned", "f8"),  # either way
        ("hits", "f8"),  # how often it ran into something
        ("wheel_left", "f8"),  # how far the wheel really turned
        ("wheel_right", "f8"),
        ("charge", "f8"),
        ("used", "f8"),  # taken from the battery so far
        ("charged", "f8"),  # brought into it
        ("power", "f8"),  # W out of the battery, negative while it charges
        ("temperature", "f8"),
        ("docked", "f8"),  # 1 while the contacts touch those of the station
        ("in_bin", "i8"),
        # what it is told
        ("wanted_linear", "f8"),
        ("wanted_angular", "f8"),
        ("max_speed", "f8"),
        ("brush_duty", "f8"),
        ("fan_duty", "f8"),
        # what it senses
        ("bumper_left", "f8"),
        ("bumper_right", "f8"),
        ("cliff_left", "f8"),
        ("cliff_front_left", "f8"),
        ("cliff_front_right", "f8"),
        ("cliff_right", "f8"),
        ("drop_left", "f8"),
        ("drop_right", "f8"),
        ("stall_left", "f8"),
        ("stall_right", "f8"),
        ("encoder_left", "f8"),  # how far the wheel turned, as counted
        ("encoder_right", "f8"),
        ("odometry_x", "f8"),  # the pose since the start, by the encoders
        ("odometry_y", "f8"),
        ("odometry_theta", "f8"),
        ("odometry_linear", "f8"),
        ("odometry_angular", "f8"),
        ("gyro", "f8"),
        ("acceleration", "f8"),
        ("grains", "f8"),  # per second in the intake, over the dirt sensor's window
        ("brush_current", "f8"),
        ("beams", "i8"),  # of the station, see Infrared
        ("scans", "i8"),  # how many the lidar has made
        ("next_scan", "f8"),
        ("scan_stamp", "f8"),  # when the first beam of the newest scan was measured
        # a sweep of a lidar that turns while it measures, see sweep_kernels
        ("before_x", "f8"),  # the pose before the last step
        ("before_y", "f8"),
        ("before_theta", "f8"),
        ("sweeps", "f8"),  # 1 while one is made
        ("sweep_start", "f8"),
        ("next_beam", "f8"),
        ("last_range", "f8"),  # exact, of the beam before
        ("sweep_key", "u8"),
        ("is_underway", "f8"),  # 1 while one is on the line
        ("underway_stamp", "f8"),
        ("arrival", "f8"),
        # what is its own: chance, and the errors of its parts
        ("random", "u8"),
        ("wheel_left_size", "f8"),  # 1 without error
        ("wheel_right_size", "f8"),
        ("roll_left", "f8"),  # real way of the wheel per metre by its told size
        ("roll_right", "f8"),
        ("track", "f8"),  # between the wheels
        ("lidar_x", "f8"),  # how far the lidar is off its place, body's frame
        ("lidar_y", "f8"),
        ("lidar_turn", "f8"),
        ("gyro_scale", "f8"),
        ("gyro_bias", "f8"),
        ("varying_left", "f8"),  # the varying part of the wheel's slip
        ("varying_right", "f8"),
        # what is wrong with it, see Fault
        ("slip_left", "f8"),
        ("slip_right", "f8"),
        ("held_left", "f8"),
        ("held_right", "f8"),
        ("lifted", "f8"),
        ("station_dead", "f8"),
        ("lidar_blocked", "f8"),
        ("bumper_stuck", "f8"),
        ("cliff_dirty", "f8"),
        ("infrared_blocked", "f8"),
        ("dirt_sensor_blocked", "f8"),
    ]
)


class Infrared(IntFlag):
    """What the receiver sees of a station; the values are those of Create 2's station."""

    HALO = 1
    GREEN = 4
    """The beam to the station's right, as it looks out."""
    RED = 8
    """The one to its left."""


def code_of(seen: Infrared) -> int:
    """Return what Create 2's receiver tells of beams: 160 and their bits, 0 for none."""
    return 160 + int(seen) if seen else 0


class Fault(Enum):
    """Faults of a robot; the value is the name of the number in its row, 0..1."""

    SLIP_LEFT = "slip_left"
    """Share of the left wheel's way that is lost."""
    SLIP_RIGHT = "slip_right"
    STALL_LEFT = "held_left"
    """The left wheel is held."""
    STALL_RIGHT = "held_right"
    LIFTED = "lifted"
    """The robot is held in the air."""
    STATION_DEAD = "station_dead"
    """Its station has no power."""
    LIDAR_BLOCKED = "lidar_blocked"
    """No beam comes back."""
    BUMPER_STUCK = "bumper_stuck"
    """Both halves stay pressed."""
    CLIFF_DIRTY = "cliff_dirty"
    """The cliff sensors see no floor."""
    INFRARED_BLOCKED = "infrared_blocked"
    """The station is not seen."""
    DIRT_SENSOR_BLOCKED = "dirt_sensor_blocked"
    """No grain is counted."""


class Solid(NamedTuple):
    """What stops bodies."""

    cells: Rows
    """CELL: those of all homes, row by row."""
    squares: NDArray[np.uint8]
    """[QUADRANTS, cells and margins of all homes]: see lidar.free_squares."""
    faces: Rows
    """FACE: those of all homes."""
    things: Rows
    """THING"""
    boxes: Rows
    """BOX"""
    discs: Rows
    """DISC: MOST_DISCS for each world."""
    robots: Rows
    """ROBOT"""


class Dirt(NamedTuple):
    """Dirt, and where it comes from."""

    micrograms: NDArray[np.int32]
    """Cells of all worlds."""
    floors: NDArray[np.bool_]
    """Cells of all homes: whether dirt can lie there."""
    falls: Rows
    """FALL: for each source of each world."""
    sources: Rows
    """SOURCE"""


class Edges(NamedTuple):
    """What the lidar sees of homes: see :class:`roomba.world.engine.lidar.edges.LidarEdges`."""

    items: Rows
    """EDGE: those of all homes."""
    starts: NDArray[np.int32]
    """[tiles, GROUPS + 1], of all homes; they count in ``items``."""


class State(NamedTuple):
    """Everything together."""

    homes: Rows
    """HOME"""
    worlds: Rows
    """WORLD"""
    solid: Solid
    dirt: Dirt
    edges: Edges
    tracks: NDArray[np.float64]
    """[rows, 5]: time, x, y, theta, present; see :mod:`roomba.world.home.moving`."""
    ranges: NDArray[np.float32]
    """[robots, beams]: the last scans."""
    made: NDArray[np.float32]
    """[robots, beams]: the sweeps that are being made; no beams if all are measured at once."""
    underway: NDArray[np.float32]
    """The same: those on the line."""
