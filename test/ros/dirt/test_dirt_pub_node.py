import time

from fixtures.graph import RosGraph
from fixtures.probe import Probe
from std_msgs.msg import Float32


def test_it_tells_the_sensors_newest_value_five_times_a_second(graph: RosGraph) -> None:
    graph.rosrun("dirt_pub_node.py")
    probe = Probe(graph)
    probe.send("/dirt_raw", Float32(0.25))
    assert probe.next("/dirt", Float32).data == 0.25
    probe.send("/dirt_raw", Float32(0.5))
    begin, count = time.monotonic(), probe.counts["/dirt"]
    while probe.counts["/dirt"] < count + 11:
        probe.next("/dirt", Float32)
    # A busy machine may be late.
    assert 0.15 < (time.monotonic() - begin) / 11 < 1.0
    assert probe.newest["/dirt"].data == 0.5
