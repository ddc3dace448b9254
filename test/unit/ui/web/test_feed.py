"""The way that viewers are shown: what the robot did not drive is no part of it."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from unit.history.seen import HOME, view

from roomba.client.observed import ObservedRobot
from roomba.client.protocol import RobotUnavailableError
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.ui.web.feed import Feed, Place

Looks = Sequence[tuple[float, tuple[float, float] | None]]
"""s and m."""


class Seen:
    """A robot at times and places, s and m; it is not there at a time without a place."""

    def __init__(self, looks: Looks) -> None:
        self._looks = iter(looks)

    def robot(self) -> RobotView:
        time, place = next(self._looks)
        if place is None:
            raise RobotUnavailableError("expected the robot's answer, got none")
        return replace(view(time, "cleaning"), pose=(*place, 0.0))

    def home(self) -> HomeView:
        return HOME

    def layer(self, name: LayerName) -> GridLayer | None:
        return None


def way_of(looks: Looks) -> list[Place]:
    feed = Feed(cast(ObservedRobot, Seen(looks)))

    async def look() -> None:
        for _ in looks:
            await feed.look()

    asyncio.run(look())
    return feed.trail


def test_what_was_driven_is_one_way() -> None:
    looks = [(0.1 * step, (0.05 * step, 0.0)) for step in range(4)]
    assert way_of(looks) == [(0.0, 0.0), (0.05, 0.0), (0.1, 0.0), (0.15, 0.0)]
    # A robot whose time passes quicker drives farther between two looks.
    assert way_of([(0.0, (0.0, 0.0)), (1.0, (0.5, 0.0))]) == [(0.0, 0.0), (0.5, 0.0)]


def test_where_it_was_carried_the_way_begins_anew() -> None:
    looks = [(0.0, (0.0, 0.0)), (0.1, (0.0, 0.6)), (0.2, (0.05, 0.6))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.6, True), (0.05, 0.6)]


def test_after_a_time_in_which_it_was_not_seen_the_way_begins_anew() -> None:
    looks = [(0.0, (0.0, 0.0)), (1.0, None), (60.0, (0.0, 0.9))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.9, True)]
    looks = [(0.0, (0.0, 0.0)), (1.0, None), (2.0, (0.0, 0.1))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.1)]


def test_a_clock_that_begins_anew_begins_a_way() -> None:
    looks = [(100.0, (0.0, 0.0)), (0.1, (0.4, 0.0))]
    assert way_of(looks) == [(0.0, 0.0), (0.4, 0.0, True)]
