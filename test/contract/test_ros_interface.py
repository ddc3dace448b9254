"""The tables of docs/ros_interface.md say what the running graph is."""

import contextlib
import re
from pathlib import Path
from xml.etree import ElementTree

from fixtures.graph import WITH_PAGE, RosGraph
from fixtures.nodes.rviz import TYPES, displays, settings, tools
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from tf2_msgs.msg import TFMessage

from roomba_ros.model.description import description

PAGE = (Path(__file__).parents[2] / "docs" / "ros_interface.md").read_text(encoding="utf-8")
OF_EVERY_NODE = {"/rosout"}


def table(heading: str) -> list[list[str]]:
    """Return the rows of the table under a heading, each a list of cells."""
    section = PAGE.split(f"## {heading}\n", 1)[1].split("\n#", 1)[0]
    rows = [line.strip("|").split("|") for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows[2:]]


def names(cell: str) -> set[str]:
    return set(re.findall(r"`([^`]+)`", cell))


def by_node(listing: dict[str, list[str]], node: str) -> set[str]:
    return {name for name, nodes in listing.items() if f"/{node}" in nodes}


def differences(graph: RosGraph) -> list[tuple[str, set[str]]]:
    """Return the names by node that are either in the table or in the graph, but not in both."""
    publishers, subscribers, services = graph.system_state()
    found = []
    for cells in table("Nodes of `roomba_robot.launch`"):
        (node,) = names(cells[0])
        own = {name for name in by_node(services, node) if not name.startswith(f"/{node}/")}
        running = (by_node(publishers, node) - OF_EVERY_NODE, by_node(subscribers, node), own)
        found += [
            (node, names(told) ^ real)
            for told, real in zip(cells[1:4], running, strict=True)
            if names(told) != real
        ]
    return found


def test_nodes_do_what_the_table_says(robot_with_page: RosGraph) -> None:
    rows = table("Nodes of `roomba_robot.launch`")
    assert {name for row in rows for name in names(row[0])} == {*WITH_PAGE, "supervisor_node"}
    with contextlib.suppress(AssertionError):
        # Nodes register their topics one after the other.
        wait_until(lambda: not differences(robot_with_page), 5.0)
    assert differences(robot_with_page) == []


def test_topics_have_the_types_that_the_table_says(robot_with_page: RosGraph) -> None:
    listed = {next(iter(names(row[0]))): next(iter(names(row[1]))) for row in table("Topics")}
    types = robot_with_page.topic_types()
    running = {topic: kind for topic, kind in types.items() if not topic.startswith("/rosout")}
    assert listed == running


def test_services_have_the_types_that_the_table_says(robot_with_page: RosGraph) -> None:
    import rosservice

    Probe(robot_with_page)
    listed = {
        next(iter(names(row[0]))): next(iter(names(row[1])))
        for row in table("Services and actions")
    }
    actions = {name: kind for name, kind in listed.items() if kind.endswith("Action")}
    types = robot_with_page.topic_types()
    goals = {name for name, kind in types.items() if kind.endswith("ActionGoal")}
    assert {f"{name}/goal" for name in actions} == goals
    for name, kind in actions.items():
        assert types[f"{name}/goal"] == f"{kind}Goal"
        del listed[name]
    _, _, services = robot_with_page.system_state()
    own = {name for name in services if name.count("/") == 1 or "logger" not in name}
    assert own == set(listed)
    for name, kind in listed.items():
        assert rosservice.get_service_type(name) == kind


def test_parameters_are_those_of_the_table(robot_with_page: RosGraph) -> None:
    rows = table("Parameters")
    for cells in rows:
        (name,), (default,) = names(cells[0]), names(cells[1])
        assert str(robot_with_page.param(name)) == default


def test_what_rviz_shows_is_there(robot_with_page: RosGraph) -> None:
    types = robot_with_page.topic_types()
    shown = displays()
    assert len(shown) >= 12
    for display in shown:
        assert types[display["topic"]] == TYPES[display["class"]], display
    publishers, subscribers, _ = robot_with_page.system_state()
    assert {display["topic"] for display in shown} <= publishers.keys()
    wired = tools()
    assert wired.keys() >= {"rviz/SetGoal", "rviz/SetInitialPose"}
    for tool in ("rviz/SetGoal", "rviz/SetInitialPose"):
        assert types[wired[tool]] == TYPES[tool]
        assert wired[tool] in subscribers


def test_rviz_finds_its_fixed_frame_and_every_link_of_the_model(robot_with_page: RosGraph) -> None:
    assert robot_with_page.param("/robot_description") == description()
    links = {link.get("name") for link in ElementTree.fromstring(description()).findall("link")}
    probe = Probe(robot_with_page)
    mounts = probe.next("/tf_static", TFMessage).transforms
    frames = {each.child_frame_id for each in mounts}

    def told() -> bool:
        for each in probe.next("/tf", TFMessage).transforms:
            frames.update((each.header.frame_id, each.child_frame_id))
        return frames >= links | {settings()["Global Options"]["Fixed Frame"]}

    wait_until(told, 20.0, lambda: f"all of {links} in {frames}")


def test_a_camera_has_the_standard_names(robot_with_page: RosGraph) -> None:
    types = robot_with_page.topic_types()
    assert types["/camera/image_raw"] == "sensor_msgs/Image"
    assert types["/camera/image_raw/compressed"] == "sensor_msgs/CompressedImage"
    assert types["/camera/camera_info"] == "sensor_msgs/CameraInfo"
