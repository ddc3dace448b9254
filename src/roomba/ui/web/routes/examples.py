"""Examples of what is asked and answered, for the description of the API."""

from __future__ import annotations

from typing import Any, Final

from fastapi import FastAPI

from roomba.ui.web.bounded.limits import SERVER_LIMITS

BODIES: Final[dict[str, dict[str, Any]]] = {
    "clean": {"mode": "rooms", "rooms": ["Kitchen", "Hall"], "passes": 2, "fan": "quiet"},
    "queue": {"rooms": ["Hall", "Kitchen"]},
    "go": {"x": 2.5, "y": 1.0},
    "emergency_stop": {"reason": "the cat is in the way"},
    "drive": {"linear": 0.2, "angular": -0.5},
    "speed": {"speed": 0.3},
    "zones": {"name": "Cables", "kind": "no-go", "points": [[1, 1], [2, 1], [2, 2], [1, 2]]},
    "low_things/ignore": {"x": 1.2, "y": 2.8},
    "rooms/rename": {"name": "Room 1", "new_name": "Kitchen"},
    "rooms/join": {"names": ["Room 1", "Room 2"]},
    "rooms/split": {"name": "Room 1", "start": [0.0, 2.0], "end": [3.0, 2.0]},
    "maps/save": {"name": "ground floor"},
    "maps/load": {"name": "ground floor"},
    "maps/change": {"accept": True},
    "upkeep/reset": {"part": "filter"},
    "plans": {
        "name": "kitchen",
        "rule": "FREQ=WEEKLY;BYDAY=MO,TH",
        "at": ["09:30"],
        "order": {"mode": "rooms", "rooms": ["Kitchen"], "passes": 2, "fan": "quiet"},
    },
    "presets": {"name": "after dinner", "order": {"mode": "rooms", "rooms": ["Kitchen"]}},
    "household/quiet": {"quiet": [{"begins": "22:00", "ends": "07:00", "days": [0, 1, 2]}]},
    "household/zone": {"zone": "Europe/Berlin"},
    "household/emptying": {"when": "after each run"},
    "household/waits": {"wanted": True},
    "household/presence": {"at_home": True},
    "camera": {"angle": 15.0},
    "replay": {"at": 12.5, "playing": True, "speed": 4.0},
    "play/spill": {"x": 2.5, "y": 1.0},
    "play/chair": {"x": 2.5, "y": 1.0},
    "play/door": {"name": "kitchen", "is_shut": True},
    "play/put": {"x": 2.5, "y": 1.0, "theta": 1.57},
}
"""Bodies of requests by the end of their path."""
ANSWERS: Final[dict[str, dict[str, Any]]] = {
    "state": {
        "type": "state",
        "link": "live",
        "time": 63.2,
        "pose": [1.25, 0.5, 1.57],
        "doubt": "",
        "speed": 0.29,
        "dirt": 3.4,
        "held": "",
        "vacuum": {
            "state": "cleaning",
            "phase": "cleaning",
            "message": "",
            "hindrance": "",
            "looks_within": 0.0,
            "room": "Kitchen",
            "covered": 4.2,
            "wanted": 38.5,
            "fraction": 0.109,
            "seconds_to_go": 1260.0,
            "battery": 0.93,
            "queue": ["Kitchen", "Hall"],
            "queue_ways": [{"passes": 2, "fan": "strong"}, {"passes": 1, "fan": "standard"}],
        },
        "scan": [125, 210, 126, 211],
        "path": [125, 50, 160, 50],
        "last": None,
    },
    "home": {
        "type": "home",
        "version": 3,
        "name": "flat",
        "station": [0.3, 0.2, 3.14],
        "radius": 0.17,
        "tool": 0.2,
        "rooms": [
            {
                "name": "Kitchen",
                "area": 12.1,
                "anchor": [2.0, 1.5],
                "rings": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]],
            }
        ],
        "zones": [{"name": "Cables", "kind": "no-go", "points": [[1, 1], [2, 1], [2, 2], [1, 2]]}],
        "furniture": [],
        "changes": [],
    },
    "limits": {
        "max_speed": 0.5,
        "max_angular_speed": 4.25,
        "most_passes": 5,
        "most_zones": 1000,
        "most_corners": 200,
        "longest_name": 80,
        "server": SERVER_LIMITS,
        "rosbridge": None,
    },
}
"""Answers by the end of their path; ``scan`` and ``path`` are x and y in turns, cm."""
_PREFIX: Final = "/api/v1/"


class DescribedApp(FastAPI):
    """Describes itself with examples, at ``/openapi.json``."""

    def openapi(self) -> dict[str, Any]:
        """Return the description."""
        schema = super().openapi()
        for path, methods in schema["paths"].items():
            for operation in methods.values():
                _add_examples(path.removeprefix(_PREFIX), operation)
        return schema


def _add_examples(path: str, operation: dict[str, Any]) -> None:
    body = operation.get("requestBody", {}).get("content", {}).get("application/json")
    if body is not None and path in BODIES:
        body["example"] = BODIES[path]
    answer = operation["responses"].get("200", {}).get("content", {}).get("application/json")
    if answer is not None and path in ANSWERS:
        answer["example"] = ANSWERS[path]
