"""The table of processes is what the launch file says; wrong arguments are named."""

import json
from pathlib import Path

import pytest
from fixtures.graph import WITH_PAGE

from roomba.drivers.robots.table import ROBOTS
from roomba.errors import RoombaError
from roomba_ros.supervision.launch_file import described, read_launch
from roomba_ros.supervision.launch_xml import environment_of

LAUNCH = Path(__file__).resolve().parents[3] / "launch" / "roomba_robot.launch"


def test_it_has_the_nodes_of_the_graph_and_the_body_is_required() -> None:
    launch = read_launch(LAUNCH, [])
    assert {entry.name for entry in launch.processes} == set(WITH_PAGE)
    assert [entry.name for entry in launch.processes if entry.is_required] == ["home_sim_node"]
    assert {entry.path for entry in launch.processes} == {f"/{name}" for name in WITH_PAGE}
    for entry in launch.processes:
        assert (LAUNCH.parents[1] / "scripts" / entry.script).is_file()
    assert launch.parameters["/robot_max_speed"] == 0.5
    assert launch.parameters["/use_sim_time"] is True
    assert environment_of(LAUNCH)["MALLOC_ARENA_MAX"] == "1"
    assert launch.parameters["/position_pub_node/map"] == "given"
    assert launch.parameters["/position_pub_node/calibration"] == "roomba_robot_0"
    assert "/robot_config" not in launch.parameters
    json.dumps(launch.parameters)


def test_each_start_is_a_run_of_its_own() -> None:
    runs = {read_launch(LAUNCH, []).parameters["/robot_run"] for _ in range(3)}
    assert len(runs) == 3


def test_its_arguments_count() -> None:
    launch = read_launch(LAUNCH, ["page:=false", "home:=studio", "robot_max_speed:=0.25"])
    assert "dashboard_node" not in {entry.name for entry in launch.processes}
    assert launch.parameters["/home_sim_node/home"] == "studio"
    assert launch.parameters["/robot_max_speed"] == 0.25


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_that_one_owns_takes_the_place_of_the_simulation(robot: str) -> None:
    lines = ["port:=/dev/ttyACM0", "lidar_port:=/dev/ttyUSB1", "address:=/dev/ttyACM0"]
    launch = read_launch(LAUNCH, [f"robot:={robot}", *lines])
    names = {entry.name for entry in launch.processes}
    simulated = {"home_sim_node", "dirt_pub_node", "turn_camera_service_node"}
    assert names == (set(WITH_PAGE) - simulated) | {"roomba_driver_node"}
    assert [entry.name for entry in launch.processes if entry.is_required] == ["roomba_driver_node"]
    assert launch.parameters["/use_sim_time"] is False
    assert launch.parameters["/robot_config"] == ROBOTS[robot].file.stem
    assert launch.parameters["/roomba_driver_node/robot"] == robot
    assert launch.parameters["/roomba_driver_node/port"] == "/dev/ttyACM0"
    assert launch.parameters["/roomba_driver_node/lidar_port"] == "/dev/ttyUSB1"
    assert launch.parameters["/map_is_given"] is False
    assert launch.parameters["/dashboard_node/home"] == robot
    assert "/dashboard_node/seed" not in launch.parameters
    assert launch.parameters["/position_pub_node/calibration"] == f"roomba_robot_{robot}"


def test_programs_of_other_packages_are_found_or_named(tmp_path: Path) -> None:
    path = tmp_path / "other.launch"
    node = '<node name="n" pkg="{}" type="{}" args="-d \'a b\'"/>'
    path.write_text(f"<launch>{node.format('rosbag', 'play')}</launch>", encoding="utf-8")
    (entry,) = read_launch(path, []).processes
    assert Path(entry.command[0]).name == "play"
    assert entry.command[1:] == ("-d", "a b")
    assert not entry.is_respawned
    path.write_text(f"<launch>{node.format('nowhere', 'nothing')}</launch>", encoding="utf-8")
    with pytest.raises(RoombaError, match="the program nothing of the package nowhere"):
        read_launch(path, [])


def test_its_arguments_are_described() -> None:
    lines = described(LAUNCH).splitlines()
    assert len(lines) == LAUNCH.read_text(encoding="utf-8").count("<arg name=") > 15
    (home,) = (line for line in lines if line.startswith("  home:=flat "))
    assert home.endswith("name of a shipped home, or path of a map_server yaml")


@pytest.mark.parametrize(
    ("argument", "said"),
    [
        ("hme:=flat", "got 'hme'; did you mean 'home'"),
        ("nosucharg:=1", "got 'nosucharg'; known are: address, clock, empties"),
        (
            "robot:=toaster",
            "robot: expected one of create2, neato, openneato, simulated, got 'toaster'",
        ),
        ("flat", "expected arguments like home:=flat, got 'flat'"),
        (":=flat", "expected arguments like home:=flat, got ':=flat'"),
        ("--speed=5", "expected arguments like home:=flat"),
    ],
)
def test_a_wrong_argument_is_named_with_the_nearest_one(argument: str, said: str) -> None:
    with pytest.raises(RoombaError, match=said):
        read_launch(LAUNCH, ["home:=flat", argument])


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no xml",
        "<launch>",
        '<launch><arg name="a"/><node name="n" pkg="p" type="$(arg a)"/></launch>',
    ],
)
def test_a_broken_file_is_refused_with_its_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "broken.launch"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RoombaError, match=r"broken\.launch"):
        read_launch(path, [])
