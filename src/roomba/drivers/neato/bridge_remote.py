"""A Neato behind a bridge that hands on no commands: looked at, and told to clean by itself.

OpenNeato's firmware hands commands on (``POST /api/serial``). The mock server of its page has that
address in some versions only, and no robot behind it. All of them tell state, charge, error and
scan as JSON, and start, pause and stop the robot's own cleans. Their addresses that drive the
wheels are not used: nothing tells where the floor ends, and the wheels' positions come a second
late. Sources: OpenNeato's firmware, description of its API and mock server (May 2026).
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.drivers.line import LineError
from roomba.drivers.neato.bridge_requests import (
    BridgeAddress,
    MissingError,
    RefusedError,
    json_at,
    request,
)
from roomba.robot.remote import RemoteState, RemoteWish, WishRefusedError
from roomba.vocabulary import Phase

_PATHS: Final = {
    RemoteWish.CLEAN_HOUSE: "/api/clean?action=house",
    RemoteWish.CLEAN_SPOT: "/api/clean?action=spot",
    RemoteWish.PAUSE: "/api/clean?action=pause",
    RemoteWish.STOP: "/api/clean?action=stop",
    RemoteWish.DOCK: "/api/clean?action=dock",
    RemoteWish.BEEP: "/api/sound?id=3",
}
_AT_REST: Final = ("ST_C_Standby", "ST_C_Idle", "ST_M2_Charging_StdBy")
"""States of the robot in which it cleans nothing; the state of its page may say otherwise."""
_STARTS: Final = ("UIMGR_STATE_STARTHOUSECLEANING", "UIMGR_STATE_STARTSPOTCLEANING")
"""States of its page that may stay when the robot is at rest (chrisse1/neato-FHEM, of a D6)."""
_TAKEN: Final = ("MANUALCLEANING", "MANUALDRIVING", "TESTMODE")
_PHASES: Final = (
    ("SUSPENDED", Phase.CHARGING),
    ("PAUSED", Phase.PAUSED),
    ("DOCKINGRUNNING", Phase.RETURNING),
    ("CLEANINGRUNNING", Phase.CLEANING),
    ("STARTHOUSECLEANING", Phase.CLEANING),
    ("STARTSPOTCLEANING", Phase.CLEANING),
)
"""By a part of the state of its page: the first that is in it."""
_ERROR: Final = "error"
"""The kind of error that a person must act on; other kinds are reminders."""
_COMMAND: Final = "GetVersion"
"""A command that each Neato answers."""
_SHOWN: Final = 40
"""Characters of an answer that an error message shows."""
_LEAST_TURNS: Final = 1.0
"""1/s; a lidar that turns more slowly has no sweep."""


def hands_on_commands(address: BridgeAddress) -> bool:
    """Return whether a bridge hands commands on, and a robot answers them.

    Raises LineError where it is not reached. A robot that is silent just now counts as one, and so
    does a bridge that is busy.
    """
    try:
        answer = request(address, "POST", f"/api/serial?cmd={_COMMAND}")
    except MissingError:
        return False
    except RefusedError:
        return True
    lines = answer.decode("ascii", "replace").split("\n")
    lines = [line.strip() for line in lines if line.strip()]
    if lines[:1] == [_COMMAND]:  # its echo
        del lines[0]
    return not lines or any(line.startswith("Component,") for line in lines)


class BridgeRemote:
    """A :class:`roomba.robot.remote.RemoteRobot` behind a bridge."""

    def __init__(self, address: BridgeAddress, lidar: LidarConfig) -> None:
        """Ask nothing yet; ``lidar`` says where on the robot it sits."""
        self._address, self._ahead = address, lidar.mount_ahead

    def look(self) -> RemoteState:
        """Return what the robot does, its charge and its error."""
        state, charger, error = (
            json_at(self._address, f"/api/{what}") for what in ("state", "charger", "error")
        )
        level = 0.01 * self._number(charger, "fuelPercent", "charger")
        if not 0.0 <= level <= 1.0:
            raise LineError(f"expected a fuelPercent from 0 to 100, got {100.0 * level:g}")
        has_power = charger.get("extPwrPresent") is True
        page, robot = (str(state.get(name, "")) for name in ("uiState", "robotState"))
        return RemoteState(
            _phase_of(page, robot, has_power=has_power),
            level,
            charger.get("chargingActive") is True,
            _trouble_of(error),
            any(part in page for part in _TAKEN),
        )

    def scan(self) -> NDArray[np.float32]:
        """Return the points of its newest scan; the bridge keeps one for 1.5 s."""
        answer = json_at(self._address, "/api/lidar")
        if self._number(answer, "rotationSpeed", "lidar") < _LEAST_TURNS:
            return np.empty((0, 2), np.float32)
        points = answer.get("points")
        if not isinstance(points, list):
            raise LineError("expected points in /api/lidar, got none")
        beams = [
            (1e-3 * self._number(point, "dist", "lidar"), self._number(point, "angle", "lidar"))
            for point in points
            if isinstance(point, dict) and point.get("error") == 0
        ]
        met = np.array([beam for beam in beams if beam[0] > 0.0], np.float64).reshape(-1, 2)
        ranges, angles = met[:, 0], np.radians(met[:, 1])
        ahead = self._ahead + ranges * np.cos(angles)
        return np.column_stack((ahead, ranges * np.sin(angles))).astype(np.float32)

    def tell(self, wish: RemoteWish) -> None:
        """Tell the robot a wish; the bridge answers once the robot has heard it."""
        path = self._going_on() if wish is RemoteWish.RESUME else _PATHS[wish]
        try:
            request(self._address, "POST", path)
        except (MissingError, RefusedError) as error:
            raise WishRefusedError(str(error)) from error

    def _going_on(self) -> str:
        """Return the request that resumes a clean; raises WishRefusedError where none is paused.

        A bridge has no such request: its start resumes a paused clean. It decides by the state that
        the robot told it last, so it is asked for the state first; otherwise it might begin anew.
        """
        state = str(json_at(self._address, "/api/state").get("uiState", ""))
        if "CLEANINGPAUSED" not in state:
            raise WishRefusedError("expected a clean that is paused, got none: start one")
        kind = RemoteWish.CLEAN_SPOT if "SPOT" in state else RemoteWish.CLEAN_HOUSE
        return _PATHS[kind]

    def _number(self, values: Mapping[str, Any], name: str, where: str) -> float:
        value = values.get(name)
        if isinstance(value, int | float) and not isinstance(value, bool):
            with contextlib.suppress(OverflowError):  # of a whole number that no float holds
                return float(value)
        raise LineError(f"expected a number {name} in /api/{where}, got {repr(value)[:_SHOWN]}")


def _phase_of(page: str, robot: str, *, has_power: bool) -> Phase:
    at_rest = Phase.DOCKED if has_power else Phase.IDLE
    if page in _STARTS and robot in _AT_REST:
        return at_rest
    return next((phase for part, phase in _PHASES if part in page), at_rest)


def _trouble_of(error: Mapping[str, Any]) -> str:
    if error.get("hasError") is not True or error.get("kind") != _ERROR:
        return ""
    return str(error.get("displayMessage") or f"its error {error.get('errorCode')}")
