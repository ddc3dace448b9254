"""What the page's server costs, and how old updates are when they reach their viewers."""

from __future__ import annotations

import json
import subprocess
import sys
import time
import xmlrpc.client
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

from roomba_bench.bench import Bench
from roomba_bench.contestants import ContestantError
from roomba_bench.record import Better, Record
from roomba_bench.ros.graph import NO_ROS, Graph, free_port, has_ros
from roomba_bench.ros.processes import load

_TOPIC: Final = "page"
_ONE: Final = 15.0
"""% of a core, with one viewer in real time."""
_MANY: Final = 100.0
"""% of a core, with 100 viewers."""
_OLDEST: Final = 200.0
"""ms; the 99th percentile of the age of an update that reaches one of 100 viewers."""
_VIEWERS: Final = (0, 1, 100)
_SETTLED: Final = 5.0
"""s until the robot is under way, and viewers have the layers."""


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    seconds = 5.0 if bench.is_quick else 20.0
    bench.say("a headless robot that cleans, and its page")
    with _headless() as (pid, port):
        records = _rows("headless robot that cleans in real time, and its page", pid, port, seconds)
    if not has_ros():
        bench.say(f"dashboard_node is left out: {NO_ROS}")
        return records
    bench.say("a graph that cleans, and its dashboard_node")
    folder = bench.folder / "graph"
    folder.mkdir()
    with Graph(folder) as graph:
        pid, port = _launched(graph)
        return records + _rows("dashboard_node of a graph that cleans", pid, port, seconds)


@contextmanager
def _headless() -> Iterator[tuple[int, int]]:
    """Give the process of a page over a headless robot, and its port."""
    program = subprocess.Popen(
        (sys.executable, "-m", "roomba_bench.page.served"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert program.stdin is not None
    assert program.stdout is not None
    try:
        line = program.stdout.readline()
        if not line.strip().isdecimal():
            raise ContestantError(f"the page's program ended with status {program.wait(5.0)}")
        time.sleep(_SETTLED)
        yield program.pid, int(line)
    finally:
        program.stdin.close()
        program.wait(20.0)


def _launched(graph: Graph) -> tuple[int, int]:
    """Launch the robot with its page and begin a clean; return the page's process id and port."""
    port = free_port()
    graph.launch("page:=true", f"page_port:={port}")
    graph.wait_for_topic("/clean/status")
    graph.start(
        *("rostopic", "pub", "--latch", "/clean/goal", "roomba_robot/CleanActionGoal", "{}")
    )
    master: Any = xmlrpc.client.ServerProxy(graph.environment["ROS_MASTER_URI"])
    code, message, address = master.lookupNode("/bench", "/dashboard_node")
    if code != 1:
        raise ContestantError(str(message))
    node: Any = xmlrpc.client.ServerProxy(address)
    time.sleep(2.0 * _SETTLED)
    return int(node.getPid("/bench")[2]), port


def _rows(case: str, pid: int, port: int, seconds: float) -> list[Record]:
    """Return what the process costs with so many viewers, and how old updates are for many."""
    records = []
    for count in _VIEWERS:
        used, seen = _watched(pid, port, count, seconds)
        who = {0: "no viewer", 1: "one viewer"}.get(count, f"{count} viewers")
        aim = {0: None, 1: _ONE}.get(count, _MANY)
        records.append(
            Record(_TOPIC, case, f"CPU of the process, {who}", used, "% core", Better.LOWER, aim)
        )
        if count > 1:
            figure = f"age of an update, {who}, 99th percentile"
            records.append(Record(_TOPIC, case, figure, seen["p99"], "ms", Better.LOWER, _OLDEST))
            figure = f"updates of each viewer, {who}"
            records.append(Record(_TOPIC, case, figure, seen["updates"], "1/s", Better.HIGHER))
        elif count == 1:
            size = seen["bytes"] / 1000.0
            records.append(Record(_TOPIC, case, "traffic of a viewer", size, "kB/s", Better.LOWER))
    return records


def _watched(pid: int, port: int, count: int, seconds: float) -> tuple[float, dict[str, float]]:
    """Let so many viewers watch for so many s; return % of a core, and what they received."""
    if count == 0:
        return load([pid], seconds), {}
    viewers = subprocess.Popen(
        (sys.executable, "-m", "roomba_bench.page.viewers", str(port), str(count), str(seconds)),
        stdout=subprocess.PIPE,
        text=True,
    )
    # Only while all are there.
    time.sleep(_SETTLED)
    used = load([pid], seconds - 2.0)
    told, _ = viewers.communicate(timeout=60.0)
    if viewers.returncode:
        raise ContestantError(f"the viewers ended with status {viewers.returncode}")
    seen: dict[str, float] = json.loads(told)
    return used, seen
