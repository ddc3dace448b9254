"""A made-up bridge of OpenNeato: an HTTP server before a made-up Neato.

It hands commands on, one at a time (``POST /api/serial?cmd=…``). Some of the robot's answers it
also tells as JSON; it asks the robot for each at most once a second. It starts, pauses and ends the
robot's own cleans (``POST /api/clean?action=…``), but does not send it home: the made-up robot has
no program for that. Source: OpenNeato's description of its API, user guide and firmware.
"""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections.abc import Callable, Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Final
from urllib.parse import parse_qs, urlsplit

from roomba.emulators.living import LivingWorld
from roomba.emulators.neato.cleaning import OwnCleaning
from roomba.emulators.neato.robot import STEP, NeatoRobot
from roomba.emulators.neato.server import LATENCY

_REST: Final = 0.05
"""s between two commands on the robot's line."""
_BYTE: Final = 10.0 / 115_200
"""s for a byte on that line."""
_QUEUE: Final = 16
"""Commands that wait at most."""
_KEPT: Final = 1.0
"""s for which an answer is kept and told again (by the firmware 1 to 30 s, by its kind)."""
_END: Final = "\x1a"
_NO_ERROR: Final[Mapping[str, object]] = {
    "hasError": False,
    "kind": "",
    "errorCode": 200,
    "errorMessage": "",
    "displayMessage": "",
}
_CELLS: Final = 4
"""Cells of a line of a scan."""

_CLEANS: Final[Mapping[str, Callable[[OwnCleaning], None]]] = {
    "house": OwnCleaning.press_start,
    "spot": OwnCleaning.clean_spot,
    "pause": OwnCleaning.pause,
    "stop": OwnCleaning.end,
}
"""What each action does: as in the firmware, where a start resumes a clean that is paused."""

Label = tuple[str, type]
_FIELDS: Final[Mapping[str, tuple[str, Mapping[str, Label]]]] = {
    "charger": (
        "GetCharger",
        {
            "fuelPercent": ("FuelPercent", float),
            "batteryOverTemp": ("BatteryOverTemp", bool),
            "chargingActive": ("ChargingActive", bool),
            "chargingEnabled": ("ChargingEnabled", bool),
            "confidOnFuel": ("ConfidentOnFuel", bool),
            "onReservedFuel": ("OnReservedFuel", bool),
            "emptyFuel": ("EmptyFuel", bool),
            "batteryFailure": ("BatteryFailure", bool),
            "extPwrPresent": ("ExtPwrPresent", bool),
            "vBattV": ("VBattV", float),
            "vExtV": ("VExtV", float),
            "chargerMAH": ("Charger_mAH", float),
            "dischargeMAH": ("Discharge_mAH", float),
        },
    ),
    "motors": (
        "GetMotors",
        {
            "brushRPM": ("Brush_RPM", float),
            "brushMA": ("Brush_mA", float),
            "vacuumRPM": ("Vacuum_RPM", float),
            "vacuumMA": ("Vacuum_mA", float),
            "leftWheelRPM": ("LeftWheel_RPM", float),
            "leftWheelLoad": ("LeftWheel_Load%", float),
            "leftWheelPositionMM": ("LeftWheel_PositionInMM", float),
            "leftWheelSpeed": ("LeftWheel_Speed", float),
            "rightWheelRPM": ("RightWheel_RPM", float),
            "rightWheelLoad": ("RightWheel_Load%", float),
            "rightWheelPositionMM": ("RightWheel_PositionInMM", float),
            "rightWheelSpeed": ("RightWheel_Speed", float),
            "sideBrushMA": ("SideBrush_mA", float),
            "laserRPM": ("Laser_RPM", float),
        },
    ),
}
"""For each address: the robot's command, and of each JSON field the robot's label and the type."""


class NeatoBridge:
    """Serves a robot at ``address`` until :meth:`end`, ``speed`` times as fast as real time."""

    def __init__(self, robot: NeatoRobot, port: int = 0, speed: float = 1.0) -> None:
        """Bind a port of this machine's own address, 0: any; raises OSError when it is taken."""
        self.robot, self._speed = robot, speed
        self._world = LivingWorld(robot.advance, speed, STEP)
        self._line, self._waiting = threading.Lock(), 0
        self._counting, self._is_over = threading.Lock(), threading.Event()
        self._free_at = 0.0
        self._keeping = threading.Lock()
        self._kept: dict[str, tuple[float, str]] = {}
        self._server = ThreadingHTTPServer(("127.0.0.1", port), _handler_of(self))
        self._server.daemon_threads = True
        self.address = f"127.0.0.1:{self._server.server_address[1]}"
        self._thread = threading.Thread(
            target=self._server.serve_forever, args=(0.1,), name="bridge", daemon=True
        )

    def start(self) -> None:
        """Let the world go on, and answer."""
        self._world.start()
        self._thread.start()

    def end(self) -> None:
        """Let the world stand, and answer no more."""
        self._is_over.set()
        self._server.shutdown()
        self._thread.join(2.0)
        self._server.server_close()
        self._world.end()

    def __enter__(self) -> NeatoBridge:
        """Start."""
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        """End."""
        self.end()

    def said(self, command: str) -> str | None:
        """Return what the robot says to a command, without its end; None when too many wait."""
        with self._counting:
            if self._waiting >= _QUEUE:
                return None
            self._waiting += 1
        try:
            with self._line:
                self._pass(self._free_at - time.monotonic())
                self._pass(LATENCY / self._speed)
                with self._world.lock:
                    answer = self.robot.answer(command)
                self._pass(len(answer) * _BYTE / self._speed)
                self._free_at = time.monotonic() + _REST / self._speed
            return answer.removesuffix(_END)
        finally:
            with self._counting:
                self._waiting -= 1

    def clean(self, action: str) -> bool:
        """Let the robot begin, pause or end a clean; return whether there is such an action."""
        if action not in _CLEANS:
            return False
        # Not between a question for the state and its answer, which would be kept though it is old.
        with self._keeping:
            with self._world.lock:
                self.robot.clean(_CLEANS[action])
            self._kept.pop("GetState", None)
        return True

    def told(self, what: str) -> Mapping[str, object] | None:
        """Return the JSON values of ``/api/`` + ``what``; None where there is no such address."""
        if what == "lidar":
            return _scan_of(self._recent("GetLDSScan"))
        if what == "state":
            return _state_of(self._recent("GetState"))
        if what == "error":
            return _NO_ERROR
        if what not in _FIELDS:
            return None
        command, fields = _FIELDS[what]
        values = _values_of(self._recent(command))
        return {name: kind(values.get(label, 0.0)) for name, (label, kind) in fields.items()}

    def _recent(self, command: str) -> str:
        with self._keeping:
            at, answer = self._kept.get(command, (-_KEPT, ""))
            if not answer or time.monotonic() - at >= _KEPT:
                answer = self.said(command) or ""
                self._kept[command] = time.monotonic(), answer
            return answer

    def _pass(self, seconds: float) -> None:
        if seconds > 0.0:
            self._is_over.wait(seconds)


def _handler_of(bridge: NeatoBridge) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        """Answers one request, and lets go of the connection, as the bridge does."""

        def do_GET(self) -> None:
            """Tell something as JSON."""
            path = urlsplit(self.path).path
            told = bridge.told(path.removeprefix("/api/")) if path.startswith("/api/") else None
            if told is None:
                self._tell(404, {"error": "not found"})
            else:
                self._tell(200, told)

        def do_POST(self) -> None:
            """Hand a command on."""
            asked = urlsplit(self.path)
            if asked.path == "/api/clean":
                self._clean(asked.query)
                return
            if asked.path != "/api/serial":
                self._tell(404, {"error": "not found"})
                return
            words = parse_qs(asked.query, keep_blank_values=True).get("cmd")
            if not words or not words[0]:
                self._tell(400, {"error": "empty cmd" if words else "missing cmd"})
                return
            said = bridge.said(words[0])
            if said is None:
                self._tell(503, {"error": "unavailable"})
            else:
                self._send(200, "text/plain", said.encode("ascii", "replace"))

        def _clean(self, query: str) -> None:
            """Begin, pause or end a clean."""
            action = parse_qs(query).get("action", [""])[0]
            if bridge.clean(action):
                self._tell(200, {"ok": True})
            else:
                self._tell(503, {"error": "unavailable"})

        def _tell(self, status: int, values: Mapping[str, object]) -> None:
            self._send(status, "application/json", json.dumps(values).encode())

        def _send(self, status: int, kind: str, content: bytes) -> None:
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(content)))
            self.send_header("Connection", "close")
            # A program that waited long enough has gone.
            with contextlib.suppress(ConnectionError):
                self.end_headers()
                self.wfile.write(content)

        def log_message(self, format: str, *arguments: Any) -> None:
            """Write nothing: it is asked ten times a second."""

    return Handler


def _values_of(answer: str) -> dict[str, float]:
    """Return the numbers of an answer by their labels."""
    values: dict[str, float] = {}
    for label, *cells in (line.split(",") for line in answer.splitlines()):
        try:
            values[label] = float(cells[0])
        except (IndexError, ValueError):
            continue
    return values


def _state_of(answer: str) -> dict[str, str]:
    said = dict(line.split(" is: ", 1) for line in answer.splitlines() if " is: " in line)
    return {
        "uiState": said.get("Current UI State", ""),
        "robotState": said.get("Current Robot State", ""),
    }


def _scan_of(answer: str) -> dict[str, object]:
    points, rotation = [], 0.0
    for cells in (line.split(",") for line in answer.splitlines()):
        if len(cells) == _CELLS and cells[0].isdigit():
            angle, distance, intensity = map(int, cells[:3])
            error = int(cells[3], 16)
            points.append(
                {"angle": angle, "dist": distance, "intensity": intensity, "error": error}
            )
        elif cells[0] == "ROTATION_SPEED":
            rotation = float(cells[1])
    valid = sum(point["error"] == 0 for point in points)
    return {"rotationSpeed": rotation, "validPoints": valid, "points": points}
