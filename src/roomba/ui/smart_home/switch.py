"""Loads the smart home only when the path of its file is given."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from roomba.client.observed import ObservedRobot
from roomba.errors import RoombaError
from roomba.ui.smart_home.settings import read_settings


class SmartHomeError(RoombaError):
    """The smart home cannot be used; the message says why."""


class Switched(Protocol):
    """The smart home that is in use."""

    def start(self) -> None:
        """Begin."""

    def stop(self) -> None:
        """End."""


def switched_on(robot: ObservedRobot, file: Path, tell: Callable[[str], None]) -> Switched:
    """Return the smart home that a file describes, not started yet; raises RoombaError."""
    config = read_settings(file)
    if config.mqtt is None and config.webhook is None:
        raise SmartHomeError(f"{file}: expected mqtt or webhook, got neither")
    try:
        from roomba.ui.smart_home.smart_home import SmartHome
    except ImportError as error:
        raise SmartHomeError(
            f"expected paho-mqtt, which is optional ({error}); "
            "to mend it: pip install 'roomba_robot[smart-home]'"
        ) from error
    return SmartHome(robot, config, tell)
