"""What ROS costs: a round trip, what a node of ours adds, and the speed of the whole graph."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from roomba_bench.bench import Bench
from roomba_bench.contestants import ContestantError, Program
from roomba_bench.peers.protocol import Parameters
from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.ros.graph import NO_ROS, Graph, free_port, has_ros
from roomba_bench.ros.processes import family_of, load, memory
from roomba_bench.rounds import Outcome, milliseconds

_TOPIC = "ros"
_REAL_TIME_AIM = 50.0
_MOST_ADDED = 20.0
"""% that a node may add to the bare round trip."""
_SIZES = {"64 B": ("message of 64 B", 64), "scan": ("scan of 360 beams", 1516)}
"""By kind of message: its name in the table, and its bytes on the wire."""
_APART = 0.06
"""s between two commands: more than a tick, as a more frequent command waits for the next tick."""
_FASTEST = 100
"""The speed asked of the simulation; how far its real speed falls behind is measured."""
_START, _MOST_LOAD, _MOST_MEMORY = 5.0, 25.0, 600.0
"""s, % of a core, and MB that the whole graph may take."""
_SETTLED = 10.0
"""s from its goal until the robot cleans."""
_POINTS = ((2.5, 5.0), (8.5, 5.0))
"""m; the corridor of the apartment."""


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    if not has_ros():
        reason = f"{NO_ROS}; run it as ./roomba bench"
        return [Record(_TOPIC, "rospy", "round trip", None, "ms", Better.LOWER, error=reason)]
    bench.say("round trips")
    records = _round_trips(bench)
    bench.say(f"the whole graph, asked to run at {_FASTEST} x real time")
    records.append(_real_time_row(bench))
    bench.say("what the whole graph takes while it cleans")
    return records + _cost_rows(bench)


def _round_trips(bench: Bench) -> list[Record]:
    """Return bare round trips beside TCP, and one through a node beside a bare one."""
    with Graph(_folder(bench, "trips")) as graph:
        try:
            graph.start_master()
        except ContestantError as error:
            row = Record(_TOPIC, "rospy", "round trip", None, "ms", Better.LOWER, error=str(error))
            return [row]
        records = [_bare_row(bench, graph, kind) for kind in _SIZES]
        graph.start("rosrun", "roomba_robot", "speed_pub_node.py")
        [node, bare] = bench.compete(
            [
                _ping(graph, "through speed_pub_node", "twist", "/cmd_vel", "/cmd_vel_out", _APART),
                _bare(graph, "twist", _APART),
            ]
        )
    return [*records, *_node_rows(node, bare)]


def _bare_row(bench: Bench, graph: Graph, kind: str) -> Record:
    case, size = _SIZES[kind]
    rospy, tcp = bench.compete(
        [_bare(graph, kind), bench.peer("raw TCP", "transport.tcp", {"bytes": size})]
    )
    return _trip_row(f"rospy to rospy and back, {case}", rospy, (tcp.figure(milliseconds),))


def _node_rows(node: Outcome, bare: Outcome) -> list[Record]:
    case = "a command every 60 ms in, a command for the drive out: speed_pub_node"
    row = _trip_row(case, node, (bare.figure(milliseconds),))
    added, reason = None, node.error or bare.error
    if node.rate is not None and bare.rate is not None:
        added = 100.0 * (bare.rate / node.rate - 1.0)
    figure = "added to the bare round trip"
    return [row, Record(_TOPIC, case, figure, added, "%", Better.LOWER, _MOST_ADDED, error=reason)]


def _trip_row(case: str, outcome: Outcome, peers: tuple[PeerFigure, ...]) -> Record:
    value = None if outcome.rate is None else milliseconds(outcome.rate)
    return Record(
        _TOPIC, case, "round trip", value, "ms", Better.LOWER, peers=peers, error=outcome.error
    )


def _bare(graph: Graph, kind: str, apart: float = 0.0) -> Program:
    """Start a node that echoes; return the client that calls it."""
    topics = [f"/{way}_{kind.replace(' ', '_')}" for way in ("ping", "pong")]
    names = [f"{name}:={topic}" for name, topic in zip(("ping", "pong"), topics, strict=True)]
    graph.start(sys.executable, "-m", "roomba_bench.ros.echo", kind, *names)
    ping, pong = topics
    return _ping(graph, "bare rospy", kind, ping, pong, apart)


def _ping(graph: Graph, name: str, kind: str, ping: str, pong: str, apart: float = 0.0) -> Program:
    parameters = {"kind": kind, "ping": ping, "pong": pong, "apart": apart}
    return _program(graph, name, "ping", parameters)


def _real_time_row(bench: Bench) -> Record:
    """Return how many robot s pass in a s of wall time while the robot walks."""
    with Graph(_folder(bench, "graph")) as graph:
        try:
            graph.launch("home:=apartment", f"speed:={_FASTEST}")
            parameters = {"points": _POINTS}
            [outcome] = bench.compete([_program(graph, "graph", "clock", parameters)])
        except ContestantError as error:
            outcome = Outcome("graph", error=str(error))
    return Record(
        _TOPIC,
        "all nodes of ./roomba run, walking in the apartment",
        "robot seconds per second",
        outcome.rate,
        "x real time",
        Better.HIGHER,
        _REAL_TIME_AIM,
        error=outcome.error,
    )


def _cost_rows(bench: Bench) -> list[Record]:
    """Return how soon all nodes are up, and what they take while the robot cleans in real time."""
    case = "all of ./roomba run with its page, cleaning the flat in real time"
    began = time.monotonic()
    with Graph(_folder(bench, "cost")) as graph:
        try:
            pid = graph.run_robot("page:=true", "open_page:=false", f"page_port:={free_port()}")
        except ContestantError as error:
            row = Record(_TOPIC, case, "start", None, "s", Better.LOWER, _START, error=str(error))
            return [row]
        start = time.monotonic() - began
        goal = ("/clean/goal", "roomba_robot/CleanActionGoal", "{}")
        graph.start("rostopic", "pub", "--once", *goal)
        time.sleep(_SETTLED)
        family = family_of(pid)
        used = load(family, 5.0 if bench.is_quick else 20.0)
        size = memory(family)
    return [
        Record(_TOPIC, case, "start until all nodes are up", start, "s", Better.LOWER, _START),
        Record(_TOPIC, case, "CPU of all processes", used, "% core", Better.LOWER, _MOST_LOAD),
        Record(
            _TOPIC,
            case,
            "memory, shared counted once",
            size,
            "MB",
            Better.LOWER,
            _MOST_MEMORY,
        ),
    ]


def _program(graph: Graph, name: str, module: str, parameters: Parameters) -> Program:
    command = (sys.executable, "-m", "roomba_bench.peers", f"roomba_bench.ros.{module}")
    return Program(name, command, parameters, graph.environment)


def _folder(bench: Bench, name: str) -> Path:
    folder = bench.folder / name
    folder.mkdir()
    return folder
