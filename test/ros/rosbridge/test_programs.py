"""The packages ``roslib`` (npm) and ``roslibpy`` (PyPI), as they are, over the bridge."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from fixtures.graph import RosGraph
from ros.rosbridge.conftest import Served
from ros.rosbridge.counterpart import Counterpart, require_whole

ROOT = Path(__file__).resolve().parents[3]
PROGRAMS = Path(__file__).parent / "programs"
ROSLIB = ROOT / ".cache" / "npm" / "node_modules" / "roslib" / "dist" / "RosLib.js"
WITHIN = 60.0


def run(*command: str | Path) -> dict[str, Any]:
    """Run a program; return what it printed last."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=WITHIN, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    told: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return told


def test_roslib_of_npm_works_as_it_is(bridge_graph: RosGraph, served: Served) -> None:
    there = Counterpart(bridge_graph)
    told = run("node", PROGRAMS / "with_roslib.mjs", ROSLIB, served.address)
    require_whole(told)
    there.require_used()
    assert told["actions"] == ["/clean", "/dock", "/explore", "/undock", "/walk", "/walk_to_point"]
    assert "/dashboard_node" in told["nodes"]
    assert told["compressed"] == [told["battery"]["voltage"]] * 3
    assert told["details"]["cell_voltage"] == ["float32"]
    assert told["details"]["header"]["stamp"] == "time"


def test_roslibpy_works_as_it_is(bridge_graph: RosGraph, served: Served) -> None:
    there = Counterpart(bridge_graph)
    told = run(sys.executable, PROGRAMS / "with_roslibpy.py", served.address)
    require_whole(told)
    there.require_used()
    assert "cell_voltage" in told["details"]
    assert told["time"]["secs"] > 0
