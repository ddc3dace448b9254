"""Messages and model of the robot alone, for a package that builds on them without the robot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
from catkin_pkg.package import parse_package
from fixtures.processes.fresh_login import run
from install.test_workspace import BUILD_DEADLINE, REPOSITORY, SUMS, copy_of_repository, in_space

ALONE = {"ROOMBA_ROBOT_PART": "interface"}
PACKAGE = """<package format="3">
  <name>watcher</name><version>0.0.0</version><description>Builds on the robot.</description>
  <maintainer email="test@example.invalid">A test</maintainer><license>MIT</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>roomba_robot</depend>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.10)
project(watcher)
find_package(catkin REQUIRED COMPONENTS roomba_robot)
catkin_package(CATKIN_DEPENDS roomba_robot)
install(FILES cart.urdf.xacro DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
"""
CART = """<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="robot" default=""/>
  <xacro:include filename="$(arg robot)/src/roomba/data/model/robot.urdf.xacro"/>
  <link name="trailer"/>
  <joint name="hitch" type="fixed"><parent link="base_link"/><child link="trailer"/></joint>
</robot>
"""


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workspace, devel and install, with the interface alone and a package that builds on it.

    The copy of the repository has no virtual environment.
    """
    workspace = tmp_path_factory.mktemp("catkin_ws")
    copy_of_repository(workspace / "src/roomba_robot")
    watcher = workspace / "src/watcher"
    watcher.mkdir()
    for name, text in (
        ("package.xml", PACKAGE),
        ("CMakeLists.txt", CMAKE),
        ("cart.urdf.xacro", CART),
    ):
        (watcher / name).write_text(text)
    built = run(
        ["env", "ROOMBA_ROBOT_PART=interface", "catkin_make", "install"], workspace, BUILD_DEADLINE
    )
    assert built.returncode == 0, built.stdout + built.stderr
    return workspace


@pytest.mark.parametrize("space", ["devel", "install"])
def test_messages_are_there_and_nothing_of_the_robot(workspace: Path, space: str) -> None:
    script = "; ".join(SUMS)
    lines = in_space(workspace, space, script).splitlines()
    assert [line.split()[-1] for line in lines] == list(SUMS.values())
    told = in_space(
        workspace,
        space,
        "/usr/bin/python3 -c 'import importlib.util as found, roomba_robot.msg, roomba_robot.srv; "
        'print(found.find_spec("roomba"), found.find_spec("roomba_ros"))\'',
    )
    assert told.split() == ["None", "None"]
    assert not (workspace / space / "lib/roomba_robot").exists()


@pytest.mark.parametrize("space", ["devel", "install"])
def test_the_model_is_a_part_of_another_one(workspace: Path, space: str) -> None:
    xacro = REPOSITORY / ".venv/bin/xacro"
    cart, robot = "$(rospack find watcher)/cart.urdf.xacro", "$(rospack find roomba_robot)"
    urdf = in_space(workspace, space, f'{xacro} "{cart}" "robot:={robot}"')
    assert 'name="trailer"' in urdf
    assert 'name="base_link"' in urdf


def test_another_part_is_refused(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src/roomba_robot").symlink_to(REPOSITORY / ".workspace/src/roomba_robot")
    built = run(["env", "ROOMBA_ROBOT_PART=messages", "catkin_make"], tmp_path, BUILD_DEADLINE)
    assert built.returncode != 0
    expected = "ROOMBA_ROBOT_PART: expected interface, or nothing for all of it, got 'messages'"
    assert expected in " ".join(built.stderr.split())


def test_only_the_nodes_need_python_packages() -> None:
    assert "python3-numba" in needed({})
    assert needed(ALONE) == {
        "actionlib_msgs", "geometry_msgs", "message_runtime", "sensor_msgs", "std_msgs", "xacro",
    }  # fmt: skip


def needed(environment: Mapping[str, str]) -> set[str]:
    """Return the keys of rosdep that running needs in an environment."""
    package = parse_package(REPOSITORY / "package.xml")
    package.evaluate_conditions(environment)
    return {each.name for each in package.exec_depends if each.evaluated_condition}
