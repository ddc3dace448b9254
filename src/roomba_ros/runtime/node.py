"""The life of a node: register, wait for the clock, start, tick, stop; or say why not, exit 1."""

from __future__ import annotations

import gc
import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import NoReturn, Protocol

import rospy

from roomba.client.protocol import RobotUnavailableError
from roomba.errors import RoombaError
from roomba_ros.runtime.connections import guard_connections
from roomba_ros.runtime.graph.joining import join_graph
from roomba_ros.runtime.graph.master import master_state, require_answering
from roomba_ros.runtime.sending import send_at_once
from roomba_ros.runtime.subscriptions import tell_refusals
from roomba_ros.runtime.timing.heart import HEART
from roomba_ros.runtime.timing.progress import Progress
from roomba_ros.runtime.timing.ticker import Ticker

_asked_to_end = threading.Event()
_has_begun = threading.Event()
"""Set when the start is over; before that no loop looks whether the node is to end."""

CLOCK_DEADLINE = 10.0
"""s of wall time that a node waits for the first /clock message."""
LEAVING = 1.0
"""s of wall time that a node takes to leave the graph; then it ends without that."""


class Node(Protocol):
    """What a node class offers to :func:`run_node`."""

    period: float
    """s of the ROS clock between two ticks."""

    def start(self) -> None:
        """Read parameters and connect; raises RoombaError when it cannot work."""

    def tick(self, now: float) -> None:
        """Do the work of one period; ``now`` in s of the ROS clock."""

    def stop(self) -> None:
        """Leave the robot safe; connections are still there."""


def run_node(name: str, make: Callable[[], Node]) -> None:
    """Be the ROS node ``name`` until it is told to end."""
    require_master()
    register(name)
    try:
        wait_for_clock()
        tell_refusals()
        node = make()
        node.start()
    except RoombaError as error:
        give_up(str(error))
    settle()
    rospy.core.add_preshutdown_hook(lambda reason: _stop(node))
    progress = Progress()
    progress.start(name)

    def tick(now: float) -> None:
        try:
            node.tick(now)
            progress.tell(now)
        except (rospy.ROSException, ValueError):
            # Another node may shut this one down: another thread closes the connections then.
            if not rospy.core.is_shutdown_requested():
                raise

    Ticker(node.period, told_to_end).run(tick)
    leave(0)


def settle() -> None:
    """End the start: signs of life are given from now on, and a signal only asks it to end.

    Objects made until now are excluded from garbage collection: there are hundreds of thousands, of
    imports and compiled functions. A collection of all of them takes up to 0.1 s, in which nothing
    ticks.
    """
    _has_begun.set()
    gc.collect()
    gc.freeze()
    HEART.begin()


def _stop(node: Node) -> None:
    try:
        node.stop()
    except rospy.ROSException as error:
        # The connections were closed already, from another thread.
        rospy.logdebug("stopped without a last word: %s", error)


def register(name: str) -> None:
    """Become the ROS node ``name``; SIGINT and SIGTERM ask it to end, see told_to_end.

    Until :func:`settle` a signal ends the node at once, without unregistering, as a kill does: a
    start may take long and never looks whether it is to end. rospy's own handler does the shutdown
    inside the interrupted main thread, and hangs for ever if that thread was just calling the
    master.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _on_ending)
    guard_connections()
    send_at_once()
    # When the disk refuses the log, each line of it would otherwise print a traceback.
    logging.raiseExceptions = False
    join_graph(name)


def _on_ending(*_: object) -> None:
    _asked_to_end.set()
    if not _has_begun.is_set():
        # The interrupted code may catch the exception. A timer by signal, not a thread: to start a
        # thread takes a lock that the interrupted code may hold.
        signal.signal(signal.SIGALRM, lambda *_: os._exit(0))
        signal.setitimer(signal.ITIMER_REAL, LEAVING)
        raise SystemExit(0)


def told_to_end() -> bool:
    """Whether a signal, the master or another node told this one to end.

    Main loops call it again and again; each call is this process's sign of life.
    """
    HEART.beat()
    return _asked_to_end.is_set() or bool(rospy.is_shutdown())


def require_master() -> None:
    """End the process with one clear line when no ROS master answers."""
    try:
        require_answering(master_state())
    except RobotUnavailableError as error:
        give_up(str(error))


def wait_for_clock() -> None:
    """Wait until the ROS clock runs; raises RoombaError when no /clock comes in time."""
    deadline = time.monotonic() + CLOCK_DEADLINE
    while not told_to_end() and rospy.get_time() == 0.0:
        if time.monotonic() > deadline:
            raise RoombaError(
                f"/use_sim_time is true, but nothing published /clock within {CLOCK_DEADLINE:g} s; "
                "start home_sim_node, or `rosparam set /use_sim_time false`"
            )
        time.sleep(0.02)


def leave(status: int) -> NoReturn:
    """Unregister, and end the process with ``status``: at once, however long the graph may take.

    rospy waits five seconds for each of its threads, and one of them may be calling a node that is
    ending too. The node has published its last message before.
    """
    too_long = threading.Timer(LEAVING, os._exit, (status,))
    too_long.daemon = True
    too_long.start()
    rospy.signal_shutdown("done")
    sys.stdout.flush()
    sys.stderr.flush()
    # Not sys.exit: tearing down the interpreter and its threads takes most of a second.
    os._exit(status)


def give_up(reason: str) -> NoReturn:
    """End the process with one clear line and status 1."""
    if rospy.core.is_initialized():
        rospy.logfatal(reason)
    else:
        print(reason, file=sys.stderr)
    sys.exit(1)


def frame_id(name: str) -> str:
    """Return the tf frame of this robot for ``name``; robots in namespaces have their own."""
    namespace = rospy.get_namespace().strip("/")
    return f"{namespace}/{name}" if namespace else name
