"""The interface of one file of a recorded drive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roomba.perception.matching.mounts import FrameTransform, Mount
from roomba.recordings.readings import Kind, Refused, Value

MountOf: TypeAlias = Callable[[str, Kind], Mount]
"""Tells where the frame of a sensor is on the robot; the kind is that of its readings."""


class Channel(NamedTuple):
    """A topic of a bag, or a kind of line: ``kind`` is None for what a drive does not need."""

    name: str
    kind: Kind | None
    type: str
    messages: int


class Arrival(NamedTuple):
    """A message that came: the number of its channel, and its times, s.

    ``stamp`` is what the message itself says, 0 if nothing; ``arrival`` is when it was recorded.
    ``is_by_order``: other messages have the same time, and its place among them gives ``arrival``.
    """

    channel: int
    stamp: float
    arrival: float
    is_by_order: bool = False


class Frames(NamedTuple):
    """The frame of odometry, and that of the body that it tells of; "" what is not told."""

    odometry: str
    body: str


class Log(Protocol):
    """One file, or the folder of a bag, that is open for reading."""

    path: Path

    @property
    def channels(self) -> Sequence[Channel]:
        """What was recorded."""

    @property
    def notes(self) -> Sequence[str]:
        """What is worth knowing of what was read so far."""

    def frames(self, odometry: Channel) -> Frames:
        """Return the frames of a channel of odometry."""

    def transforms(self) -> Iterable[FrameTransform]:
        """Return where sensors are in frames that do not move against them."""

    def entries(self, channels: Sequence[Channel]) -> Iterator[Arrival]:
        """Yield what came on ``channels``, numbered as these are, as it was recorded."""

    def values(
        self, channels: Sequence[Channel], wanted: NDArray[np.bool_], mount_of: MountOf
    ) -> Iterator[Value | Refused | None]:
        """Yield a value for each entry, in the same order; None where it is not ``wanted``."""

    def close(self) -> None:
        """Close the file, and remove what was unpacked of it."""
