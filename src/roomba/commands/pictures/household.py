"""A picture of plans and upkeep on the page, made in a browser."""

from __future__ import annotations

import datetime as dt
import tempfile
from pathlib import Path
from typing import Any, Final

import numpy as np

from roomba.client.household import TotalsView
from roomba.commands.pictures.page import browser_page, decoded, wait_until
from roomba.commands.play.living import live_client
from roomba.configuration.household import HouseholdConfig
from roomba.headless.live.client import LiveClient
from roomba.household.folder import KeptValues
from roomba.household.household import LiveHousehold
from roomba.household.upkeep_keeper import KeptWear
from roomba.plans.plan import Plan, PlannedOrder, Preset, QuietHours
from roomba.plots.canvas import Picture
from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard, new_token
from roomba.ui.web.server import PageServer, listen
from roomba.upkeep.parts import HOUR, Part
from roomba.vocabulary import CleanMode
from roomba.world.home.home import Home

_TALL: Final = {"width": 1100, "height": 2200}
"""px; all of the panel is seen without scrolling."""
_HAS_PLANS: Final = """async () => {
    const { get } = await import("/store.js");
    return Boolean(get("limits") && document.querySelectorAll("#plan-list li").length === 2);
}"""
_GAP: Final = 24
"""px between two windows."""
_SETTLED: Final = 300
"""ms of wall time until what appears has done so."""


def picture_of_household(home: Home) -> Picture:
    """Return plans, their form, and upkeep on the page, beside each other."""
    with tempfile.TemporaryDirectory() as folder:
        robot = live_client(home.name, seed=1, speed=1.0, knows_map=True)
        household = _household(robot, Path(folder))
        guard = Guard(new_token())
        app = create_app(robot, guard, household=household)
        server = PageServer(app, listen("127.0.0.1", 0, is_fixed=True))
        server.start()
        try:
            with browser_page(_TALL) as page:
                page.goto(f"{server.address}#token={guard.token}")
                seen = _seen(page)
        finally:
            server.stop()
            robot.end()
    return _beside(seen)


def _seen(page: Any) -> list[Picture]:
    page.click("#plans > summary")
    page.click("#upkeep > summary")
    wait_until(page, _HAS_PLANS)
    seen = [decoded(page.locator(part).screenshot()) for part in ("#plans", "#upkeep")]
    page.click("[aria-label='Edit Kitchen']")
    page.wait_for_timeout(_SETTLED)
    seen.insert(1, decoded(page.locator("#plan-form").screenshot()))
    return seen


def _household(robot: LiveClient, folder: Path) -> LiveHousehold:
    """Return a household with plans, worn parts, and a clean that waited for the morning."""
    worn = {Part.BRUSH: 104.0, Part.SIDE_BRUSH: 104.0, Part.FILTER: 104.0, Part.SENSORS: 30.0}
    seconds = {part: hours * HOUR for part, hours in worn.items()}
    wear = KeptWear(worked={**seconds, Part.BIN: 0.8 * HOUR}, in_bin=12.0)
    KeptValues(folder / "upkeep.json", print).write(wear)
    clock = [dt.datetime(2026, 3, 2, 5, 0, tzinfo=dt.timezone.utc)]
    household = LiveHousehold(
        robot,
        folder,
        HouseholdConfig(),
        robot.bin_capacity,
        print,
        lambda: TotalsView(152, 4310.0, 374_000.0, 31_900.0, 1240.0, 2900.0),
        now=lambda: clock[0],
    )
    rooms = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen", "hallway"), passes=2)
    household.set_zone("Europe/Berlin")
    household.set_quiet([QuietHours()])
    household.put_plan(
        Plan(name="Kitchen", rule="FREQ=WEEKLY;BYDAY=MO,TH", at=(dt.time(6, 30),), order=rooms)
    )
    household.put_plan(Plan(name="All", rule="FREQ=MONTHLY;BYDAY=1SA", at=(dt.time(10, 0),)))
    household.put_preset(Preset(name="After dinner", order=rooms))
    robot.start()
    for hours, minutes in ((5, 31), (6, 1)):
        clock[0] = clock[0].replace(hour=hours, minute=minutes)
        household.look()
    return household


def _beside(seen: list[Picture]) -> Picture:
    """Return pictures beside each other on white, each from the top on."""
    height = max(len(picture) for picture in seen)
    gap = np.full((height, _GAP, 3), 255, np.uint8)
    parts = [gap]
    for picture in seen:
        padding = ((0, height - len(picture)), (0, 0), (0, 0))
        parts += [np.pad(picture, padding, constant_values=255), gap]
    return np.hstack(parts)
