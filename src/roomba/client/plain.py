"""What a page shows, as plain values for JSON; what is not known is null."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from roomba.client.observed import TimelineView
from roomba.client.protocol import CleanReport
from roomba.client.view import HomeView, RobotView, RoomView, TruthView, ZoneView
from roomba.geometry import Point
from roomba.time_spent import square_metres_a_minute
from roomba.vocabulary import word_of

Json = dict[str, Any]


def state_of(view: RobotView) -> Json:
    """Return a robot's state as JSON; what is not known is null."""
    vacuum = view.vacuum
    return {
        "type": "state",
        "link": "live",
        "time": round(view.time, 2),
        "pose": [round(value, 4) for value in view.pose],
        "doubt": view.doubt,
        "speed": round(view.speed, 3),
        "dirt": known(round(view.dirt, 2)),
        "held": view.held,
        "vacuum": {
            "state": vacuum.state,
            "phase": vacuum.phase,
            "message": vacuum.message,
            "hindrance": vacuum.hindrance.value,
            "looks_within": round(vacuum.looks_within, 1),
            "room": vacuum.room,
            "covered": round(vacuum.covered, 2),
            "wanted": round(vacuum.wanted, 2),
            "fraction": round(vacuum.fraction, 4),
            "seconds_to_go": round(vacuum.seconds_to_go, 1),
            "battery": known(vacuum.battery),
            "battery_seconds": known(view.battery_seconds),
            "charges": view.charges,
            "queue": vacuum.queue,
            "queue_ways": [
                {"passes": way.passes, "fan": way.fan.value} for way in vacuum.queue_ways
            ],
            "is_on_carpet": vacuum.is_on_carpet,
        },
        "bag": known(view.bag),
        "top_speed": known(view.top_speed),
        "scan": (view.scan * 100.0).round().astype(int).ravel().tolist(),
        "path": (view.path * 100.0).round().astype(int).ravel().tolist(),
        "last": None if view.last is None else report_of(view.last),
        "truth": None if view.truth is None else _truth_of(view.truth),
    }


def _truth_of(truth: TruthView) -> Json:
    return {
        "pose": [round(value, 4) for value in truth.pose],
        "things": [[(round(x, 3), round(y, 3)) for x, y in ring] for ring in truth.things],
        "doors": [asdict(door) for door in truth.doors],
        "lifted": truth.is_lifted,
    }


def replay_of(timeline: TimelineView) -> Json:
    """Return where a recording is as JSON."""
    return {
        "duration": round(timeline.duration, 2),
        "at": round(timeline.at, 2),
        "speed": timeline.speed,
        "playing": timeline.is_playing,
    }


def report_of(report: CleanReport) -> Json:
    """Return how an errand ended as JSON."""
    return {
        "outcome": report.outcome.value,
        "message": report.message,
        "covered": known(report.covered),
        "wanted": known(report.wanted),
        "dirt": known(report.dirt),
        "distance": known(report.distance),
        "duration": known(report.duration),
        "energy": known(report.energy),
        "rate": square_metres_a_minute(report.covered, report.duration),
        "times_least": report.times.times_least,
        "times": [[name, round(seconds, 1)] for name, seconds in report.times.parts if seconds > 0],
        "rooms": [
            {"room": each.room, "share": round(each.share, 4), "grains": round(each.grains, 1)}
            for each in report.rooms
        ],
        "missed": [
            {
                "area": miss.area,
                "x": miss.x,
                "y": miss.y,
                "room": miss.room,
                "reason": miss.reason,
                "code": miss.code,
            }
            for miss in report.missed
        ],
        "mapped": known(report.mapped),
        "open_edges": [
            {**asdict(edge), "code": word_of(edge.reason)} for edge in report.open_edges
        ],
    }


def home_of(view: HomeView) -> Json:
    """Return a home as JSON."""
    return {
        "type": "home",
        "version": view.version,
        "name": view.name,
        "station": view.station,
        "radius": view.radius,
        "tool": view.tool,
        "rooms": [
            {
                "name": room.name,
                "area": room.area,
                "anchor": room.anchor,
                "rings": room.rings,
                "floor": room.floor,
            }
            for room in view.rooms
        ],
        "zones": [
            {"name": zone.name, "kind": zone.kind, "points": zone.points} for zone in view.zones
        ],
        "furniture": view.furniture,
        "overhead": view.overhead,
        "carpets": view.carpets,
        "felt_carpets": view.felt_carpets,
        "changes": [asdict(change) for change in view.changes],
        "low_things": [asdict(thing) for thing in view.low_things],
    }


def home_from(plain: Json) -> HomeView:
    """Return the home of plain values."""
    return HomeView(
        int(plain["version"]),
        str(plain["name"]),
        tuple(plain["station"]),
        tuple(
            RoomView(
                room["name"],
                room["area"],
                tuple(room["anchor"]),
                _outlines(room["rings"]),
                room.get("floor", ""),
            )
            for room in plain["rooms"]
        ),
        tuple(
            ZoneView(zone["name"], zone["kind"], tuple(map(tuple, zone["points"])))
            for zone in plain["zones"]
        ),
        _outlines(plain["furniture"]),
        float(plain["radius"]),
        float(plain["tool"]),
        overhead=_outlines(plain.get("overhead", [])),
        carpets=_outlines(plain.get("carpets", [])),
        felt_carpets=_outlines(plain.get("felt_carpets", [])),
    )


def _outlines(rings: list[list[list[float]]]) -> tuple[tuple[Point, ...], ...]:
    return tuple(tuple((x, y) for x, y in ring) for ring in rings)


def known(value: float) -> float | None:
    """Return a number as JSON has it: what is not finite is null."""
    return value if math.isfinite(value) else None
