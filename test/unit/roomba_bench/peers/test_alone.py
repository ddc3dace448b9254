"""A peer's process can import the peers, and nothing else that lies beside their package."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from roomba_bench.peers import alone

SCRIPT = """
import importlib.util

from roomba_bench.peers.protocol import Work

DISTRIBUTION = ""


def prepare(parameters):
    names = "roomba", "beside", "mapping"
    found = {name: float(importlib.util.find_spec(name) is not None) for name in names}
    return Work(lambda: 1.0, found)
"""


def test_a_peer_finds_the_protocol_and_nothing_of_the_robot(tmp_path: Path) -> None:
    """As in a folder of all packages, where numpy of the robot lies beside."""
    package = tmp_path / "roomba_bench"
    (package / "peers").mkdir(parents=True)
    for path in (alone.PACKAGE / "__init__.py", *(alone.PACKAGE / "peers").glob("*.py")):
        (package / path.relative_to(alone.PACKAGE)).write_bytes(path.read_bytes())
    (package / "peers" / "looking.py").write_text(SCRIPT)
    (package / "mapping.py").touch()
    (tmp_path / "beside.py").touch()
    done = subprocess.run(
        [sys.executable, "-I", package / "peers" / "alone.py", "roomba_bench.peers.looking"],
        cwd=tmp_path,
        input=json.dumps({"prepare": {}}),
        capture_output=True,
        text=True,
        check=True,
        timeout=60.0,
    )
    assert json.loads(done.stdout)["facts"] == {"roomba": 0.0, "beside": 0.0, "mapping": 0.0}
