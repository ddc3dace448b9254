"""A window that is lent finds nothing of what was left in it before."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from fixtures.pages.windows import OwnWindowError, Windows
from playwright.sync_api import Page
from web.conftest import page_at

SIZE = (500, 400)
ROUTED = 299
"""A status that the site below never gives."""


class Site(ThreadingHTTPServer):
    """Pages with nothing in them, which a browser may keep."""

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), Nothing)
        self.address = f"http://127.0.0.1:{self.server_port}/"
        self.asked: list[str] = []


class Nothing(BaseHTTPRequestHandler):
    """Answers with nothing, for long."""

    server: Site

    def do_GET(self) -> None:
        self.server.asked.append(self.path)
        kind = "text/javascript" if self.path.endswith(".js") else "text/html"
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", "0")
        self.send_header("Cache-Control", "max-age=1000")
        self.end_headers()

    def log_message(self, *_: object) -> None:
        """Tell nothing."""


@pytest.fixture
def site() -> Iterator[Site]:
    made = Site()
    threading.Thread(target=made.serve_forever, args=(0.01,), daemon=True).start()
    yield made
    made.shutdown()
    made.server_close()


class Leaving:
    """Leaves something in each way that there is, and looks which of it is found."""

    def __init__(self) -> None:
        self._told: list[str] = []
        self._saved: list[object] = []

    LEFT = """async () => {
        document.cookie = "left=1";
        localStorage.left = sessionStorage.left = 1;
        await new Promise((made) => { indexedDB.open("left").onsuccess = made; });
        await caches.open("left");
        await navigator.serviceWorker.register("/worker.js");
        await navigator.serviceWorker.ready;
        window.open("/other");
        window.name = "left";
    }"""
    FOUND = """async () => ({
        "cookie": document.cookie !== "",
        "local storage": "left" in localStorage,
        "session storage": "left" in sessionStorage,
        "database": (await indexedDB.databases()).length > 0,
        "cache": await caches.has("left"),
        "service worker": (await navigator.serviceWorker.getRegistrations()).length > 0,
        "name": window.name !== "",
        "init script": "begun" in window,
        "function": "exposed" in window,
        "size": innerWidth !== 500,
        "media": matchMedia("(prefers-color-scheme: dark)").matches,
        "motion": !matchMedia("(prefers-reduced-motion: reduce)").matches,
        "permission":
            (await navigator.permissions.query({ name: "geolocation" })).state === "granted",
        "route of the page": (await fetch("/page")).status === 299,
        "route of the window": (await fetch("/window")).status === 299,
    })"""
    SAVE = """() => {
        const link = document.createElement("a");
        link.href = "data:,left";
        link.download = "left";
        link.click();
    }"""

    def leave(self, page: Page) -> None:
        """Leave something in each way."""
        page.evaluate(self.LEFT)
        page.set_viewport_size({"width": 600, "height": 400})
        page.emulate_media(color_scheme="dark", reduced_motion="no-preference")
        page.context.grant_permissions(["geolocation"])
        page.route("**/page", lambda route: route.fulfill(status=ROUTED))
        page.context.route("**/window", lambda route: route.fulfill(status=ROUTED))
        page.on("console", lambda said: self._told.append(said.text))
        page.on("download", lambda saved: self._saved.append(saved))
        page.add_init_script("window.begun = true")
        page.expose_function("exposed", lambda: None)
        page.reload()

    def found(self, page: Page) -> dict[str, bool]:
        """Return what is found of it, by its name."""
        told, saved = len(self._told), len(self._saved)
        found: dict[str, bool] = page.evaluate(self.FOUND)
        page.evaluate("() => console.log('heard')")
        with page.expect_download() as download:
            page.evaluate(self.SAVE)
        download.value.path()
        return found | {
            "listener": len(self._told) > told,
            "listener of downloads": len(self._saved) > saved,
            "other page": len(page.context.pages) > 2,
        }


def test_nothing_that_was_left_is_found(windows: Windows, site: Site) -> None:
    leaving = Leaving()
    with windows.lent(SIZE) as page:
        page.goto(site.address)
        leaving.leave(page)
        assert [name for name, is_found in leaving.found(page).items() if not is_found] == []
    with windows.lent(SIZE) as page:
        page.goto(site.address)
        assert [name for name, is_found in leaving.found(page).items() if is_found] == []


def test_answers_that_a_browser_kept_are_asked_for_again(windows: Windows, site: Site) -> None:
    """Routes keep a browser from keeping any."""
    for _ in range(2):
        site.asked.clear()
        with windows.lent(SIZE) as page:
            page.goto(site.address)
            for _ in range(2):
                page.evaluate("async () => { await fetch('/kept'); }")
        assert site.asked.count("/kept") == 1


def fail_a_script(windows: Windows, site: Site) -> None:
    with (
        page_at(windows, site.address, SIZE) as page,
        page.expect_event("pageerror"),
    ):
        page.evaluate("() => { setInterval(() => { throw new Error('left to fail'); }, 10); }")


def test_a_script_that_failed_is_told_of_its_own_test(windows: Windows, site: Site) -> None:
    with pytest.raises(AssertionError, match="left to fail"):
        fail_a_script(windows, site)
    with page_at(windows, site.address, SIZE) as page:
        page.wait_for_function("() => performance.now() > 100")


WAYS: dict[str, Callable[[Page], object]] = {
    "context.add_init_script": lambda page: page.context.add_init_script("window.begun = true"),
    "context.expose_function": lambda page: page.context.expose_function("exposed", print),
    "context.on": lambda page: page.context.on("page", print),
    "context.set_offline": lambda page: page.context.set_offline(True),
    "context.clock.install": lambda page: page.clock.install(time=0),
}


def test_what_cannot_be_put_back_takes_a_window_of_its_own(windows: Windows, site: Site) -> None:
    with windows.lent(SIZE) as page:
        for name, change in WAYS.items():
            with pytest.raises(OwnWindowError, match=name):
                change(page)
        with pytest.raises(OwnWindowError, match="at a time"), windows.lent(SIZE):
            pass
        with windows.lent(SIZE, is_own=True) as own:
            own.context.add_init_script("window.begun = true")
            own.goto(site.address)
            assert own.evaluate("() => window.begun")
        page.goto(site.address)
        assert not page.evaluate("() => window.begun")
