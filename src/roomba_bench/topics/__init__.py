"""The topics of ``./roomba bench``: one module each, whose ``measure(bench)`` returns its rows.

To add a topic, write its module and name it here.
"""

from __future__ import annotations

import importlib
from types import MappingProxyType

from roomba.commands.process_end import quiet_loading
from roomba_bench.bench import Bench
from roomba_bench.record import Record
from roomba_bench.ros.graph import NO_ROS, has_ros

TOPICS: MappingProxyType[str, str] = MappingProxyType(
    {
        "sim": "whole steps of one robot and of fleets: move, bump, vacuum, lidar",
        "lidar": "exact scans",
        "camera": "pictures with depth",
        "plan": "shortest paths",
        "localization": "where it is: errors on long drives, and finding itself again",
        "rooms": "floors cut into rooms, as people cut them",
        "coverage": "whole homes cleaned: how much of the floor, by how long a way, how fast",
        "mapping": "homes explored without a map: how true the map becomes, and what that takes",
        "slam": "recorded drives of real robots, of --logs FOLDER: errors, speed, pictures",
        "runs": "whole commands, from Enter on: time, and time of all cores",
        "dirt": "a month of a household: cleaning where the dirt is, beside a fixed plan",
        "ros": "round trips, and the speed of the whole graph",
        "page": "what the page costs with one viewer and with a hundred, and how old they see it",
    }
)
"""What each topic is about, by name, in the order in which ``./roomba bench`` runs them all."""


def left_out(topic: str) -> str:
    """Return why a topic is not measured unless it is named, or "" if it is."""
    return NO_ROS if topic == "ros" and not has_ros() else ""


def measure(topic: str, bench: Bench) -> list[Record]:
    """Return the rows of a topic; its module is loaded only now."""
    with quiet_loading():
        module = importlib.import_module(f"roomba_bench.topics.{topic}")
    records: list[Record] = module.measure(bench)
    return records
