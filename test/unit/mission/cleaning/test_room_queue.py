"""Rooms that a clean under way has still to do: what is kept, dropped, added and done again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.grid import GridFrame
from roomba.mission.cleaning.room_queue import (
    changed_request,
    changed_stages,
    queue_of,
    renamed_rooms,
    with_renamed,
)
from roomba.mission.cleaning.stages import Stage
from roomba.perception.rooms.rooms import Rooms
from roomba.vocabulary import CleanMode, FanLevel, RoomWay

Mask = NDArray[np.bool_]
ROOMS = ("a", "b", "c", "d")
NOTHING = np.zeros((1, 5), np.bool_)


def floor_of(name: str) -> Mask:
    """Each room is one cell."""
    floor = NOTHING.copy()
    floor[0, ROOMS.index(name)] = True
    return floor


def parts_of(name: str) -> list[Stage]:
    return [Stage(name, floor_of(name))]


def request_for(names: Sequence[str], passes: int = 1) -> CleanRequest:
    return CleanRequest(CleanMode.ROOMS, rooms=tuple(names), passes=passes, in_order=True)


def stages_for(names: Sequence[str], passes: int = 1) -> list[Stage]:
    return [Stage(name, floor_of(name), again=k > 0) for k in range(passes) for name in names]


def changed(
    names: Sequence[str],
    before: str = "abc",
    number: int = 1,
    passes: int = 1,
    swept: Mask = NOTHING,
    each: Sequence[RoomWay] = (),
) -> tuple[list[tuple[str, bool]], int]:
    """Return names of the stages and whether they are done again, and the present one's number."""
    request, stages = request_for(before, passes), stages_for(before, passes)
    done = {stage.name for stage in stages[:number]}
    after = changed_request(request, done, names, each)
    found, now = changed_stages(request, after, names, stages, number, swept, parts_of)
    assert queue_of(after, found[now:]) == tuple(names)
    return [(stage.name, stage.again) for stage in found], now


def test_the_order_is_another_one_and_the_present_room_goes_on() -> None:
    assert changed("bc") == ([("a", False), ("b", False), ("c", False)], 1)
    assert changed("bdc") == ([("a", False), ("b", False), ("d", False), ("c", False)], 1)


def test_the_present_stage_is_the_very_same_one_while_it_is_the_first() -> None:
    request, stages = request_for("abc"), stages_for("abc")
    after = changed_request(request, {"a"}, "bd", ())
    found, number = changed_stages(request, after, "bd", stages, 1, NOTHING, parts_of)
    assert found[number] is stages[1]


def test_a_room_that_comes_later_keeps_what_is_clean_of_it() -> None:
    assert changed("cb") == ([("a", False), ("c", False), ("b", False)], 1)


def test_a_present_room_that_is_left_out_leaves_what_was_swept_of_it() -> None:
    swept = floor_of("b")
    request, stages = request_for("abc"), stages_for("abc")
    after = changed_request(request, {"a"}, "c", ())
    found, number = changed_stages(request, after, "c", stages, 1, swept, parts_of)
    assert [stage.name for stage in found] == ["a", "", "c"]
    assert number == 2
    assert np.array_equal(found[1].floor, swept)
    assert after.rooms == ("a", "c")


def test_a_room_that_is_done_is_done_again_when_it_is_added() -> None:
    assert changed("bca") == ([("a", False), ("b", False), ("c", False), ("a", True)], 1)


def test_passes_that_are_left_stay_left_and_first_passes_come_first() -> None:
    # Of two passes "a" has had its first, and "b" is in it.
    found, number = changed("bda", before="ab", number=1, passes=2)
    assert number == 1
    assert found[1:] == [("b", False), ("d", False), ("a", True), ("b", True), ("d", True)]


def test_each_room_may_have_a_way_of_its_own() -> None:
    ways = (RoomWay(1), RoomWay(2, FanLevel.STRONG))
    after = changed_request(request_for("abc"), {"a"}, "bd", ways)
    assert after.way_of("d") == RoomWay(2, FanLevel.STRONG)
    assert after.way_of("a") == RoomWay(1, FanLevel.STANDARD)
    found, _ = changed("bd", each=ways)
    assert found == [("a", False), ("b", False), ("d", False), ("d", True)]


def test_what_is_no_room_comes_last() -> None:
    request, zone = request_for("ab"), Stage("what was a zone before", floor_of("d"))
    stages = [*stages_for("ab"), zone]
    after = changed_request(request, {"a"}, "c", ())
    found, number = changed_stages(request, after, "c", stages, 1, NOTHING, parts_of)
    assert found[-1] is zone
    assert queue_of(after, found[number:]) == ("c",)


@pytest.mark.parametrize(
    ("names", "each", "why"),
    [
        ("", (), "dock ends the clean"),
        ("bb", (), "each room once"),
        ("bc", (RoomWay(),), "for each of the 2 rooms"),
    ],
)
def test_what_makes_no_sense_is_refused(names: str, each: tuple[RoomWay, ...], why: str) -> None:
    with pytest.raises(CleanRefusedError, match=why):
        changed_request(request_for("abc"), {"a"}, names, each)


def test_a_clean_of_all_floor_has_no_rooms_to_change() -> None:
    with pytest.raises(CleanRefusedError, match="of mode whole"):
        changed_request(CleanRequest(), (), "a", ())
    assert queue_of(CleanRequest(), [Stage("", NOTHING)]) == ()


def edges_first(name: str) -> list[Stage]:
    return [Stage(name, floor_of(name)), Stage(name, floor_of(name))]


def changed_by_parts(
    names: Sequence[str], number: int, passes: int = 1
) -> tuple[list[Stage], list[tuple[str, bool]]]:
    """Return the stages before, edges first and the middle later, and what comes after a change."""
    request = request_for("ab", passes)
    stages = [
        Stage(part.name, part.floor, again=k > 0)
        for k in range(passes)
        for name in "ab"
        for part in edges_first(name)
    ]
    done = {stage.name for stage in stages[:number]}
    after = changed_request(request, done, names, ())
    found, now = changed_stages(request, after, names, stages, number, NOTHING, edges_first)
    assert found[now] is stages[number] or stages[number].name != names[0]
    return stages, [(stage.name, stage.again) for stage in found[now:]]


def test_the_middle_of_a_room_is_left_while_its_edges_are_under_way() -> None:
    _, left = changed_by_parts("abc", 0)
    assert left == [(name, False) for name in "aabbcc"]


def test_edges_that_are_done_are_not_done_again() -> None:
    _, left = changed_by_parts("ab", 1)
    assert left == [(name, False) for name in "abb"]


def test_parts_of_a_room_are_not_counted_as_passes() -> None:
    _, left = changed_by_parts("ab", 1, passes=2)
    assert left == [("a", False), ("b", False), ("b", False)] + [(name, True) for name in "aabb"]
    _, left = changed_by_parts("ab", 5, passes=2)
    assert left == [("a", True), ("b", True), ("b", True)]


def rooms_of(labels: Sequence[int], *names: str) -> Rooms:
    return Rooms(GridFrame(1.0, 0.0, 0.0, 1, len(labels)), np.array([labels], np.int16), names)


def test_a_room_with_another_name_and_the_same_cells_was_renamed() -> None:
    before = rooms_of((1, 1, 2, 3, 3), "hall", "den", "bath")
    after = rooms_of((3, 3, 2, 1, 0), "bathroom", "den", "corridor")
    assert renamed_rooms(before, after) == {"hall": "corridor"}
    asked = with_renamed(request_for(("den", "hall")), {"hall": "corridor"})
    assert asked.rooms == ("den", "corridor")


def test_a_room_that_was_joined_to_another_one_was_not_renamed() -> None:
    before = rooms_of((1, 1, 2, 2, 2), "hall", "den")
    assert renamed_rooms(before, before.joined("hall", "den")) == {}
    assert renamed_rooms(before, None) == {}
