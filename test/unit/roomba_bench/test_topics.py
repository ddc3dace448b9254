"""The table of topics and the list of peers are complete."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from fixtures.processes.ctrl_c import ended

import roomba_bench
from roomba_bench.topics import TOPICS, left_out

FOLDER = Path(roomba_bench.__file__).parent
USAGE = FOLDER.parent / "roomba" / "commands" / "usage.txt"
SHARED = {"__init__", "arena", "boxes", "grids", "matrices", "views"}
PEERS = sorted(path for path in (FOLDER / "peers").glob("*/*.py") if path.stem not in SHARED)


def told(script: Path) -> str:
    """Return a peer as topics name it: ``paths.networkx``."""
    return f"{script.parent.name}.{script.stem}"


def names_in(path: Path) -> set[str]:
    """Return the names that a module defines, without importing what it needs."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    assigned = [node for node in tree.body if isinstance(node, ast.Assign)]
    return functions | {
        target.id for node in assigned for target in node.targets if isinstance(target, ast.Name)
    }


def test_the_table_of_topics_is_complete() -> None:
    modules = {path.stem for path in (FOLDER / "topics").glob("*.py")} - {"__init__"}
    assert set(TOPICS) == modules


def test_what_needs_ros_is_left_out_where_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", "/opt/ros")
    assert [topic for topic in TOPICS if left_out(topic)] == []
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    assert [topic for topic in TOPICS if left_out(topic)] == ["ros"]
    assert left_out("ros") == "there is no ROS environment"


@pytest.mark.parametrize("topic", TOPICS)
def test_each_topic_can_be_measured_and_is_in_the_usage(topic: str) -> None:
    assert "measure" in names_in(FOLDER / "topics" / f"{topic}.py")
    usage = USAGE.read_text(encoding="utf-8")
    [line] = [line for line in usage.splitlines() if line.startswith("  bench [TOPIC")]
    assert topic in line.split("topics:")[1].split()


@pytest.mark.parametrize("script", PEERS, ids=told)
def test_each_peer_has_what_the_protocol_wants_and_knows_nothing_of_the_robot(script: Path) -> None:
    assert {"DISTRIBUTION", "prepare"} <= names_in(script)
    tree = ast.parse(script.read_text(encoding="utf-8"))
    imported = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert not [name for name in imported if name.split(".")[0] in ("roomba", "roomba_ros")]


@pytest.mark.parametrize("script", PEERS, ids=told)
def test_each_peer_is_named_by_a_topic(script: Path) -> None:
    """Nothing imports it, so a name that leads nowhere is not seen before it is started."""
    texts = [path.read_text(encoding="utf-8") for path in FOLDER.rglob("*.py")]
    assert any(f'"{told(script)}"' in text for text in texts)


@pytest.mark.parametrize("script", PEERS, ids=told)
def test_each_peer_is_installed_by_the_list(script: Path) -> None:
    listed = (FOLDER / "peers.txt").read_text(encoding="utf-8").split()
    [line] = [
        line
        for line in script.read_text(encoding="utf-8").splitlines()
        if line.startswith("DISTRIBUTION = ")
    ]
    name = ast.literal_eval(line.partition("=")[2].strip())
    assert name == "" or name in listed


def test_ctrl_c_is_not_lost_while_the_module_of_a_topic_is_loaded() -> None:
    done = ended(
        "import importlib, signal\n"
        "from roomba_bench import topics\n"
        "def load(name):\n"
        "    try:\n"
        "        signal.raise_signal(signal.SIGINT)\n"
        "    except KeyboardInterrupt:\n"
        "        pass  # as compiled modules lose it\n"
        "importlib.import_module = load\n"
        "topics.measure('plan', None)"
    )
    assert (done.returncode, done.stderr) == (130, "stopped on the way\n")
