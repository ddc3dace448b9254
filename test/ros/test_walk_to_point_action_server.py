from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from fixtures.waiting import wait_until

SCRIPT = "walk_to_point_action_server.py"
SERVER = "/walk_to_point_action_server_node"


def serving(graph: RosGraph) -> bool:
    return SERVER in graph.system_state()[0].get("/walk_to_point/status", [])


def test_a_second_server_is_refused_by_name_and_by_topic(graph: RosGraph) -> None:
    """FAULTS row 31."""
    first = graph.rosrun(SCRIPT)
    wait_until(lambda: serving(graph), 30.0)
    for arguments in ((), ("__name:=another_server",)):
        second = graph.rosrun(SCRIPT, *arguments)
        assert second.ends(10.0) == 1
        assert f"refused: {SERVER}" in second.output
    assert first.status is None
    assert serving(graph)


def test_a_server_that_died_is_no_rival(graph: RosGraph) -> None:
    first = graph.rosrun(SCRIPT)
    wait_until(lambda: serving(graph), 30.0)
    graph.signal(SERVER.strip("/"), 9)
    first.ends(5.0)
    second = graph.rosrun(SCRIPT)
    wait_until(lambda: graph.answers(SERVER), 15.0, "the new server answers")
    assert second.status is None


def test_without_map_and_pose_a_goal_is_rejected_with_the_reason(graph: RosGraph) -> None:
    graph.rosrun(SCRIPT)
    Probe(graph)
    walker = Walker()
    walker.send(1.0, 1.0)
    assert walker.ends(5.0) == 5
    assert "map and position" in walker.text
