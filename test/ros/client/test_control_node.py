import signal

from fixtures.graph import RosGraph
from fixtures.waiting import promised, wait_until


def test_end_of_input_ends_it(master: RosGraph) -> None:
    """Without input the menu ends with status 0, and does not print its choices for ever."""
    menu = master.rosrun("control_node.py")
    menu.says("Select: ", 30.0)
    menu.end_of_input()
    assert menu.ends(20.0) == 0
    assert menu.output.count("\n") < 30


def test_ctrl_c_at_the_menu_ends_it(master: RosGraph) -> None:
    """Ctrl-C ends the menu within 1 s, with the status of an interrupted program, 130."""
    menu = master.rosrun("control_node.py")
    menu.says("Select: ", 30.0)
    menu.send(signal.SIGINT)
    promised(lambda: menu.status is not None, 1.0, "it has ended")
    assert menu.status == 130


def test_a_second_menu_leaves_the_first_one_alone(master: RosGraph) -> None:
    first = master.rosrun("control_node.py")
    first.says("Select: ", 30.0)
    second = master.rosrun("control_node.py")
    second.says("Select: ", 30.0)

    def both_hear() -> bool:
        nodes = master.system_state()[1].get("/position", [])
        return len(nodes) == 2 and all(master.answers(node) for node in nodes)

    wait_until(both_hear, 20.0, "two menus hear the robot")
    for menu in (first, second):
        menu.end_of_input()
        assert menu.ends(20.0) == 0


def test_a_wrong_choice_is_asked_again(master: RosGraph) -> None:
    menu = master.rosrun("control_node.py")
    menu.says("press 1-4", 30.0)
    for wrong in ("12", "one", ""):
        menu.type(wrong)
    menu.end_of_input()
    assert menu.ends(20.0) == 0
    assert menu.output.count("Please choose a valid number") == 3


def test_without_a_robot_it_says_so_and_goes_on(master: RosGraph) -> None:
    menu = master.rosrun("control_node.py")
    menu.says("Select: ", 30.0)
    menu.type("2")
    menu.says("is the robot running", 30.0)
    menu.end_of_input()
    assert menu.ends(20.0) == 0


def test_without_a_master_it_says_so(master: RosGraph) -> None:
    elsewhere = {"ROS_MASTER_URI": "http://127.0.0.1:9"}
    menu = master.rosrun("control_node.py", environment=elsewhere)
    assert menu.ends(20.0) == 1
    assert "no ROS master answers at http://127.0.0.1:9" in menu.output
