"""``./roomba run`` goes on when its master or a node is killed or stopped, and says so."""

import contextlib
import os
import signal
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fixtures.graph import LAUNCHED, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.nodes.onlooker import Onlooker
from fixtures.probe import Probe
from fixtures.processes.programs import is_running, listening, processes_of
from fixtures.waiting import promised, wait_until
from nav_msgs.msg import Odometry
from roomba_robot.srv import EmergencyStop
from std_msgs.msg import String
from std_srvs.srv import Trigger

from roomba_ros.supervision.run import USAGE
from roomba_ros.supervision.run import main as be_robot

NOTICED = 1.0
"""s of wall time; by then a process that ended or is stopped is told of."""
BACK = 5.0
"""s of wall time; by then it is back, and what the robot did goes on."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in two little rooms."""
    folder = tmp_path_factory.mktemp("robot")
    with RosGraph(folder) as own:
        own.launch(f"home:={tiny_home(folder)}", "speed:=2")
        yield own


class Owner(Onlooker):
    """Hears what the vacuum does, and how the robot's processes are."""

    def __init__(self, graph: RosGraph) -> None:
        super().__init__(graph)
        self.trouble: list[str] = []
        self.troubled: set[str] = set()
        rospy.Subscriber("/trouble", String, lambda told: self.trouble.append(told.data))
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)
        wait_until(lambda: self.trouble and self.trouble[-1] == "", 60.0, lambda: f"{self.trouble}")
        wait_until(lambda: self.state.phase, 60.0, "the state of the vacuum")

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            name, _, part = status.name.partition(": ")
            if part == "process" and status.level == DiagnosticStatus.ERROR:
                self.troubled.add(name)

    def cleans(self) -> None:
        """Let it clean anew, and wait until some floor is clean."""
        if self.state.phase not in ("", "docked", "idle"):
            rospy.ServiceProxy("/stop", Trigger)()
        super().cleans()


def is_kept(mark: str) -> bool:
    """Whether a master has it on the disk; a folder may vanish that is another robot's."""
    with contextlib.suppress(FileNotFoundError):
        kept = Path(tempfile.gettempdir()).glob("roomba_run_*/master.xml")
        return any(mark in file.read_text("utf-8", "replace") for file in kept)
    return False


def test_a_new_master_knows_all_and_the_clean_goes_on(shared_robot: RosGraph) -> None:
    owner = Owner(shared_robot)
    owner.cleans()
    before = shared_robot.system_state()
    # Of this robot alone; other parameters have its folder as well.
    mark = f"kept of {shared_robot.folder}"
    shared_robot.set_param("/kept", mark)
    wait_until(lambda: is_kept(mark), 10.0, "the master has kept what it knows")
    hold = rospy.ServiceProxy("/emergency_stop", EmergencyStop, persistent=True)
    assert hold(False, "").success
    os.kill(shared_robot.process("master"), signal.SIGKILL)
    # By a connection from before, the emergency stop works without a master.
    assert hold(False, "").success
    promised(lambda: shared_robot.master_answers(), BACK, "a master answers")
    assert shared_robot.param("/kept") == mark
    after = shared_robot.system_state()
    for known, known_again in zip(before, after, strict=True):
        lost = {name for name in known if not set(known[name]) <= set(known_again.get(name, []))}
        assert lost == set()
    assert rospy.ServiceProxy("/emergency_stop", EmergencyStop)(False, "").success
    owner.goes_on()


@pytest.mark.parametrize("node", ["mission_node", "position_pub_node"])
def test_a_stopped_node_is_told_replaced_and_the_clean_goes_on(
    shared_robot: RosGraph, node: str
) -> None:
    owner = Owner(shared_robot)
    owner.cleans()
    os.kill(shared_robot.process(node), signal.SIGSTOP)
    told = f"{node} is stopped; if it stays so, it is started anew"

    def is_told() -> bool:
        # Stopped, the mission says nothing itself.
        is_said = node == "mission_node" or any(told in said for said in owner.messages)
        return told in owner.trouble and node in owner.troubled and is_said

    promised(is_told, NOTICED, "it is told as trouble, as diagnostics and as the vacuum's state")
    promised(lambda: owner.trouble[-1] == "", NOTICED + BACK + 2.0, "all is well again")
    owner.goes_on()


def test_it_listens_on_loopback_alone(shared_robot: RosGraph) -> None:
    there = listening(processes_of(shared_robot.programs[0].process.pid))
    # At least the master's port, and of each node those for requests and for messages.
    assert len(there) > 2 * len(LAUNCHED)
    assert {address for address, _ in there} == {"127.0.0.1"}


def test_a_killed_node_is_told_and_back(shared_robot: RosGraph) -> None:
    owner = Owner(shared_robot)
    old = shared_robot.signal("dirt_pub_node", signal.SIGKILL)
    promised(
        lambda: "dirt_pub_node was ended by SIGKILL; it is started anew" in owner.trouble,
        NOTICED,
        "it is told",
    )
    promised(
        lambda: shared_robot.answers("dirt_pub_node") and shared_robot.pid("dirt_pub_node") != old,
        BACK,
        "it is back",
    )


@pytest.mark.parametrize("seconds", [0.6, 2.5])
def test_ctrl_c_during_the_start_ends_it_without_a_traceback(
    tmp_path: Path, seconds: float
) -> None:
    with RosGraph(tmp_path) as graph:
        run = graph.start_run()
        time.sleep(seconds)  # of the start, which takes three
        run.send_to_leader(signal.SIGINT)
        # Before it has begun, the signal ends it as any program.
        assert run.ends(10.0) in (0, -signal.SIGINT)
        assert "Traceback" not in run.output, run.output


def test_a_master_whose_host_has_no_address_is_refused(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_MASTER_URI", "http://nowhere.invalid:11311")
    assert be_robot([]) == USAGE
    assert "expected the host of the master, nowhere.invalid, to have" in capfd.readouterr().err


def test_a_second_run_beside_the_first_is_refused(shared_robot: RosGraph) -> None:
    second = shared_robot.start_run()
    assert second.ends(60.0) == 2
    assert "expected no such robot on" in second.output
    assert "/home_sim_node" in second.output
    assert shared_robot.all_up()


def test_a_killed_run_leaves_nothing_and_the_next_one_is_whole(shared_robot: RosGraph) -> None:
    """The last one here: it kills what the others share."""
    pids = [shared_robot.pid(node) for node in LAUNCHED]
    os.kill(shared_robot.programs[0].process.pid, signal.SIGKILL)
    promised(lambda: not any(is_running(pid) for pid in pids), 3.0, "gone")
    again = shared_robot.launch(f"home:={tiny_home(shared_robot.folder)}")
    Probe(shared_robot).next("/odom", Odometry)
    again.send_to_leader(signal.SIGINT)
    assert again.ends(10.0) == 0
