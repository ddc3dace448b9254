"""The manners of ./roomba: usage, exec, doctor, and what it refuses."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from fixtures.processes.fresh_login import run

REPOSITORY = Path(__file__).resolve().parents[2]


def test_unknown_command_is_refused_with_the_usage() -> None:
    done = run(["./roomba", "bogus"], REPOSITORY)
    assert done.returncode == 2
    assert "'bogus'" in done.stderr
    assert "usage: ./roomba COMMAND" in done.stderr


@pytest.mark.parametrize("arguments", [[], ["help"], ["--help"]])
def test_usage_is_told(arguments: list[str]) -> None:
    done = run(["./roomba", *arguments], REPOSITORY)
    assert done.returncode == 0
    assert done.stdout.startswith("usage: ./roomba COMMAND")


def test_what_is_installed_on_asking_is_not_installed_otherwise() -> None:
    script = 'source install_dependencies.sh; for each in "$@"; do system_packages "$each"; done'

    def packages(*extents: str) -> set[str]:
        done = run(["bash", "-c", script, "packages", *extents], REPOSITORY)
        assert done.returncode == 0, done.stderr
        return set(done.stdout.split())

    asked = {each: packages(each) for each in ("rviz", "screen", "robot_state_publisher")}
    assert "rviz" in asked["rviz"]
    assert asked["screen"] == asked["rviz"] | {"xvfb"}
    usual = packages("runtime", "dev")
    assert "catkin" in usual
    assert all(names and not names & usual for names in asked.values())


def test_exec_without_a_command_is_refused() -> None:
    done = run(["./roomba", "exec"], REPOSITORY)
    assert done.returncode == 2
    assert "expected a command" in done.stderr


def test_exec_runs_in_the_environment_wherever_it_is_called(tmp_path: Path) -> None:
    script = (
        'pwd; command -v python3; printf "%s\\n" "$ROS_IP"; python3 -c "import roomba_robot.msg"'
    )
    done = run([REPOSITORY / "roomba", "exec", "bash", "-c", script], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        str(tmp_path),
        str(REPOSITORY / ".venv/bin/python3"),
        "127.0.0.1",
    ]


def test_exec_hands_back_the_status() -> None:
    assert run(["./roomba", "exec", "bash", "-c", "exit 7"], REPOSITORY).returncode == 7


@pytest.mark.parametrize("command", [["exec", "true"], ["control"], ["camera"]])
def test_without_an_isolated_robot_commands_for_it_say_so(
    command: list[str], tmp_path: Path
) -> None:
    name, *words = command
    home = f"ROS_HOME={tmp_path}"
    done = run(["env", home, "./roomba", name, "--isolated", *words], REPOSITORY)
    assert done.returncode == 1
    assert "expected an isolated robot, and none runs" in done.stderr


def test_rosrun_of_the_one_command_finds_a_script_without_asking() -> None:
    command = ["./roomba", "exec", "rosrun", "--prefix", "echo", "roomba_robot", "control_node.py"]
    done = run(command, REPOSITORY)
    script = REPOSITORY / ".workspace/devel/lib/roomba_robot/control_node.py"
    assert done.stdout.splitlines() == [str(script)], done.stderr


def test_doctor_finds_nothing_missing() -> None:
    done = run(["./roomba", "doctor"], REPOSITORY)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "missing" not in done.stdout


@pytest.mark.parametrize("uri", ["localhost", "http://localhost", "ftp://localhost:11311"])
def test_broken_master_uri_is_refused_with_what_was_expected(uri: str) -> None:
    done = run(["env", f"ROS_MASTER_URI={uri}", "./roomba", "exec", "true"], REPOSITORY)
    assert done.returncode == 1
    assert "expected http://HOST:PORT" in done.stderr
    assert uri in done.stderr


def test_without_the_tests_the_command_says_so(tmp_path: Path) -> None:
    for name in ("roomba", "set_up.sh", "install_dependencies.sh"):
        shutil.copy2(REPOSITORY / name, tmp_path)
    done = run(["./roomba", "test", "contract"], tmp_path)
    assert done.returncode == 1
    assert "expected a whole checkout with the folder test/running" in done.stderr
