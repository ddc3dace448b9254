"""The trail of the robot that the feed observes: by its clock, and by the jumps of a recording."""

from __future__ import annotations

import asyncio
import itertools
import threading
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot
from fixtures.waiting import wait_until
from unit.history.seen import HOME, REPORT, SOURCE, view

from roomba.client.observed import ObservedRobot, TimelineView
from roomba.client.protocol import RobotUnavailableError
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.geometry import Point
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunFigures, RunRecording
from roomba.history.under_way import Layers
from roomba.ui.web.app import create_app
from roomba.ui.web.feed import Feed
from roomba.ui.web.guard import Guard
from roomba.ui.web.streams.trail import Place

Look = tuple[float, tuple[float, float] | None]
"""s and m."""


class Seen:
    """A robot at times and places, s and m; it is not there at a time without a place."""

    def __init__(self, looks: Iterable[Look]) -> None:
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


class Recorded(Seen):
    """The same as a recording, in which another time may be chosen."""

    jumps = 0
    driven: Sequence[Point] = ()

    def timeline(self) -> TimelineView:
        return TimelineView(9.0, 1.0, 1.0, is_playing=True, jumps=self.jumps)

    def play(self, *, is_playing: bool) -> None:
        raise NotImplementedError

    def seek(self, at: float) -> None:
        raise NotImplementedError

    def set_speed(self, speed: float) -> None:
        raise NotImplementedError

    def way(self) -> list[Point]:
        return list(self.driven)


def looked(feed: Feed, times: int) -> list[Place]:
    async def look() -> None:
        for _ in range(times):
            await feed.look()

    asyncio.run(look())
    return list(feed.trail.places)


def way_of(looks: Sequence[Look]) -> list[Place]:
    return looked(Feed(cast(ObservedRobot, Seen(looks))), len(looks))


def test_the_trail_goes_by_the_clock_and_the_place_of_the_robot() -> None:
    looks = [(0.0, (0.0, 0.0)), (1.0, (0.5, 0.0)), (1.1, (0.5, 0.6))]
    assert way_of(looks) == [(0.0, 0.0), (0.5, 0.0), (0.5, 0.6, True)]


def test_after_a_time_in_which_it_was_not_seen_the_way_begins_anew() -> None:
    looks = [(0.0, (0.0, 0.0)), (1.0, None), (60.0, (0.0, 0.9))]
    assert way_of(looks) == [(0.0, 0.0), (0.0, 0.9, True)]


def test_another_time_of_a_recording_brings_the_way_up_to_it() -> None:
    robot = Recorded([(0.0, (0.0, 0.0)), (0.1, (3.0, 0.1)), (0.2, (3.0, 0.15))])
    feed = Feed(cast(ObservedRobot, robot))
    assert looked(feed, 1) == [(0.0, 0.0)]
    robot.jumps, robot.driven = 1, [(3.0, 0.0)]
    assert looked(feed, 1) == [(3.0, 0.0), (3.0, 0.1)]
    robot.driven = [(7.0, 7.0)]
    assert looked(feed, 1) == [(3.0, 0.0), (3.0, 0.1), (3.0, 0.15)]


def test_a_look_that_fails_is_told_and_is_not_the_last() -> None:
    robot = Seen([(0.0, (0.0, 0.0)), (1.0, (0.5, 0.0))])
    feed = Feed(cast(ObservedRobot, robot))
    with pytest.MonkeyPatch.context() as answers:
        answers.setattr(robot, "home", lambda: None)
        looked(feed, 1)
    assert feed.state.value["link"] == "gone"
    assert "a look failed: AttributeError" in feed.state.value["reason"]
    looked(feed, 1)
    assert feed.state.value["link"] != "gone"
    assert feed.number == 2


class Mapped(Seen):
    """One with layers, of which the last one comes once it is let go."""

    def __init__(self) -> None:
        super().__init__([(0.0, (0.0, 0.0))])
        self.is_waiting, self.goes_on = threading.Event(), threading.Event()

    def layer(self, name: LayerName) -> GridLayer | None:
        if name is list(LayerName)[-1]:
            self.is_waiting.set()
            assert self.goes_on.wait(10.0)
        return GridLayer(1, 0.05, 0.0, 0.0, np.ones((4, 5), np.uint8))


def test_layers_change_between_two_turns_of_the_viewers_and_not_meanwhile() -> None:
    robot = Mapped()
    feed = Feed(cast(ObservedRobot, robot))

    async def look() -> None:
        looking = asyncio.create_task(feed.look())
        assert await asyncio.to_thread(robot.is_waiting.wait, 10.0)
        assert [layer.since(0) for layer in feed.layers.values()] == [None] * len(LayerName)
        robot.goes_on.set()
        await looking
        assert all(layer.since(0) for layer in feed.layers.values())

    asyncio.run(look())


class Sweeping(Seen):
    """A robot whose layers are full of the number of its look; its run has ended at look 4."""

    def __init__(self) -> None:
        super().__init__((float(time), (0.0, 0.0)) for time in itertools.count())
        self.now = 0

    def robot(self) -> RobotView:
        seen = super().robot()
        self.now = int(seen.time)
        return seen if self.now < 4 else replace(seen, last=REPORT)

    def layer(self, name: LayerName) -> GridLayer | None:
        return GridLayer(1, 0.05, 0.0, 0.0, np.full((4, 5), self.now, np.uint8))


class OnSlowDisk:
    """A keeper whose first look lasts until it is let go."""

    interrupted = None

    def __init__(self) -> None:
        self.goes_on = threading.Event()
        self.seen: list[tuple[int, int]] = []
        """The number of each look, and that of which it has the layers."""

    def look(self, seen: RobotView, _: HomeView, layer: Layers) -> None:
        coverage = layer(LayerName.COVERAGE)
        assert coverage is not None
        self.seen.append((int(seen.time), int(coverage.cells[0, 0])))
        assert self.goes_on.wait(10.0)


def test_viewers_do_not_wait_for_the_disk_of_the_history_and_it_gets_each_look(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("roomba.ui.web.feed.PERIOD", 0.01)
    keeper = OnSlowDisk()
    feed = Feed(cast(ObservedRobot, Sweeping()), cast(HistoryKeeper, keeper))

    async def run() -> None:
        running = asyncio.create_task(feed.run())
        try:
            while feed.number < 9:
                await asyncio.wait_for(feed.newer(feed.number), 5.0)
            assert len(keeper.seen) == 1
        finally:
            keeper.goes_on.set()
            running.cancel()
            await asyncio.wait({running}, timeout=5.0)

    asyncio.run(run())
    assert keeper.seen[:9] == list(enumerate((0, 0, 0, 3, 4, 4, 6, 6, 6)))
    assert len(keeper.seen) == feed.number


def test_the_application_ends_when_the_run_that_ended_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = WrittenRobot()
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    app = create_app(cast(ObservedRobot, robot), Guard("the-token"), keeper)
    add, begins, goes_on = keeper.history.add, threading.Event(), threading.Event()

    def add_slowly(figures: RunFigures, recording: RunRecording | None = None) -> int:
        begins.set()
        assert goes_on.wait(10.0)
        return add(figures, recording)

    monkeypatch.setattr(keeper.history, "add", add_slowly)

    async def live() -> int:
        async with app.router.lifespan_context(app):
            await asyncio.to_thread(wait_until, lambda: list(tmp_path.iterdir()), 5.0)
            robot.view = replace(VIEW, last=REPORT)
            assert await asyncio.to_thread(begins.wait, 10.0)
            asyncio.get_running_loop().call_later(0.02, goes_on.set)
        return len(keeper.history.runs())

    assert asyncio.run(live()) == 1
