"""A picture of ``./roomba top`` while a robot cleans, drawn by a browser out of what it shows."""

from __future__ import annotations

import asyncio
import re
import time
from typing import Final

from roomba.commands.pictures.page import browser_page, decoded, served
from roomba.errors import RoombaError
from roomba.plots.canvas import Picture
from roomba.ui.top.app import TopApp
from roomba.ui.top.link import PageLink
from roomba.world.home.home import Home

_SPEED: Final = 60.0
"""The robot's seconds per second."""
_CLEANED: Final = 6.0
"""m2 that are clean in the picture."""
_DEADLINE: Final = 90.0
"""s of wall time until so much is clean."""
_SIZE: Final = (130, 42)
"""Columns and rows of the terminal."""
_WIDTH: Final = 1200
"""px of the picture."""
_FONTS: Final = re.compile(r"@font-face\s*\{.*?\}", re.DOTALL)
"""The drawing's fonts: they are on another machine, and this machine's own will do."""


def picture_of_top(home: Home) -> Picture:
    """Return the terminal: a key let the robot clean, and it has begun."""
    with served(home, _SPEED) as (server, guard):
        port = int(server.address.rsplit(":", 1)[1].strip("/"))
        drawing = asyncio.run(_drawn(TopApp(PageLink(port, guard.token))))
    with browser_page({"width": _WIDTH, "height": _WIDTH}) as page:
        page.set_content(
            f"<style>body{{margin:0}}svg{{display:block;width:{_WIDTH}px}}</style>"
            + _FONTS.sub("", drawing).replace("Fira Code", "DejaVu Sans Mono")
        )
        return decoded(page.locator("svg").first.screenshot())


async def _drawn(app: TopApp) -> str:
    """Let the robot clean by a key of the view; return what it shows then, as SVG."""
    async with app.run_test(size=_SIZE) as pilot:
        is_told = False
        ends = time.monotonic() + _DEADLINE
        while app.link.state.get("vacuum", {}).get("covered", 0.0) < _CLEANED:
            if time.monotonic() > ends:
                raise RoombaError(f"expected {_CLEANED:g} m2 to be clean within {_DEADLINE:g} s")
            if app.link.may_change and app.link.state and not is_told:
                is_told = True
                await pilot.press("c")
            await pilot.pause(0.1)
        app.look()
        await pilot.pause()
        return app.export_screenshot()
