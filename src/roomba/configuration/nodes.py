"""Numbers of the ROS nodes alone: deadlines, periods, what is kept: ``configuration/nodes.yaml``.

A node is one process among several: what it waits for, and how often it tells what it knows, is
no matter of the robot's brain, which runs without ROS as well.
"""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.body import Speed
from roomba.configuration.frozen import (
    Angle,
    AtLeastOne,
    Duration,
    Frozen,
    Length,
    Positive,
    TurningSpeed,
)

Bytes = Annotated[float, Field(ge=1.0, le=1e18)]
Unsure = tuple[Positive, Positive]
"""Standard deviations of a place and a heading, m and rad."""


class HearingConfig(Frozen):
    """When the pose is no longer told: after both, as a fast clock runs on while all nodes work."""

    oldest_pose: Duration = 0.5
    """s of the robot's clock; the newest pose still counts until it is older than this."""
    silence: Duration = 0.4
    """s of wall time; the newest pose still counts until none was heard for so long."""


class DeadlinesConfig(Frozen):
    """How long a node waits for others: s of wall time."""

    senses: Duration = 6.0
    """After this, goals are taken, and rejected, even if map, pose or senses are missing."""
    answer: Duration = 5.0
    """For the tick that answers a service; a long plan may hold one up."""
    mapping: Duration = 3.0
    """For being told whether a map without a load time is whole or grows."""
    rooms: Duration = 3.0
    """For the map's rooms; rooms that come later make a new planning context."""
    floor: Duration = 20.0
    """s of the robot's clock; a floor that was not recognised by then is a new one."""
    ending: Duration = 2.5
    """s of the robot's clock; how long a cancelled walk, or look around, may still drive."""
    emptying: Duration = 0.5
    """s of the robot's clock; how long a simulated station goes on emptying untold."""


class WalkEndConfig(Frozen):
    """How a walk ends on ROS: the turn to the heading that was asked for, and a cancel."""

    aimed: Angle = 0.05
    """rad; tolerance of the final heading."""
    not_turning: TurningSpeed = 0.2
    """rad/s; a robot that turns slower keeps its heading."""
    longest_turn: Duration = 6.0
    """s; limit of the turn at the goal; half a turn takes two."""
    standstill: Speed = 0.02
    """m/s; a cancelled walk stands when it is slower."""
    longest_braking: Duration = 1.0
    """s after which a cancelled walk counts as standing in any case, without odometry too."""
    heard_by: Duration = 0.3
    """s; after this a setpoint has reached its subscriber, on a busy machine too."""


class PeriodsConfig(Frozen):
    """How often something is told or asked for: s of the robot's clock, or ticks."""

    position_ticks: AtLeastOne = 2
    """Ticks between two positions, covariances and transforms."""
    cloud_ticks: AtLeastOne = 10
    """Ticks between two clouds of hypotheses."""
    state_ticks: AtLeastOne = 20
    """Ticks between two states of the localization that did not change."""
    speed: Duration = 0.1
    """Between two messages of the speed."""
    mission_state: Duration = 1.0
    """Between two states of the mission that did not change."""
    mission_map: Duration = 1.0
    """Between two maps of the same kind that the mission tells."""
    mission_map_wall: Duration = 0.5
    """s of wall time between two maps of the same kind, on a fast clock too."""
    changes: Duration = 0.4
    """Between two scans that are looked through for changes of the map."""
    finish: Duration = 5.0
    """s of wall time from one wish for the whole map to the next, while the mission waits."""
    pictures: Duration = 0.2
    """s of wall time between two pictures of the simulated camera's stream."""
    true_pose_wall: Duration = 0.04
    """s of wall time between two tellings of where a simulated robot really is."""
    true_dirt_wall: Duration = 0.5
    """s of wall time between two tellings of the dirt that really lies in its home."""


class MemoryConfig(Frozen):
    """What is kept for a node that is killed: how often it is written, and when it is dropped."""

    pose: Duration = 0.7
    """s of wall time between two poses that the master keeps."""
    errand: Duration = 0.8
    """s of wall time between two checkpoints of a phase."""
    map: Duration = 0.8
    """s of the robot's clock between two writings of the map that is being made."""
    map_wall_per_byte: Positive = 1e-6
    """s of wall time between two such writings for each byte: 1 MB/s is enough for any disk."""
    most_taken_up: AtLeastOne = 5
    """Kept state with which a node ended so often, each time within ``goes_well``, is dropped: it
    may be the cause."""
    goes_well: Duration = 20.0
    """s of wall time after which kept state that was taken up counts as harmless."""
    free_space: Bytes = 2e6
    """Bytes; with less on the disk of the errand it is told that the disk is full."""
    free_space_period: Duration = 1.0
    """s of wall time between two looks at how much is free."""


class PlacingConfig(Frozen):
    """How unsure a place is that was not found by scans: m and rad."""

    start: Unsure = (0.05, 0.05)
    """A start pose of the parameters."""
    kept: Unsure = (0.10, 0.05)
    """A pose that the master kept: it drifted since."""
    on_map: Unsure = (0.05, 0.05)
    """A place on another map of the same floor."""
    on_finished: Unsure = (0.03, 0.02)
    """The place on the map when it was made whole."""


class PaceConfig(Frozen):
    """How the simulation waits for the robot's nodes: s of wall time."""

    latest: Duration = 0.5
    """Farther behind, the simulation goes on slower than asked for."""
    most_behind: Duration = 0.07
    """s of the robot's clock; the simulation waits for a robot that is farther behind. A robot that
    keeps up is a tick behind at most. A robot may stand so much later than promised; with 0.3 s a
    turn on the spot would not end: the robot would swing to and fro."""
    longest_hold: Duration = 2.0
    """A node that is silent for longer is not waited for any more."""
    longest_absence: Duration = 60.0
    """A part that was not heard for longer does not come back."""

    in_order: ClassVar[tuple[str, ...]] = ("longest_hold <= longest_absence",)


class PicturesConfig(Frozen):
    """When a kept picture of an angle is old, and how often one is taken."""

    travelled: Length = 0.1
    """m from where it was taken."""
    turned: Angle = 0.3
    """rad from the heading at which it was taken."""
    rest: Duration = 2.5
    """s of wall time between two pictures, at least: one is much work, on a fast clock too."""


class SupervisionConfig(Frozen):
    """When a process of the robot is reported, ended, started anew or given up: s of wall time."""

    busy: Duration = 2.0
    """A node whose last sign of life is older is reported: it hangs, or works for long."""
    hung: Duration = 20.0
    """A node silent for longer is ended and started anew: plans of large homes take seconds."""
    stopped: Duration = 2.0
    """So is a process that a signal or a debugger has stopped for so long."""
    back_after: Duration = 0.2
    """From the end of a process until it is started anew."""
    short_life: Duration = 20.0
    """A process that lived for less had a short life."""
    most_short_lives: AtLeastOne = 15
    """After so many short lives in a row a process is not started any more."""

    in_order: ClassVar[tuple[str, ...]] = ("busy <= stopped <= hung",)


class NodesConfig(Frozen):
    """All of ``configuration/nodes.yaml``; every part has the shipped file's values by default."""

    hearing: HearingConfig = HearingConfig()
    deadlines: DeadlinesConfig = DeadlinesConfig()
    walk_end: WalkEndConfig = WalkEndConfig()
    periods: PeriodsConfig = PeriodsConfig()
    memory: MemoryConfig = MemoryConfig()
    placing: PlacingConfig = PlacingConfig()
    pace: PaceConfig = PaceConfig()
    pictures: PicturesConfig = PicturesConfig()
    supervision: SupervisionConfig = SupervisionConfig()
