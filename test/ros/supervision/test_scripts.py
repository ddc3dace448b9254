"""A script in a fork behaves as in a process of its own."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from fixtures.processes.forked import run_forked

from roomba_ros.supervision.scripts import be_node, import_for

SCRIPT = """
from json import dumps as main
import sys
import rospy

if __name__ == "__main__":
    print(main([*sys.argv, rospy.names.get_mappings()]))
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """A script that tells its arguments, and those of ROS among them."""
    path = tmp_path / "node.py"
    path.write_text(SCRIPT, encoding="utf-8")
    return path


def test_it_has_its_arguments_and_takes_names(script: Path, tmp_path: Path) -> None:
    said = tmp_path / "said"

    def run() -> None:
        with said.open("w", encoding="utf-8") as file:
            os.dup2(file.fileno(), 1)
            sys.stdout = os.fdopen(1, "w", closefd=False)
            be_node(script, ("on", "__name:=it", "odom:=wheels"))
            sys.stdout.flush()

    run_forked(run)
    expected = (
        f'["{script}", "on", "__name:=it", "odom:=wheels", {{"__name": "it", "odom": "wheels"}}]\n'
    )
    assert said.read_text(encoding="utf-8") == expected


def test_what_a_script_imports_is_there_before_it_runs(tmp_path: Path) -> None:
    (tmp_path / "part_of_a_node.py").write_text("main = print\n", encoding="utf-8")
    script = tmp_path / "node.py"
    script.write_text("from part_of_a_node import main\n\nmain()\n", encoding="utf-8")

    def run() -> None:
        sys.path.insert(0, str(tmp_path))
        import_for([script])
        assert "part_of_a_node" in sys.modules

    run_forked(run)
    assert "part_of_a_node" not in sys.modules
