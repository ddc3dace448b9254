"""The supervisor's output becomes topics; and the log of all nodes is in one place."""

import json
import os
import sys

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

NODE = """
import os
from roomba_ros.supervision.supervisor_node import be_supervisor_node
be_supervisor_node(os.open({path!r}, os.O_RDONLY))
"""


def test_trouble_is_told_as_text_and_as_diagnostics(graph: RosGraph) -> None:
    pipe = graph.folder / "pipe"
    os.mkfifo(pipe)
    node = graph.run(sys.executable, "-c", NODE.format(path=str(pipe)))
    with pipe.open("wb", buffering=0) as writing:
        probe = Probe(graph)
        probe.hear("/trouble", String)
        wait_until(lambda: probe.newest.get("/trouble") == String(""), 30.0, "all is well at first")
        lines = [{"a": "a ended", "b": ""}, {"a": "a is stopped", "b": "b ended"}]
        # Of several lines the newest counts, and one comes in parts.
        text = "".join(json.dumps(line) + "\n" for line in lines).encode()
        writing.write(text[:60])
        writing.write(text[60:])
        wait_until(lambda: probe.newest["/trouble"].data == "a is stopped; b ended", 30.0)
        told = probe.next("/diagnostics", DiagnosticArray)
        assert [(s.name, s.level, s.message) for s in told.status] == [
            ("a: process", DiagnosticStatus.ERROR, "a is stopped"),
            ("b: process", DiagnosticStatus.ERROR, "b ended"),
        ]
        probe.hear("/rosout_agg", Log)
        log = Log(msg="it is logged", level=Log.WARN)

        def is_passed_on() -> bool:
            probe.send("/rosout", log)
            return "/rosout_agg" in probe.newest

        wait_until(is_passed_on, 20.0, "the log is passed on", pause=0.1)
        assert probe.newest["/rosout_agg"].msg == "it is logged"
        writing.write(b'{"a": "", "b": ""}\n')
        wait_until(lambda: probe.newest["/trouble"].data == "", 30.0, "all is well again")
    assert node.ends(20.0) == 0
