"""``./roomba record`` over a graph: all messages are kept, also after a kill; and mishaps."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
import rosbag
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes.programs import Program
from fixtures.waiting import unchanged, wait_until
from roomba_robot.msg import VacuumState
from rosgraph_msgs.msg import Clock, Log
from std_msgs.msg import Float32, String

from roomba.recordings.bag_format.mending import mend_bag, needs_mending
from roomba_ros.bags.record import main


def record(graph: RosGraph, *arguments: str) -> Program:
    return graph.run(sys.executable, "-m", "roomba_ros.bags.record", *arguments)


class Teller(Probe):
    """A node that tells a count on one topic as often as it can be heard, and a map once."""

    def __init__(self, graph: RosGraph) -> None:
        super().__init__(graph, "teller")
        self.map = rospy.Publisher("/map", String, queue_size=1, latch=True)
        self.map.publish("a map")
        self.count = rospy.Publisher("/count", Float32, queue_size=100)
        self.told = 0
        self.at: list[float] = []

    def tell(self, times: int) -> None:
        """Tell so many numbers, fifty a second."""
        for _ in range(times):
            self.count.publish(float(self.told))
            self.at.append(rospy.get_time())
            self.told += 1
            rospy.sleep(0.02)

    def is_heard(self) -> bool:
        return all(each.get_num_connections() > 0 for each in (self.count, self.map))


def counts(path: Path) -> list[int]:
    with rosbag.Bag(str(path)) as bag:
        return [int(message.data) for _, message, _ in bag.read_messages("/count")]


def test_all_is_recorded_until_it_is_told_to_end(graph: RosGraph, tmp_path: Path) -> None:
    teller, path = Teller(graph), tmp_path / "run.bag"
    again = rospy.Publisher("/rosout_agg", Log, queue_size=1, latch=True)
    again.publish(Log(msg="what was told on /rosout"))
    recorder = record(graph, str(path))
    wait_until(teller.is_heard, 30.0, lambda: recorder.output)
    teller.tell(60)
    recorder.send(signal.SIGINT)
    assert recorder.ends(20.0) == 0, recorder.output
    assert not needs_mending(path)
    assert counts(path) == list(range(60))
    with rosbag.Bag(str(path)) as bag:
        assert [message.data for _, message, _ in bag.read_messages("/map")] == ["a map"]
        types = {name: each.msg_type for name, each in bag.get_type_and_topic_info().topics.items()}
    assert types["/count"] == "std_msgs/Float32"
    assert "/rosout_agg" not in types
    second = record(graph, str(path))
    assert second.ends(30.0) == 1
    assert "File exists" in second.output


def test_a_kill_loses_no_more_than_a_second(graph: RosGraph, tmp_path: Path) -> None:
    teller, path = Teller(graph), tmp_path / "killed.bag"
    recorder = record(graph, str(path))
    wait_until(teller.is_heard, 30.0, lambda: recorder.output)
    teller.tell(150)
    killed = rospy.get_time()
    recorder.send(signal.SIGKILL)
    recorder.ends(10.0)
    assert needs_mending(path)
    mended = mend_bag(path)
    kept = counts(path)
    assert kept == list(range(len(kept)))
    assert killed - teller.at[len(kept) - 1] <= 1.0
    assert mended.messages > len(kept) > 50


def test_only_what_is_asked_for(graph: RosGraph, tmp_path: Path) -> None:
    teller, path = Teller(graph), tmp_path / "one.bag"
    recorder = record(graph, str(path), "--topics", "/count")
    wait_until(lambda: teller.count.get_num_connections() > 0, 30.0, lambda: recorder.output)
    teller.tell(20)
    recorder.send(signal.SIGINT)
    assert recorder.ends(20.0) == 0
    with rosbag.Bag(str(path)) as bag:
        assert set(bag.get_type_and_topic_info().topics) == {"/count"}


def test_what_goes_wrong_is_saved_with_what_was_before(graph: RosGraph, tmp_path: Path) -> None:
    teller, folder = Teller(graph), tmp_path / "mishaps"
    trouble = rospy.Publisher("/trouble", String, queue_size=1, latch=True)
    state = rospy.Publisher("/vacuum/state", VacuumState, queue_size=1, latch=True)
    trouble.publish("")
    state.publish(VacuumState(state="cleaning", message="its bin is nearly full"))
    recorder = record(graph, "--when-wrong", str(folder), "--seconds", "3")
    wait_until(
        lambda: (
            teller.is_heard()
            and trouble.get_num_connections() > 0
            and state.get_num_connections() > 0
        ),
        30.0,
        lambda: recorder.output,
    )
    teller.tell(200)
    assert unchanged(lambda: list(folder.iterdir()), 0.1)
    assert list(folder.iterdir()) == []
    wrong = teller.told
    trouble.publish("speed_pub_node was ended by SIGKILL; it is started anew")
    state.publish(VacuumState(state="error", message="both wheels spin"))
    teller.tell(150)
    wait_until(lambda: list(folder.glob("wrong-*.bag")), 30.0, lambda: recorder.output)
    # Told in two ways, it is one mishap.
    (path,) = folder.iterdir()
    assert "speed-pub-node" in path.name or "both-wheels-spin" in path.name
    kept = counts(path)
    assert kept == list(range(kept[0], kept[0] + len(kept)))
    assert kept[0] < wrong < kept[-1]
    with rosbag.Bag(str(path)) as bag:
        assert [message.data for _, message, _ in bag.read_messages("/map")] == ["a map"]
        said = [(message.data, at.to_sec()) for _, message, at in bag.read_messages("/trouble")]
        told = [at.to_sec() for _, _, at in bag.read_messages("/count")]
    trouble_is, at = said[-1]
    assert trouble_is.startswith("speed_pub_node was ended")
    # Three seconds before, as asked for, and two after.
    assert 2.2 < at - told[0] < 3.2
    assert told[-1] - at > 0.8
    recorder.send(signal.SIGINT)
    assert recorder.ends(20.0) == 0
    assert "1 mishaps saved" in recorder.output


def test_a_whole_minute_before_is_saved_however_fast_the_clock_goes(
    graph: RosGraph, tmp_path: Path
) -> None:
    graph.set_param("/use_sim_time", True)
    probe, folder = Probe(graph), tmp_path / "mishaps"
    clock = probe.publisher("/clock", Clock)
    count = probe.publisher("/count", Float32)
    trouble = probe.publisher("/trouble", String)
    recorder = record(graph, "--when-wrong", str(folder))
    tenths = 0

    def tell(done: Callable[[], bool]) -> None:
        """Let the robot's clock go twenty times as fast as ours, and tell each tenth of it."""
        nonlocal tenths
        pace = threading.Event()
        while not done():
            tenths += 1
            clock.publish(Clock(rospy.Time(tenths // 10, tenths % 10 * 10**8)))
            count.publish(float(tenths))
            pace.wait(0.005)

    topics = (clock, count, trouble)
    tell(
        lambda: (
            all(each.get_num_connections() > 0 for each in topics) or recorder.status is not None
        )
    )
    began = tenths
    tell(lambda: tenths > began + 800)
    wrong = tenths
    trouble.publish("mission_node hangs")
    tell(lambda: bool(list(folder.glob("wrong-*.bag"))) or tenths > wrong + 4000)
    kept = counts(next(folder.glob("wrong-*.bag")))
    assert kept == list(range(kept[0], kept[0] + len(kept)))
    assert wrong - 660 < kept[0] < wrong - 540
    assert kept[-1] > wrong + 20


def test_what_was_told_before_the_clock_is_heard_does_not_begin_the_bag_in_1970(
    graph: RosGraph, tmp_path: Path
) -> None:
    graph.set_param("/use_sim_time", True)
    probe, path = Probe(graph), tmp_path / "run.bag"
    clock = probe.publisher("/clock", Clock)
    told = rospy.Publisher("/map", String, queue_size=1, latch=True)
    told.publish("a map")
    recorder = record(graph, str(path))
    # This node hears its own clock.
    wait_until(lambda: clock.get_num_connections() > 1, 30.0, lambda: recorder.output)
    assert unchanged(told.get_num_connections, 1.5)

    def is_heard() -> bool:
        clock.publish(Clock(rospy.Time(1000)))
        return bool(told.get_num_connections() > 0)

    wait_until(is_heard, 30.0, lambda: recorder.output)
    recorder.send(signal.SIGINT)
    assert recorder.ends(20.0) == 0, recorder.output
    with rosbag.Bag(str(path)) as bag:
        assert [message.data for _, message, _ in bag.read_messages("/map")] == ["a map"]
        assert bag.get_start_time() == pytest.approx(1000.0)


def test_without_a_clock_that_is_promised_it_says_so(graph: RosGraph, tmp_path: Path) -> None:
    graph.set_param("/use_sim_time", True)
    recorder = record(graph, str(tmp_path / "a.bag"))
    assert recorder.ends(30.0) == 1
    assert "nothing published /clock" in recorder.output
    assert not (tmp_path / "a.bag").exists()


def test_without_a_master_it_says_so(tmp_path: Path) -> None:
    with RosGraph(tmp_path) as graph:
        recorder = record(graph, str(tmp_path / "a.bag"))
        assert recorder.ends(30.0) == 1
        assert "no ROS master answers" in recorder.output
    assert not (tmp_path / "a.bag").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("a.bag", "--seconds", "5"), "expected --when-wrong as well"),
        (("--topics", "/pose", "a.bag"), "a file stands before the option"),
        (("--when-wrong", "--seconds", "0"), "expected 1 to 3600 s"),
    ],
)
def test_what_makes_no_sense_is_refused_before_a_robot_is_looked_for(
    words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert said in capsys.readouterr().err
