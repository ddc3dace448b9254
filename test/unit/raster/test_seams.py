"""Thin lines within floor and doorways are floor; walls, and openings to the outside, never are."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.raster.seams import without_seams

DOOR = """
aaaaaaaaaaaa
##--------##
.#--------#.
.#--------#.
#.--------.#
bbbbbbbbbbbb
"""
"""Two rooms, and nothing told of the doorway between, whose posts are ragged."""


def found(drawn: str, resolution: float, turned: bool) -> None:
    """Check that the cells ``-`` of a drawing become floor, and nothing else does."""
    marks = np.array([list(line) for line in drawn.split()])
    marks = marks.T if turned else marks
    owners = sum(
        (np.int16(number) * (marks == mark) for number, mark in enumerate("ab", start=1)),
        np.zeros(marks.shape, np.int16),
    )
    result = without_seams(owners, np.isin(marks, (".", "-")), marks == "#", resolution)
    assert np.array_equal(result > 0, np.isin(marks, ("a", "b", "-")))
    assert np.array_equal(result[owners > 0], owners[owners > 0])


@pytest.mark.parametrize("turned", [False, True])
def test_a_doorway_of_which_nothing_is_told_is_floor(turned: bool) -> None:
    found(DOOR, 0.075, turned)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(
    "drawn",
    [
        DOOR.replace("b", "a"),  # a thing within one room
        DOOR.replace("#", "."),  # no posts
        DOOR.replace(".#--------#.", ".##########."),  # a wall across
        "\n".join(line[:3] + line[6:] for line in DOOR.split()),  # narrower than a door
        DOOR.replace("bbbbbbbbbbbb", "............"),  # to the outside
    ],
)
def test_what_is_no_doorway_is_not(drawn: str, turned: bool) -> None:
    found(drawn.replace("-", "."), 0.075, turned)


@pytest.mark.parametrize(("resolution", "is_one"), [(0.075, True), (0.08, False), (0.2, False)])
def test_a_doorway_is_no_deeper_than_a_wall(resolution: float, is_one: bool) -> None:
    drawn = "#aaaaaaaaaa#\n" + 4 * "#----------#\n" + "#bbbbbbbbbb#"
    found(drawn if is_one else drawn.replace("-", "."), resolution, False)


@pytest.mark.parametrize("turned", [False, True])
def test_lines_are_floor_within_and_between_segments(turned: bool) -> None:
    found(
        """
        aaaaaaaaa--bbb--bb...bb.
        aa-----aa--bbb--bb...bb.
        aa-aaa-aa-bbb-bbbb...bb.
        aa-----aa-bbb-bb.#...bb#
        aaaaaaaaa-bbb-bb.#...bb#
        """,
        0.05,
        turned,
    )


def test_a_map_of_one_column_has_no_seams() -> None:
    found("a\n-\na", 0.05, False)
    found("a", 0.05, False)
