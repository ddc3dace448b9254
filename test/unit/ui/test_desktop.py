"""A browser opens on the page where there is a desktop to see it on."""

from __future__ import annotations

import pytest

from roomba.ui.desktop import has_desktop, open_on_desktop


@pytest.mark.parametrize("name", ["DISPLAY", "WAYLAND_DISPLAY"])
def test_a_named_screen_is_a_desktop(name: str) -> None:
    assert has_desktop({name: ":0"}, "linux")
    assert not has_desktop({name: ""}, "linux")


def test_some_systems_always_have_one() -> None:
    assert has_desktop({}, "darwin")
    assert has_desktop({}, "win32")
    assert not has_desktop({}, "linux")


def test_without_one_no_browser_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("roomba.ui.desktop.webbrowser.open", opened.append)
    for is_there in (False, True):
        monkeypatch.setattr("roomba.ui.desktop.has_desktop", lambda is_there=is_there: is_there)
        open_on_desktop("http://127.0.0.1:8400/")
    assert opened == ["http://127.0.0.1:8400/"]
