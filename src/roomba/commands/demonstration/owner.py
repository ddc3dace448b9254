"""What the owner of the robot does on its page: a plan is made, and the page is looked at."""

from __future__ import annotations

import datetime as dt
from typing import Any, Final
from urllib.parse import urldefrag

from roomba.client.page_api import PageApi
from roomba.commands.pictures.page import browser_page, decoded
from roomba.plots.canvas import Picture

_PATIENCE: Final = 20.0
"""s."""
_AHEAD: Final = 20.0
"""s that a plan lies ahead at least."""
_SETTLED: Final = 1500
"""ms until what the page draws has come."""
_WINDOW: Final = {"width": 960, "height": 640}
_REPORT: Final = {"width": 1000, "height": 1250}
"""px."""


class Owner:
    """Uses the page at an address with its token."""

    def __init__(self, address: str) -> None:
        """Open nothing."""
        self._whole = address
        page, fragment = urldefrag(address)
        self._page = page.rstrip("/")
        self._api = PageApi(self._page, fragment.partition("token=")[2], _PATIENCE)

    def plan_clean(self, now: dt.datetime) -> dt.datetime:
        """Make a plan of all floor for the next minute; return when it is due, in UTC."""
        due = next_minute(now)
        self._api.send("household/zone", {"zone": "UTC"}, "PUT")
        order = {"mode": "whole"}
        plan = {"name": "Every day", "at": [f"{due:%H:%M}"], "order": order}
        self._api.send("plans", plan, "PUT")
        return due

    def runs(self) -> list[dict[str, Any]]:
        """Return the runs that are kept, the newest first."""
        found: list[dict[str, Any]] = self._api.get("api/v1/history")["runs"]
        return found

    def notes(self) -> list[dict[str, Any]]:
        """Return what became of plans, the newest first."""
        found: list[dict[str, Any]] = self._api.get("api/v1/plans")["notes"]
        return found

    def look(self) -> Picture:
        """Return the page as it is now."""
        with browser_page(_WINDOW, color_scheme="light") as page:
            page.goto(self._whole)
            page.wait_for_selector("body[data-phase]")
            page.wait_for_timeout(_SETTLED)
            return decoded(page.screenshot())

    def look_at_report(self, number: int) -> Picture:
        """Return the report of a run."""
        with browser_page(_REPORT, color_scheme="light") as page:
            page.goto(f"{self._page}/api/v1/history/{number}/report.html")
            page.wait_for_timeout(_SETTLED)
            return decoded(page.screenshot())


def next_minute(now: dt.datetime) -> dt.datetime:
    """Return the next full minute that is far enough ahead for a plan to be made."""
    ahead = now + dt.timedelta(seconds=_AHEAD)
    return ahead.replace(second=0, microsecond=0) + dt.timedelta(minutes=1)
