"""Whether there is a desktop to see windows on, and the page opened there in a browser."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Mapping
from typing import Final

_SCREENS: Final = ("DISPLAY", "WAYLAND_DISPLAY")
"""Environment variables that name a screen, on systems where windows need one."""


def names_screen(environment: Mapping[str, str] = os.environ) -> bool:
    """Whether the environment names a screen for windows."""
    return any(environment.get(name) for name in _SCREENS)


def has_desktop(environment: Mapping[str, str] = os.environ, platform: str = sys.platform) -> bool:
    """Whether the user sees windows; on a terminal alone, a text browser would open in it."""
    return platform in ("darwin", "win32") or names_screen(environment)


def open_on_desktop(address: str) -> None:
    """Open an address in the browser of the desktop; where there is none it does nothing."""
    if has_desktop():
        webbrowser.open(address)
