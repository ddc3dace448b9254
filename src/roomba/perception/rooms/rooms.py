"""The rooms of a floor: labelled cells, names, and the edits that a person may make."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.configuration.rooms import RoomsConfig
from roomba.errors import RoomsError
from roomba.geometry import Point
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.rooms import edits as rooms_edits
from roomba.perception.rooms.floor_kernels import contacts
from roomba.perception.rooms.outlines import cells_inside, line_on, outline_of
from roomba.perception.rooms.segmentation import room_labels
from roomba.raster.distance import distance_to_nearest
from roomba.vocabulary import LONGEST_NAME, another_name, fault_of_name, listed

SMALLEST_PIECE = 0.5
"""m²; a cut that leaves less is a slip of the finger: the robot alone covers 0.1 m²."""


@dataclass(frozen=True, slots=True)
class RoomDoorway:
    """Where two rooms touch: their labels, the opening's middle, m, and about its width, m."""

    first: int
    second: int
    x: float
    y: float
    width: float


@dataclass(frozen=True, slots=True, eq=False)
class Rooms:
    """The rooms of a floor; an edit returns new ones.

    ``labels`` is int16 [rows, columns] over ``frame``: 0 for no room, and 1, 2 ... for the rooms,
    without gaps; ``names[label - 1]`` is a room's name, and no two are the same.
    """

    frame: GridFrame
    labels: NDArray[np.int16]
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        """Check that labels, frame and names fit together. Raises RoomsError."""
        if self.labels.shape != self.frame.shape:
            raise RoomsError(
                f"expected room labels of shape {self.frame.shape}, got {self.labels.shape}; "
                "give the frame of the map that the rooms were made for"
            )
        found = np.unique(self.labels[self.labels != 0]).tolist()
        if found != list(range(1, len(self.names) + 1)):
            raise RoomsError(
                f"expected cells for each label from 1 to {len(self.names)}, one a name, got cells "
                f"for {found}; leave out rooms without cells"
            )
        for index, name in enumerate(self.names):
            if fault := fault_of_name(name):
                raise RoomsError(f"a room: {fault}; name every room")
            if name in self.names[:index]:
                raise RoomsError(
                    f"expected different names, got {name!r} twice; rename one of the rooms"
                )

    @classmethod
    def from_outlines(
        cls,
        frame: GridFrame,
        free: NDArray[np.bool_],
        outlines: Sequence[tuple[str, shapely.Geometry]],
    ) -> Rooms:
        """Return the rooms that outlines, m, enclose: their free cells, bool [rows, columns].

        The inverse of :meth:`outline`, exactly. Raises RoomsError for outlines that overlap or
        enclose no free cell, and for names that are not different.
        """
        if free.shape != frame.shape:
            raise RoomsError(
                f"expected free cells of shape {frame.shape}, got {free.shape}; give those of the "
                "frame's own map"
            )
        labels = np.zeros(frame.shape, np.int16)
        for label, (name, outline) in enumerate(outlines, 1):
            cells = cells_inside(outline, frame) & free
            taken = labels[cells]
            if taken.size == 0:
                raise RoomsError(
                    f"expected free floor in room {name!r}, got none; draw its outline inside of "
                    "the map, or remove it"
                )
            if taken.any():
                other = outlines[int(taken.max()) - 1][0]
                raise RoomsError(
                    f"expected rooms apart from each other, got {other!r} and {name!r} that "
                    f"overlap by {np.count_nonzero(taken)} cells; draw one of them smaller"
                )
            labels[cells] = label
        return cls(frame, labels, tuple(name for name, _ in outlines))

    def label_of(self, name: str) -> int:
        """Return a room's label, 1 or more. Raises RoomsError if no room has this name."""
        if name in self.names:
            return self.names.index(name) + 1
        asked = name[:LONGEST_NAME]
        near = difflib.get_close_matches(asked, self.names, 1)
        advice = f"did you mean {near[0]!r}?" if near else "choose one of them"
        known = listed([repr(known) for known in self.names]) if self.names else "no rooms"
        raise RoomsError(f"expected a room out of {known}, got {asked!r}; {advice}")

    def at(self, x: float, y: float) -> int:
        """Return the label of the room in which a point lies, m; 0 for none, and off the map."""
        if not self.frame.contains(x, y):
            return 0
        return int(self.labels[self.frame.cell_of(x, y)])

    def area(self, label: int) -> float:
        """Return the free floor of a room, m²."""
        return float(np.count_nonzero(self._cells(label))) * self.frame.resolution**2

    def anchor(self, label: int) -> Point:
        """Return the point of a room that is farthest from the room's border, m."""
        cells = self._cells(label)
        rows, columns = np.flatnonzero(cells.any(axis=1)), np.flatnonzero(cells.any(axis=0))
        around = np.pad(cells[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1], 1)
        inside = distance_to_nearest(~around)
        row, column = np.unravel_index(int(np.argmax(inside)), inside.shape)
        return self.frame.centre_of(int(rows[0] + row - 1), int(columns[0] + column - 1))

    def outline(self, label: int) -> shapely.Polygon | shapely.MultiPolygon:
        """Return the border of a room, m, along the sides of its cells, with holes."""
        return outline_of(self._cells(label), self.frame)

    def doorways(self) -> tuple[RoomDoorway, ...]:
        """Return where rooms touch, one doorway for each opening, sorted by the rooms' labels."""
        touching = contacts(self.labels.astype(np.int32))
        size = self.frame.resolution
        found = []
        for opening in np.unique(touching[:, 4]).tolist():
            cells = touching[touching[:, 4] == opening]
            first, second = cells[0, :2].tolist()
            row, column = cells[:, 2:4].mean(axis=0).tolist()
            length = float(np.hypot(*np.ptp(cells[:, 2:4], axis=0))) + 1.0
            found.append(
                RoomDoorway(first, second, *self.frame.centre_of(row, column), length * size)
            )
        return tuple(sorted(found, key=lambda door: (door.first, door.second, door.x, door.y)))

    def renamed(self, name: str, new_name: str) -> Rooms:
        """Return the rooms with one of them renamed. Raises RoomsError."""
        index, new = self.label_of(name) - 1, new_name.strip()
        if new != name and new in self.names:
            raise RoomsError(f"there is a room {new!r} already; choose another name")
        names = (*self.names[:index], new, *self.names[index + 1 :])
        return replace(self, names=names)

    def joined(self, *names: str) -> Rooms:
        """Return the rooms with some joined to one, by the first's name. Raises RoomsError.

        The rooms must touch: each must be reached from each other through these rooms alone.
        """
        chosen = [self.label_of(name) for name in dict.fromkeys(names)]
        if len(chosen) < 2:
            raise RoomsError(
                f"expected two or more rooms to join, got {len(chosen)}; choose another one, too"
            )
        if not rooms_edits.are_touching(self.labels, chosen):
            listed = ", ".join(repr(name) for name in names)
            raise RoomsError(
                f"expected rooms that touch, got {listed}; join also the rooms between them"
            )
        gone = set(chosen[1:])
        left = tuple(name for label, name in enumerate(self.names, 1) if label not in gone)
        return Rooms(self.frame, rooms_edits.joined(self.labels, chosen), left)

    def split(self, name: str, start: Point, end: Point) -> Rooms:
        """Return the rooms with one cut along a straight line between two points, m.

        The largest piece keeps the name "X", the others are called "X 2", "X 3" ... A part smaller
        than :data:`SMALLEST_PIECE` goes to the piece beside it. Raises RoomsError if the line does
        not cut the room.
        """
        label = self.label_of(name)
        line = line_on(self.frame, start, end)
        least = max(1, round(SMALLEST_PIECE / self.frame.resolution**2))
        labels = None if line is None else rooms_edits.split(self.labels, label, line, least)
        if labels is None:
            raise RoomsError(
                f"expected a line that cuts {name!r} into pieces of {SMALLEST_PIECE} m² or more, "
                f"got one from ({start[0]:g}, {start[1]:g}) to ({end[0]:g}, {end[1]:g}) that does "
                "not; draw it across the room, from wall to wall"
            )
        names = list(self.names)
        for _ in range(int(labels.max()) - len(names)):
            names.append(another_name(name, names))
        return Rooms(self.frame, labels, tuple(names))

    def _cells(self, label: int) -> NDArray[np.bool_]:
        if not 1 <= label <= len(self.names):
            raise RoomsError(
                f"expected a label from 1 to {len(self.names)}, got {label}; ask label_of() for it"
            )
        cells: NDArray[np.bool_] = self.labels == label
        return cells


def segment(occupancy: OccupancyMap, config: RoomsConfig | None = None) -> Rooms:
    """Return the rooms of a map as a person would cut it, at doorways; "Room 1" is the largest.

    A room is free cells (value 0) that are connected over sides. Specks, corners that no robot
    reaches, and floor that a scan saw through windows are in no room. Bormann et al., "Room
    Segmentation: Survey, Implementation, and Analysis" (2016), compare methods, and say how they
    are scored.
    """
    labels = room_labels(occupancy, config or RoomsConfig())
    names = tuple(f"Room {number}" for number in range(1, int(labels.max(initial=0)) + 1))
    return Rooms(occupancy.frame, labels, names)
