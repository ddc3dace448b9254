"""The speed of a running graph, robot s per s, while its robot walks to and fro."""

from __future__ import annotations

import itertools
import threading
import time

import actionlib
import rospy
from roomba_robot.msg import PositionAndDestination, WalkToPointAction, WalkToPointGoal
from rosgraph_msgs.msg import Clock

from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "rospy"
_LOOK = 0.25
"""s of wall time between two looks at the clock."""
_CONNECT_DEADLINE = 20.0
_WALK_DEADLINE = 60.0


def prepare(parameters: Parameters) -> Work:
    """Begin to walk; return once the first walk has ended well."""
    rospy.init_node("bench_clock", anonymous=True, disable_signals=True)
    newest = 0.0

    def on_clock(message: Clock) -> None:
        nonlocal newest
        newest = message.clock.to_sec()

    rospy.Subscriber("/clock", Clock, on_clock, queue_size=1, tcp_nodelay=True)
    walks = actionlib.SimpleActionClient("walk_to_point", WalkToPointAction)
    arrived = threading.Semaphore(0)

    def walk() -> None:
        for x, y in itertools.cycle(parameters["points"]):
            goal = WalkToPointGoal(PositionAndDestination(dest_x=x, dest_y=y))
            if walks.send_goal_and_wait(goal) == actionlib.GoalStatus.SUCCEEDED:
                arrived.release()
            else:
                time.sleep(_LOOK)

    end = time.monotonic() + _CONNECT_DEADLINE
    while newest == 0.0 or not walks.action_client.wait_for_server(rospy.Duration(1.0)):
        if time.monotonic() > end:
            raise TimeoutError(f"no clock or no action server within {_CONNECT_DEADLINE:g} s")
        time.sleep(0.05)
    threading.Thread(target=walk, daemon=True).start()
    if not arrived.acquire(timeout=_WALK_DEADLINE):
        raise TimeoutError(f"no walk was done within {_WALK_DEADLINE:g} s")

    def look() -> float:
        before = newest
        time.sleep(_LOOK)
        return newest - before

    return Work(look)
