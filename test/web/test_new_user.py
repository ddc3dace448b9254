"""A new user's way, as the documents tell it: the command, the printed address, a phone."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fixtures.pages.windows import Windows
from fixtures.waiting import wait_until
from playwright.sync_api import Page
from web.conftest import PIXELS, SIZES

PAGE = Path(__file__).parents[2] / "docs" / "page.md"
STEPS = (
    "On its station, ready", "Clean 2 rooms", "Pause", "Go on", "Stop", "More", "History", "Report",
)  # fmt: skip
"""What the page says and offers on this way, in its own words."""
PROMISED = 300.0
"""s of wall time for all of it."""
MET = 60_000
"""ms of wall time for one step."""
DOUBLE = 1000
"""ms within which two taps on a button are one double tap, which means the first one alone."""
ANCHORS = "async () => (await import('/store.js')).get('home')?.rooms.map((room) => room.anchor)"
IS_SWEPT = """async () => {
    const { grid } = await import("/map/grids.js");
    return grid("coverage")?.cells.some((value) => value > 0);
}"""
OTHER = "127.0.0.9"
"""Of this machine as well, and not where a page is by default."""


@contextmanager
def playing(folder: Path, *words: str) -> Iterator[str]:
    """Run the command as a user types it; give the one address that it printed."""
    with subprocess.Popen(
        [
            sys.executable,
            "-m",
            "roomba.commands.program",
            "play",
            "--no-open",
            "--port",
            "0",
            *words,
        ],
        stdout=subprocess.PIPE,
        text=True,
        env={
            **os.environ,
            "ROOMBA_HISTORY": str(folder / "history"),
            "ROOMBA_TOKEN_FILE": str(folder / "token"),
        },
    ) as program:
        assert program.stdout is not None
        printed = ""
        try:
            for line in program.stdout:
                printed += line
                if "Ctrl-C" in line:
                    break
            (address,) = re.findall(r"http://\S+#token=\S+", printed)
            yield address
            program.send_signal(signal.SIGINT)
            assert program.wait(20.0) == 0
        finally:
            program.kill()


@contextmanager
def phone(windows: Windows, address: str) -> Iterator[Page]:
    """Open an address in a window of a phone."""
    with windows.lent(SIZES["phone"], has_touch=True, motion="no-preference") as page:
        page.set_default_timeout(MET)
        page.goto(address)
        page.get_by_text(STEPS[0]).wait_for()
        yield page


def test_from_the_command_to_the_report_in_five_minutes(windows: Windows, tmp_path: Path) -> None:
    told = PAGE.read_text("utf-8").split("## The first five minutes")[1].split("\n## ")[0]
    assert tuple(re.findall("“([^”]+)”", told)) == STEPS
    assert "`./roomba play`" in told
    began = time.monotonic()
    with playing(tmp_path) as address, phone(windows, address) as page:
        wait_until(lambda: page.evaluate(ANCHORS), MET / 1000, "rooms")
        for anchor in page.evaluate(ANCHORS)[:2]:
            page.touchscreen.tap(*page.evaluate(PIXELS, anchor))
        page.get_by_role("button", name=STEPS[1]).tap()
        wait_until(lambda: page.evaluate(IS_SWEPT), MET / 1000, "swept floor")
        page.get_by_role("button", name=STEPS[2]).tap()
        page.wait_for_selector("body[data-phase='paused']")
        page.wait_for_timeout(DOUBLE)
        page.get_by_role("button", name=STEPS[3]).tap()
        page.wait_for_selector("body[data-phase='cleaning']")
        page.get_by_role("button", name=STEPS[4], exact=True).tap()
        page.wait_for_selector("body[data-phase='idle']")
        page.get_by_role("button", name=STEPS[5]).tap()
        page.locator("#last-text").get_by_text("Stopped").wait_for()
        page.get_by_role("button", name=STEPS[6]).tap()
        with page.context.expect_page() as opened:
            page.get_by_role("link", name=STEPS[7]).tap()
        report = opened.value
        assert report.inner_text("h1").startswith("Run 1: flat, ")
        assert "Stopped" in report.inner_text("main")
        assert '"mode": "rooms"' in report.inner_text("pre >> nth=1")
    assert time.monotonic() - began < PROMISED


def test_at_another_address_it_is_seen_and_commanded_as_well(
    windows: Windows, tmp_path: Path
) -> None:
    with playing(tmp_path, "--home", "studio", "--host", OTHER) as address:
        assert address.startswith(f"http://{OTHER}:")
        with phone(windows, address) as page:
            page.get_by_role("button", name="Clean all").tap()
            page.wait_for_selector("body[data-phase='cleaning']")
