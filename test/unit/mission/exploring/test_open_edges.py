"""What an exploration reports of places where its map still ends."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from roomba.configuration.mission import MissionConfig
from roomba.geometry import Point
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.exploring.open_edges import GivenUp, open_edges, what_is_not_seen
from roomba.vocabulary import EdgeReason, OpenEdge

CONFIG = MissionConfig().exploring
CELL = 0.05


def room(*openings: tuple[float, float]) -> OccupancyMap:
    """A room of 4 x 4 m from (0, 0) on; its wall x = 4 is open from y to y, m, to the unknown."""
    values = np.full((120, 120), UNKNOWN, np.int8)
    values[19:101, 19:101] = OCCUPIED
    values[20:100, 20:100] = FREE
    made = OccupancyMap(GridFrame(CELL, -1.0, -1.0, 120, 120), values)
    for low, high in openings:
        rows = slice(made.frame.cell_of(0.0, low)[0], made.frame.cell_of(0.0, high)[0])
        values[rows, 100] = FREE
    return made


WIDE, DOOR = (4.0, 2.0), (4.0, 0.5)


def looked_at(place: Point) -> GivenUp:
    return GivenUp(place, 0.6, was_looked_at=True)


def passed(place: Point) -> GivenUp:
    return GivenUp(place, 0.0, was_looked_at=False)


def test_open_edges_are_told_with_their_length_and_reason_the_longest_first() -> None:
    edges = open_edges(room((0.1, 0.9), (1.0, 3.0)), [passed(DOOR), looked_at(WIDE)], CONFIG)
    assert [(edge.x, edge.y) for edge in edges] == [WIDE, DOOR]
    assert [edge.length for edge in edges] == pytest.approx([2.0, 0.8], abs=2.1 * CELL)
    assert [edge.reason for edge in edges] == [EdgeReason.NO_ECHO, EdgeReason.NOT_LOOKED_AT]


def test_an_edge_that_was_given_up_in_several_places_is_one() -> None:
    below = (4.0, 1.2)
    (edge,) = open_edges(room((1.0, 3.0)), [passed(below), looked_at(WIDE)], CONFIG)
    assert (edge.x, edge.y) == WIDE
    assert edge.reason is EdgeReason.NO_ECHO


def test_what_is_closed_by_now_or_short_is_not_told() -> None:
    assert open_edges(room(), [looked_at(WIDE)], CONFIG) == ()
    assert open_edges(room((1.8, 2.2)), [looked_at(WIDE)], CONFIG) == ()
    assert open_edges(room((1.0, 3.0)), [], CONFIG) == ()


def test_what_was_looked_at_once_stays_so_when_it_is_given_up_for_another_reason() -> None:
    exploration = Exploration(CONFIG)
    exploration.give_up(WIDE, 0.6)
    exploration.give_up(WIDE)
    exploration.give_up(DOOR)
    again = Exploration.of(json.loads(json.dumps(exploration.values())), CONFIG)
    for each in (exploration, again):
        told = what_is_not_seen(each.open_edges(room((0.1, 0.9), (1.0, 3.0))))
        assert re.search(r"at \(4.0, 2.0\) \(it looked there", told)
        assert re.search(r"at \(4.0, 0.5\) \(it got to no place", told)


def test_it_is_told_in_a_sentence() -> None:
    assert what_is_not_seen([]) == ""
    edges = [OpenEdge(3.0 - 0.5 * index, 1.0, 2.0, EdgeReason.NOT_LOOKED_AT) for index in range(5)]
    assert what_is_not_seen(edges[:1]) == (
        "the map is open for 3.0 m at (1.0, 2.0) (it got to no place from which to look there)"
    )
    assert what_is_not_seen(edges).endswith(", for 2.5 m at 2 more")
