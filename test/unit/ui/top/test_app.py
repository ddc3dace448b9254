"""The full-screen view over real servers: what it shows, what its keys do, and its end."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine, Iterator
from dataclasses import replace
from typing import Any

import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot
from textual.pilot import Pilot
from textual.widgets import DataTable, RichLog, Static

from roomba.commands.play.living import live_client
from roomba.ui.top.app import TopApp
from roomba.ui.top.link import PageLink
from roomba.ui.top.rates import Rate
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen

TOKEN = "the-token"
SIZE = (120, 40)


class Page:
    """The page of a robot, which can be stopped and served again at the same port."""

    def __init__(self, robot: Any) -> None:
        self.robot, self.port = robot, 0
        self.serve()

    def serve(self) -> None:
        bound = listen("127.0.0.1", self.port, is_fixed=True)
        self.port = bound.getsockname()[1]
        self.server = PageServer(create_app(self.robot, Guard(TOKEN)), bound)
        self.server.start()


@pytest.fixture
def page() -> Iterator[Page]:
    """The page of a robot that writes down what it is told."""
    made = Page(WrittenRobot())
    yield made
    made.server.stop()


def with_view(
    port: int, check: Callable[[Pilot[int]], Coroutine[Any, Any, None]], token: str = TOKEN
) -> int | None:
    """Open the view over a page's server, let ``check`` use it; return how it ended, if it did."""
    app = TopApp(PageLink(port, token))

    async def use() -> None:
        async with app.run_test(size=SIZE) as pilot:
            await check(pilot)

    asyncio.run(use())
    return app.return_value


async def until(pilot: Pilot[int], condition: Callable[[], bool], what: str = "") -> None:
    """Wait until the view shows something; fails after 30 s of wall time."""
    deadline = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < deadline, f"{what}\n{shown(pilot)}\n{log_of(pilot)}"
        await pilot.pause(0.02)


def shown(pilot: Pilot[int], panel: str = "state") -> str:
    return str(pilot.app.query_one(f"#{panel}", Static).content)


def log_of(pilot: Pilot[int]) -> str:
    return "\n".join(line.text for line in pilot.app.query_one("#log", RichLog).lines)


def test_it_shows_the_state_the_map_and_what_changes(page: Page) -> None:
    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "cleaning, in hall" in shown(pilot))
        assert "1.0 of 4.0 m² (25 %)" in shown(pilot)
        await until(pilot, lambda: "." in shown(pilot, "map"), "the map")
        panel = pilot.app.query_one("#map")
        assert panel.size.height > 20
        assert panel.size.width > 50
        vacuum = replace(VIEW.vacuum, state="error", phase="stuck", message="both wheels spin")
        page.robot.view = replace(VIEW, vacuum=vacuum, held="a hand")
        await until(pilot, lambda: "both wheels spin" in shown(pilot))
        await until(pilot, lambda: "trouble: both wheels spin" in log_of(pilot))
        assert "held: a hand" in log_of(pilot)

    with_view(page.port, check)


def test_its_keys_command_the_robot(page: Page) -> None:
    told = page.robot.told

    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "cleaning" in shown(pilot) and "keys" not in shown(pilot))
        for key, name in (("c", "clean"), ("p", "pause"), ("d", "dock"), ("s", "stop")):
            await pilot.press(key)
            await until(pilot, lambda name=name: told[-1:] and told[-1][0] == name, name)  # type: ignore[misc]
        await pilot.press("l")
        await until(pilot, lambda: told[-1] == ("locate", ()))
        await pilot.press("up")
        await until(pilot, lambda: told[-1] == ("drive", (0.25, 0.0)), "ahead")
        await pilot.press("left")
        await until(pilot, lambda: told[-1][1][0] == 0.0 and told[-1][1][1] > 1.0, "to the left")
        await pilot.press("space")
        await until(pilot, lambda: told[-1] == ("emergency_stop", ("a key of ./roomba top",)))
        vacuum = replace(VIEW.vacuum, state="paused", phase="paused")
        page.robot.view = replace(VIEW, vacuum=vacuum, held="a key")
        await until(pilot, lambda: "held" in shown(pilot))
        await pilot.press("space")
        await until(pilot, lambda: told[-1] == ("release", ()))
        await pilot.press("p")
        await until(pilot, lambda: told[-1] == ("resume", ()))
        assert "refused" not in log_of(pilot)

    with_view(page.port, check)


def test_what_is_refused_is_told_in_the_robot_s_sentence(page: Page) -> None:
    page.robot.refusal = "the battery is empty"

    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "cleaning" in shown(pilot) and "keys" not in shown(pilot))
        await pilot.press("c")
        await until(pilot, lambda: "refused: the battery is empty" in log_of(pilot))
        await pilot.press("up")
        await until(pilot, lambda: log_of(pilot).count("the battery is empty") == 2)

    with_view(page.port, check)
    assert page.robot.told == []


@pytest.mark.parametrize("token", ["", "a-wrong-one"])
def test_without_the_token_one_can_only_look(page: Page, token: str) -> None:
    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "only look" in shown(pilot))
        for key in ("c", "up"):
            await pilot.press(key)
        await until(pilot, lambda: log_of(pilot).count("refused: ") == 2)
        assert log_of(pilot).count("token") == 2

    with_view(page.port, check, token)
    assert page.robot.told == []


def test_a_robot_that_is_gone_and_a_server_that_is_lost_are_told_and_come_back(page: Page) -> None:
    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "cleaning" in shown(pilot))
        page.robot.is_gone = True
        await until(pilot, lambda: "the robot does not answer" in shown(pilot))
        assert "the robot's program has ended" in shown(pilot)
        page.robot.is_gone = False
        await until(pilot, lambda: "does not answer" not in shown(pilot))
        await asyncio.to_thread(page.server.stop)
        await until(pilot, lambda: "the connection was lost" in shown(pilot))
        await asyncio.to_thread(page.serve)
        await until(pilot, lambda: "lost" not in shown(pilot))

    with_view(page.port, check)


def test_topics_are_shown_where_there_is_a_graph(page: Page) -> None:
    async def check(pilot: Pilot[int]) -> None:
        topics = pilot.app.query_one("#topics", DataTable)
        assert not topics.display
        assert isinstance(pilot.app, TopApp)
        pilot.app.show_rates([Rate("/pose", 19.96, 4)])
        assert topics.display
        assert topics.get_row_at(0) == ["/pose", "20.0", "4"]
        pilot.app.show_rates(None)
        assert not topics.display

    with_view(page.port, check)


@pytest.mark.parametrize("key", ["q", "ctrl+d"])
def test_it_ends_by_a_key_and_leaves_the_robot_to_itself(page: Page, key: str) -> None:
    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "cleaning" in shown(pilot))
        await pilot.press(key)

    assert with_view(page.port, check) == 0
    assert page.robot.told == []


def test_a_robot_that_lives_in_a_home_is_sent_and_stopped() -> None:
    robot = live_client("studio", 0, 10.0, knows_map=True)
    robot.start()
    page = Page(robot)

    async def check(pilot: Pilot[int]) -> None:
        await until(pilot, lambda: "docked" in shown(pilot))
        await until(pilot, lambda: "█" in shown(pilot, "map") and "◀" in shown(pilot, "map"))
        await pilot.press("c")
        await until(pilot, lambda: "▒" in shown(pilot, "map"), "floor that was swept")
        assert "cleaning" in shown(pilot)
        assert "S" in shown(pilot, "map")
        await pilot.press("s")
        await until(pilot, lambda: "idle" in shown(pilot))

    try:
        with_view(page.port, check)
    finally:
        page.server.stop()
        robot.end()
