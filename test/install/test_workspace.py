"""A workspace of one's own, the conventional way: catkin_make, source, rosrun, install."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from fixtures.processes.fresh_login import DEADLINE, run

REPOSITORY = Path(__file__).resolve().parents[2]
CACHES = (".git", ".cache", ".venv", ".workspace", ".hypothesis", "__pycache__")
SCRIPTS = sorted(path.name for path in (REPOSITORY / "scripts").glob("*.py"))
SUMS = {
    "rosmsg md5 roomba_robot/RobotPosition": "2178591bb5b4f72502724261422523b6",
    "rosmsg md5 roomba_robot/PositionAndDestination": "9c290bcd1e8f07bfd24d9381e72e1011",
    "rossrv md5 roomba_robot/TurnCamera": "d2bd6d55eaa6b367037dff843fa7a83c",
    "rosmsg md5 roomba_robot/WalkToPointAction": "b29e061a6202e3214456dee7af3eeed8",
}
NODES_OF_LAUNCH = {
    "/dirt_pub_node",
    "/speed_pub_node",
    "/position_pub_node",
    "/walk_to_point_action_server_node",
}
BUILD_DEADLINE = 240.0
"""s that a build may take; it takes 10."""


def in_space(workspace: Path, space: str, script: str) -> str:
    """Return what a bash script prints after sourcing the devel or the install space."""
    done = run(["bash", "-c", f"source {space}/setup.bash\n{script}"], workspace)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def warnings_of_ours(output: str) -> list[str]:
    """Return the lines that warn, but for those about catkin's own files.

    CMakeLists.txt of the workspace is a link to one of catkin's; ours is in roomba_robot/
    """
    return [
        line
        for line in output.splitlines()
        if re.search(r"\bwarning\b|\*\*\*", line, re.IGNORECASE)
        and not re.search(r" at (/usr/|CMakeLists\.txt:)", line)
    ]


def copy_of_repository(to: Path) -> None:
    """Copy what a clone would hold: everything but what git ignores."""
    if not (REPOSITORY / ".git").exists():
        shutil.copytree(REPOSITORY, to, ignore=shutil.ignore_patterns(*CACHES))
        return
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=REPOSITORY,
        capture_output=True,
        check=True,
        text=True,
        timeout=DEADLINE,
    )
    for name in filter(None, listed.stdout.split("\0")):
        if (REPOSITORY / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(REPOSITORY / name, to / name)


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A catkin workspace with a copy of the repository, dependencies installed, devel space built.

    The virtual environment is that of the repository, to spare the network.
    """
    workspace = tmp_path_factory.mktemp("catkin_ws")
    package = workspace / "src/roomba_robot"
    copy_of_repository(package)
    (package / ".venv").symlink_to(REPOSITORY / ".venv")
    before = (REPOSITORY / ".venv/.stamp-runtime").read_text()

    installed = run(["./install_dependencies.sh"], package)
    assert installed.returncode == 0, installed.stderr
    assert "All dependencies are there" in installed.stderr
    assert "Installing" not in installed.stderr, "a complete environment is set up again"
    assert (REPOSITORY / ".venv/.stamp-runtime").read_text() == before

    built = run(["catkin_make"], workspace, BUILD_DEADLINE)
    assert built.returncode == 0, built.stdout + built.stderr
    assert warnings_of_ours(built.stdout + built.stderr) == []
    return workspace


@pytest.fixture(scope="module")
def installed_workspace(workspace: Path) -> Path:
    """The same workspace with its install space."""
    installed = run(["catkin_make", "install"], workspace, BUILD_DEADLINE)
    assert installed.returncode == 0, installed.stdout + installed.stderr
    return workspace


@pytest.fixture(params=["devel", "install"])
def space(request: pytest.FixtureRequest, workspace: Path) -> tuple[Path, str]:
    """Each of the two spaces: the workspace's folder and the name of the space."""
    if request.param == "install":
        request.getfixturevalue("installed_workspace")
    return workspace, request.param


def test_interfaces_are_those_of_the_original(space: tuple[Path, str]) -> None:
    lines = in_space(*space, "\n".join(SUMS)).splitlines()
    assert [line.split()[-1] for line in lines] == list(SUMS.values())


def test_rosrun_finds_each_script_without_asking(space: tuple[Path, str]) -> None:
    workspace, name = space
    script = "\n".join(f"rosrun --prefix echo roomba_robot {script}" for script in SCRIPTS)
    found = in_space(workspace, name, script).splitlines()
    assert found == [str(workspace / name / "lib/roomba_robot" / script) for script in SCRIPTS]


def test_scripts_run_with_the_virtual_environment(space: tuple[Path, str]) -> None:
    workspace, name = space
    package = workspace / "src/roomba_robot"
    python = in_space(workspace, name, "command -v python3").strip()
    assert python == str(package.resolve() / ".venv/bin/python3")
    expected = {"devel": f"#!{python}", "install": "#!/usr/bin/env python3"}[name]
    for script in SCRIPTS:
        first_line = (workspace / name / "lib/roomba_robot" / script).read_text().splitlines()[0]
        assert first_line == expected


def test_packages_import_from_the_space(space: tuple[Path, str]) -> None:
    workspace, name = space
    script = """python3 - <<'PYTHON'
import roomba, roomba_ros, roomba_robot.msg, roomba_robot.srv, numba
for package in (roomba, roomba_ros, roomba_robot):
    print(package.__file__)
PYTHON"""
    # in the devel space the packages are those of the source space, by way of catkin's relays
    allowed = {"devel": ("devel", "src/roomba_robot/src"), "install": ("install",)}[name]
    for path in in_space(workspace, name, script).splitlines():
        assert path.startswith(tuple(str(workspace / folder) for folder in allowed)), path


def test_launch_file_is_found_with_its_nodes(space: tuple[Path, str]) -> None:
    listed = in_space(*space, "roslaunch --nodes roomba_robot roomba_robot.launch").split()
    assert set(listed) >= NODES_OF_LAUNCH


def test_homes_and_configuration_are_found_from_the_space(space: tuple[Path, str]) -> None:
    workspace, name = space
    script = """python3 - <<'PYTHON'
from roomba.files.shipped import CONFIGURATION, HOMES
for folder in (CONFIGURATION, HOMES):
    print(folder, *sorted(path.name for path in folder.iterdir()))
PYTHON"""
    allowed = {"devel": "src/roomba_robot/src", "install": "install"}[name]
    data = REPOSITORY / "src/roomba/data"
    for line, part in zip(
        in_space(workspace, name, script).splitlines(), ("configuration", "homes"), strict=True
    ):
        folder, *found = line.split()
        assert Path(folder).is_relative_to(workspace / allowed)
        assert found == sorted(path.name for path in (data / part).iterdir())


@pytest.mark.parametrize("folder", ["launch"])
def test_data_are_installed(installed_workspace: Path, folder: str) -> None:
    shared = installed_workspace / "install/share/roomba_robot" / folder
    ours = {path.name for path in (REPOSITORY / folder).iterdir()}
    expected = sorted(ours - {"__pycache__"})
    assert sorted(path.name for path in shared.iterdir()) == expected


def test_environment_is_the_same_however_often_it_is_sourced(workspace: Path) -> None:
    script = """source devel/setup.bash
set -u
for hook in devel/etc/catkin/profile.d/*roomba_robot.sh; do . "$hook"; done
printf %s "$PATH"
"""
    entries = in_space(workspace, "devel", script).split(":")
    venv = str(workspace / "src/roomba_robot/.venv/bin")
    assert entries[0] == venv
    assert entries.count(venv) == 1
    assert "" not in entries


@pytest.mark.parametrize("path", ["", "/usr/bin"])
def test_environment_hook_works_in_a_bare_shell(workspace: Path, path: str) -> None:
    hook = next((workspace / "devel/etc/catkin/profile.d").glob("*roomba_robot.sh"))
    script = f'set -eu\nPATH="{path}"\n. {hook}\nprintf %s "$PATH"'
    done = run(["sh", "-c", script], workspace)
    venv = str(workspace / "src/roomba_robot/.venv/bin")
    assert done.returncode == 0, done.stderr
    assert done.stdout == (f"{venv}:{path}" if path else venv)
