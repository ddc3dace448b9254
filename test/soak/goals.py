"""Thousands of goals of five clients, cancelled at random moments: each ends once, and soon."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fixtures.graph import RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.probe import Probe
from roomba_robot.msg import (
    CleanAction,
    CleanGoal,
    DockAction,
    DockGoal,
    PositionAndDestination,
    UndockAction,
    UndockGoal,
    WalkToPointAction,
    WalkToPointGoal,
)
from soak.arena import Arena
from soak.rows import Row, in_child, tell, until

from roomba_ros.runtime.action_client import GoalClient

GOALS: Final = 10_000
CANCELLED: Final = 0.5
"""s of the robot's clock from a cancel to the goal's end, for 99 of 100."""
_SHARE: Final = 0.5
"""Of the goals that are cancelled."""
_PAUSE: Final = 0.1
"""s of wall time between two goals of one client, at most; a cancel comes within it."""
_ENDED: Final = 60.0
"""s of wall time until the last goals have ended."""
_READY: Final = 60.0
_FAREST: Final = 5.0
"""m; some walks lead out of the home."""


def goals(arena: Arena) -> list[Row]:
    """Send goals of all kinds, and cancel every second one."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}")

        def work() -> list[Row]:
            # This node uses the robot's clock, too.
            Probe(graph, "soak")
            return send_goals(arena.random, GOALS)

        rows = in_child(arena.folder, work, 3000.0)
        errors = [line for line in graph.programs[0].output.splitlines() if "[ERROR]" in line]
        rows[0].broken += [f"{len(errors)} lines of error: {errors[0][:200]}"] if errors else []
        return rows


class Sender:
    """One client: sends its goals one after the other, and sees each end."""

    def __init__(self, name: str, action: type, goal: Callable[[], Any], seed: int) -> None:
        """Connect to the action."""
        self.name, self._goal, self._random = name, goal, random.Random(seed)
        self.client = GoalClient(name, action)
        self.ends: dict[int, list[int]] = {}
        """How each goal ended, by its number; more than once would be wrong."""
        self.cancels: list[float] = []
        """s of the robot's clock from a cancel to the end of its goal."""
        self._cancelled: dict[int, float] = {}
        self._handles: dict[int, Any] = {}

    def is_connected(self) -> bool:
        """Whether its server is there."""
        return bool(self.client.wait_for_server(rospy.Duration(0.01)))

    def run(self, number: int) -> None:
        """Send so many goals."""
        for which in range(number):
            self.ends[which] = []
            self._handles[which] = handle = self.client.send_goal(
                self._goal(), lambda told, which=which: self._on_transition(told, which)
            )
            time.sleep(self._random.uniform(0.0, _PAUSE))
            if self._random.random() < _SHARE:
                if not self.ends[which]:
                    self._cancelled[which] = rospy.get_time()
                handle.cancel()

    def left(self) -> int:
        """Return how many goals have not ended."""
        return sum(not ends for ends in self.ends.values())

    def _on_transition(self, handle: Any, which: int) -> None:
        if handle.get_comm_state() == CommState.DONE:
            self.ends[which].append(handle.get_terminal_state())
            if which in self._cancelled:
                self.cancels.append(rospy.get_time() - self._cancelled[which])
            self._handles.pop(which, None)


def send_goals(random: random.Random, number: int) -> list[Row]:
    """Send so many goals of five clients to a robot that runs."""

    def walk() -> WalkToPointGoal:
        x, y = random.uniform(-_FAREST, _FAREST), random.uniform(-_FAREST, _FAREST)
        return WalkToPointGoal(PositionAndDestination(0.0, 0.0, x, y))

    senders = [
        *(Sender("walk_to_point", WalkToPointAction, walk, seed) for seed in (1, 2)),
        Sender("clean", CleanAction, CleanGoal, 3),
        Sender("dock", DockAction, DockGoal, 4),
        Sender("undock", UndockAction, UndockGoal, 5),
    ]
    for sender in senders:
        until(sender.is_connected, _READY)
    tell(f"{number} goals of {len(senders)} clients")
    began = time.monotonic()
    threads = [
        threading.Thread(target=sender.run, args=(number // len(senders),)) for sender in senders
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    row = Row("goals, every second one cancelled", sum(len(sender.ends) for sender in senders))
    row.measured("goals a second", row.times / (time.monotonic() - began))
    until(lambda: not any(sender.left() for sender in senders), _ENDED)
    for sender in senders:
        _judge(sender, row)
    return [row, *(_cancelled(sender) for sender in senders)]


def _cancelled(sender: Sender) -> Row:
    """Return how soon a client's cancels ended their goals."""
    row = Row(f"cancels of {sender.name}", len(sender.cancels))
    took = float(np.quantile(sender.cancels, 0.99))
    row.expect("99 of 100, s of its clock", took, CANCELLED)
    row.measured("all", max(sender.cancels))
    return row


def _judge(sender: Sender, row: Row) -> None:
    """Note goals that did not end, ended twice, or were lost."""
    if left := sender.left():
        row.broken.append(f"{sender.name}: {left} goals have not ended")
    if again := sum(len(ends) > 1 for ends in sender.ends.values()):
        row.broken.append(f"{sender.name}: {again} goals ended more than once")
    lost = sum(GoalStatus.LOST in ends for ends in sender.ends.values())
    if lost:
        row.broken.append(f"{sender.name}: {lost} goals are lost")
