"""Asking the server of a robot's page what the robot does."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from roomba.client.address import HERE
from roomba.client.page_api import PageApi
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.errors import RoombaError


class NoRobotError(RoombaError):
    """No robot answers; the message says which address was tried, and what helps."""


def find_robot(ports: Iterable[int], host: str = HERE) -> int:
    """Return the first port at which the page of a robot is served; raises NoRobotError."""
    tried = list(ports)
    for port in tried:
        if _serves_page(PageApi(f"http://{host}:{port}")):
            return port
    where = f"port {tried[0]}" if len(tried) == 1 else f"the ports {tried[0]} to {tried[-1]}"
    machine = "this machine" if host == HERE else host
    raise NoRobotError(
        f"expected a robot at {where} of {machine}, but none answers; start one by ./roomba run, "
        "or by ./roomba play, or name the port of the address that they printed"
    )


def state_at(port: int, host: str = HERE) -> dict[str, Any]:
    """Return the robot's state as its API tells it; raises NoRobotError with the reason."""
    try:
        return PageApi(f"http://{host}:{port}").get("api/v1/state")
    except RequestRefusedError as refusal:
        raise NoRobotError(str(refusal)) from refusal
    except RobotUnavailableError as error:
        raise NoRobotError(f"at port {port}: {error}") from error


def _serves_page(api: PageApi) -> bool:
    try:
        told = api.get("openapi.json").get("info")
    except (RequestRefusedError, RobotUnavailableError):
        return False
    return isinstance(told, dict) and told.get("title") == "roomba_robot"
