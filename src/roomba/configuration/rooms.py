"""Sizes that decide where a floor is cut into rooms: ``configuration/rooms.yaml``."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.frozen import Frozen, Ratio

Length = Annotated[float, Field(gt=0.0, le=10.0, allow_inf_nan=False)]
Area = Annotated[float, Field(gt=0.0, le=100.0, allow_inf_nan=False)]


class RoomsConfig(Frozen):
    """Sizes of what is built and of what stands in homes; lengths in m, areas in m².

    ``narrowest_door``, ``widest_door``
        Clear widths of doorways: leaves of homes are 0.6 to 1.0 m wide, and half of a double door
        more; 0.1 m of the narrowest is left to the noise of scans.
    ``narrowing``
        What has the width of a door and lies between the ends of two walls is a doorway. An opening
        that is wider than ``widest_double_door`` has to be narrow against the floor on both sides
        as well: at most this share of its width. People see a room of its own up to about two
        thirds.
    ``widest_double_door``, ``door_to_corridor``
        A corridor may be hardly wider than the doors that lead to it. Between two walls an opening
        up to the width of a double door, and where a wall ends on one side alone, as in a corner,
        one up to ``widest_door`` counts when it has at most this share of the floor's width.
    ``deepest_passage``, ``deep_narrowing``
        A passage that is deeper than walls are thick, through the wall of an old house or between
        built-in cupboards, counts up to this depth, if it is as narrow as a door and has at most
        this share of the floor's width on both sides.
    ``thickest_wall``, ``jamb``
        What distinguishes a wall's end from furniture that stands in the way: going through the
        opening, the floor widens again, by ``jamb`` or more, within the thickness of a wall.
        Bearing walls of old houses have 0.5 m with plaster; most furniture is deeper.
    ``furniture_size``
        What stands free and is no longer than this is no wall: legs, chairs, plants, small
        tables. The piece of wall between two doors is longer.
    ``tightest_passage``
        Through what is narrower no robot gets, and it is no doorway: cracks of scanned walls.
    ``roughness``
        Differences of the distance to the walls that mean nothing: two cells of a usual map.
    ``reach``
        How far floor that is narrower than ``tightest_passage`` belongs to the room that it
        borders on; further out are rays of a scan through gaps and windows.
    ``smallest_room``
        What is smaller belongs to the neighbour with the widest opening: a toilet has 1.0 x 1.5 m.
    ``most_unknown``
        The share of a room's outline that may border on what was never seen. Rooms end at walls;
        what ends at nothing is outdoors, seen through a window, or not surveyed yet. On a map whose
        floor as a whole ends at more of it no walls are drawn, and nothing is left out.
    """

    narrowest_door: Length = 0.5
    widest_door: Length = 1.3
    narrowing: Ratio = 0.7
    widest_double_door: Length = 1.8
    door_to_corridor: Ratio = 0.9
    deepest_passage: Length = 1.3
    deep_narrowing: Ratio = 0.35
    thickest_wall: Length = 0.6
    jamb: Length = 0.3
    furniture_size: Length = 1.0
    tightest_passage: Length = 0.3
    roughness: Length = 0.1
    reach: Length = 0.3
    smallest_room: Area = 1.5
    most_unknown: Ratio = 0.6

    in_order: ClassVar[tuple[str, ...]] = (
        "tightest_passage <= narrowest_door < widest_door <= widest_double_door",
        "thickest_wall <= deepest_passage",
        "deep_narrowing <= narrowing <= door_to_corridor",
    )
