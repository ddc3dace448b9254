"""The page over robots that people own, made up at the end of a line, in real time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.bridges.openneato_mock import OpenNeatoMock, openneato_mock
from fixtures.pages.windows import Windows
from fixtures.robots.faulty_end import FaultyEnd
from fixtures.robots.neato_rig import NEATO, NeatoEnd, neato_world
from fixtures.waiting import wait_until
from playwright.sync_api import Page
from web.conftest import SIZES, Opened, page_at, serving

from roomba.commands.play.owned import OwnedLife
from roomba.configuration.robot import load_robot_config
from roomba.drivers.neato.bridge_remote import BridgeRemote
from roomba.drivers.neato.bridge_requests import BridgeAddress
from roomba.drivers.robots.table import ROBOTS
from roomba.headless.live.remote.client import RemoteClient
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token

DEADLINE = 20.0
"""s of wall time."""
PATIENCE = 20_000
"""ms."""


@pytest.fixture
def neato(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[NeatoEnd]:
    monkeypatch.setenv("ROOMBA_MAPS", str(tmp_path / "maps"))
    made = NeatoEnd(FaultyEnd(tmp_path / "neato"), neato_world())
    yield made
    made.close()


@pytest.fixture
def owned(windows: Windows, neato: NeatoEnd, tmp_path: Path) -> Iterator[Opened]:
    told: list[str] = []
    life = OwnedLife(ROBOTS["neato"], str(tmp_path / "neato"), makes_map=False, tell=told.append)
    life.client.start()
    guard = Guard(new_token())
    with (
        serving(create_app(life.client, guard)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", SIZES["desktop"]) as page,
    ):
        opened = Opened(page, life.client, server, guard)
        opened.wait_for_phase("docked")
        yield opened
    life.end()
    assert not told


def test_it_is_commanded_and_what_is_wrong_with_its_line_is_told(
    owned: Opened, neato: NeatoEnd
) -> None:
    page = owned.page
    assert isinstance(neato.end, FaultyEnd)
    page.get_by_role("button", name="Clean all").click()
    owned.wait_for_phase("undocking")
    neato.end.unplug()
    page.get_by_text("Cannot reach the robot").first.wait_for(timeout=20_000)
    page.get_by_text("it goes on by itself").first.wait_for(timeout=20_000)
    neato.end.plug()
    page.get_by_text("Leaving its station").first.wait_for(timeout=20_000)
    page.get_by_role("button", name="Stop", exact=True).click()
    owned.wait_for_phase("docked")
    page.locator("#locate").evaluate("button => button.click()")
    wait_until(lambda: neato.robot.sound == 3, DEADLINE, "a beep")
    wait_until(lambda: not neato.moves, DEADLINE, "it stands")
    # A real home has no hands that play, and no camera.
    assert not page.get_by_text("Show the truth").is_visible()


@pytest.fixture
def mock() -> Iterator[OpenNeatoMock]:
    with openneato_mock() as made:
        yield made


@pytest.fixture
def remote_page(windows: Windows, mock: OpenNeatoMock) -> Iterator[Page]:
    config = load_robot_config(NEATO)
    remote = BridgeRemote(BridgeAddress.of(mock.address), config.lidar)
    client, guard = RemoteClient("openneato", remote, config), Guard(new_token())
    client.start()
    with (
        serving(create_app(client, guard)) as server,
        page_at(windows, f"{server.address}#token={guard.token}", SIZES["desktop"]) as page,
    ):
        yield page
    client.end()


def test_its_state_is_shown_and_what_it_does_not_tell_is_left_open(
    remote_page: Page, mock: OpenNeatoMock
) -> None:
    page = remote_page
    page.wait_for_selector("body[data-phase='idle']", timeout=PATIENCE)
    assert page.locator("#battery").text_content() == "85 %"
    assert page.locator("#dirt").text_content() == "–"
    # It makes no map that is told, takes no zones, and is not driven by hand.
    page.locator("#draw-no-go").wait_for(state="hidden")
    page.locator("details.drive summary", has_text="Find it").click()
    page.locator("#locate").wait_for()
    for part in ("#no-map", "#rooms-hint", "#drive-pad"):
        assert page.locator(part).is_hidden(), part
    page.get_by_role("button", name="Clean all").click()
    page.wait_for_selector("body[data-phase='cleaning']", timeout=PATIENCE)
    page.locator("#charts").evaluate("charts => { charts.open = true; }")
    page.locator("#chart-rate-title", has_text="Dirt: not known").wait_for(timeout=PATIENCE)
    page.get_by_role("button", name="Stop", exact=True).click()
    page.wait_for_selector("body[data-phase='idle']", timeout=PATIENCE)
    assert not mock.kind
