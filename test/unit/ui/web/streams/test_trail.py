"""The trail that viewers see: it has no stretch that the robot did not drive."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from roomba.ui.web.streams.trail import Place, ShownTrail

Looks = Sequence[tuple[float, tuple[float, float] | None]]
"""s and m; None where the robot is not seen."""


def way_of(looks: Looks) -> list[Place]:
    return list(followed(looks).places)


def followed(looks: Looks) -> ShownTrail:
    trail = ShownTrail()
    for now, place in looks:
        if place is None:
            trail.lose_sight()
        else:
            trail.follow(now, *place)
    return trail


def told(trail: ShownTrail, count: int) -> tuple[bool, int, list[Place]] | None:
    """Return whether it is told as the whole way, its end, and its places."""
    message = trail.since(count)
    if message is None:
        return None
    assert message.value["type"] == "trail"
    return message.value["whole"], message.value["end"], message.value["points"]


def test_what_was_driven_is_one_way() -> None:
    looks = [(0.1 * step, (0.05 * step, 0.0)) for step in range(4)]
    assert way_of(looks) == [(0.0, 0.0), (0.05, 0.0), (0.1, 0.0), (0.15, 0.0)]
    # A robot whose time passes quicker drives farther between two looks.
    assert way_of([(0.0, (0.0, 0.0)), (1.0, (0.5, 0.0))]) == [(0.0, 0.0), (0.5, 0.0)]


def test_places_are_three_centimetres_apart_at_least() -> None:
    looks = [(0.0, (0.0, 0.0)), (0.1, (0.029, 0.0)), (0.2, (0.0312345, 0.0))]
    assert way_of(looks) == [(0.0, 0.0), (0.031, 0.0)]


def test_where_it_was_carried_the_way_begins_anew() -> None:
    looks = [(0.0, (0.0, 0.0)), (0.1, (0.0, 0.6)), (0.2, (0.05, 0.6))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.6, True), (0.05, 0.6)]


def test_where_it_was_carried_there_and_back_both_are_told() -> None:
    looks = [(0.0, (0.0, 0.0)), (0.1, (0.6, 0.0)), (0.2, (0.0, 0.0))]
    assert way_of(looks) == [(0.0, 0.0), (0.6, 0.0, True), (0.0, 0.0, True)]


def test_after_a_time_in_which_it_was_not_seen_the_way_begins_anew() -> None:
    looks = [(0.0, (0.0, 0.0)), (1.0, None), (60.0, (0.0, 0.9))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.9, True)]
    looks = [(0.0, (0.0, 0.0)), (1.0, None), (2.0, (0.0, 0.1))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.1)]


def test_a_clock_that_begins_anew_begins_a_way() -> None:
    looks = [(100.0, (0.0, 0.0)), (0.1, (0.4, 0.0))]
    assert way_of(looks) == [(0.0, 0.0), (0.4, 0.0, True)]


def test_viewers_are_told_what_is_new_to_them() -> None:
    trail = followed([])
    assert told(trail, 0) is None
    trail.follow(0.0, 0.0, 0.0)
    trail.follow(0.1, 0.05, 0.0)
    assert told(trail, 0) == (True, 2, [(0.0, 0.0), (0.05, 0.0)])
    assert told(trail, 1) == (False, 2, [(0.05, 0.0)])
    assert told(trail, 2) is None


def test_what_is_told_to_many_is_made_once_until_there_is_more() -> None:
    trail = followed([(0.0, (0.0, 0.0))])
    first = trail.since(0)
    assert trail.since(0) is first
    trail.follow(0.1, 0.01, 0.0)
    assert trail.since(0) is first, "no place was added"
    trail.follow(0.2, 0.05, 0.0)
    assert told(trail, 0) == (True, 2, [(0.0, 0.0), (0.05, 0.0)])


def test_another_way_takes_the_place_of_the_one_that_was_shown() -> None:
    trail = followed([(0.0, (0.0, 0.0)), (0.1, (0.05, 0.0))])
    assert told(trail, 2) is None
    trail.replace([(1.0, 1.0), (1.00049, 1.1)])
    assert told(trail, 2) == (True, 5, [(1.0, 1.0), (1.0, 1.1)])
    assert told(trail, 5) is None
    # Where it is then follows on the way up to there, if it is near.
    trail.follow(0.2, 1.0, 1.2)
    trail.follow(0.3, 5.0, 1.2)
    assert told(trail, 5) == (False, 7, [(1.0, 1.2), (5.0, 1.2, True)])


def test_an_empty_way_is_told_once_too() -> None:
    trail = followed([(0.0, (0.0, 0.0))])
    trail.replace([])
    assert told(trail, 1) == (True, 2, [])
    assert told(trail, 2) is None


def test_the_oldest_places_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roomba.ui.web.streams.trail._MOST_PLACES", 3)
    trail = followed([(0.1 * step, (0.05 * step, 0.0)) for step in range(5)])
    kept = [(0.1, 0.0), (0.15, 0.0), (0.2, 0.0)]
    assert list(trail.places) == kept
    assert told(trail, 1) == (True, 5, kept), "one that missed some gets all that is kept"
    assert told(trail, 3) == (False, 5, kept[1:])
    trail.replace([(float(step), 0.0) for step in range(5)])
    assert list(trail.places) == [(2.0, 0.0), (3.0, 0.0), (4.0, 0.0)]
