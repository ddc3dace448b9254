"""Asking the server of a robot's page what the robot does."""

from __future__ import annotations

import http.client
import json
import urllib.error
import urllib.request
from collections.abc import Iterable
from typing import Any, Final

from roomba.client.address import HERE
from roomba.errors import RoombaError

_PATIENCE: Final = 6.0
"""s of wall time; a robot that says nothing for 5 s is told by its server."""
_OPENER: Final = urllib.request.build_opener(urllib.request.ProxyHandler({}))
"""Goes past any proxy: the server is on this machine."""


class NoRobotError(RoombaError):
    """No robot answers; the message says where it was looked for, and what helps."""


def find_robot(ports: Iterable[int], host: str = HERE) -> int:
    """Return the first port at which the page of a robot is served; raises NoRobotError."""
    tried = list(ports)
    for port in tried:
        try:
            if _asked(host, port, "openapi.json").get("info", {}).get("title") == "roomba_robot":
                return port
        except (OSError, ValueError, AttributeError, http.client.HTTPException):
            continue
    where = f"port {tried[0]}" if len(tried) == 1 else f"the ports {tried[0]} to {tried[-1]}"
    machine = "this machine" if host == HERE else host
    raise NoRobotError(
        f"expected a robot at {where} of {machine}, but none answers; start one by ./roomba run, "
        "or by ./roomba play, or name the port of the address that they printed"
    )


def state_at(port: int, host: str = HERE) -> dict[str, Any]:
    """Return the robot's state as its API tells it; raises NoRobotError with the reason."""
    try:
        return _asked(host, port, "api/v1/state")
    except urllib.error.HTTPError as refusal:
        raise NoRobotError(_reason_of(refusal)) from refusal
    except (OSError, ValueError, http.client.HTTPException) as error:
        raise NoRobotError(f"the robot at port {port} does not answer any more: {error}") from error


def _asked(host: str, port: int, path: str) -> dict[str, Any]:
    with _OPENER.open(f"http://{host}:{port}/{path}", timeout=_PATIENCE) as answer:
        told = json.load(answer)
    if not isinstance(told, dict):
        raise ValueError(f"expected an object, got {type(told).__name__}")
    return told


def _reason_of(refusal: urllib.error.HTTPError) -> str:
    """Return the sentence of the server, or what HTTP says."""
    try:
        return str(json.load(refusal)["detail"])
    except (ValueError, KeyError, TypeError, OSError):
        return str(refusal)
