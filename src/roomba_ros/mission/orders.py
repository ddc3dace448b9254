"""The mission's actions and services, obeyed by a tick."""

from __future__ import annotations

import queue
import time
from collections import deque
from collections.abc import Callable

import rospy
from roomba_robot.msg import VacuumState
from roomba_robot.srv import ChangeRooms, ChangeRoomsRequest, ChangeRoomsResponse
from std_msgs.msg import Empty
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from roomba.configuration.nodes import DeadlinesConfig
from roomba.errors import RoombaError
from roomba.mission.inputs.senses import Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Event
from roomba.storage.checkpoint import Goal
from roomba.vocabulary import Phase
from roomba_ros.convert.clean_action import ways_of
from roomba_ros.mission.asked import (
    Cancel,
    CommandOrder,
    GoalOrder,
    GoalUnderWay,
    Order,
    RoomsOrder,
)
from roomba_ros.mission.goals import GOALS, Ended
from roomba_ros.runtime.action_goal import GoalIdentity, server_of
from roomba_ros.runtime.held_drive import HeldDrive


class MissionOrders:
    """Obeys one goal at a time; a newer one of any action takes over.

    :meth:`answer` and :meth:`follow` tell what came of an order. Call them after the state is
    published, so that a caller with an answer finds the state that it is about.

    Publishes: ``clean/{feedback,result,status}``, ``dock/…``, ``undock/…``, ``explore/…``,
    ``beep`` (Empty: here the robot is).
    Subscribes: ``clean/{goal,cancel}``, ``dock/…``, ``undock/…``, ``explore/…``,
    ``emergency_stop`` (String).
    Services: ``pause``, ``resume``, ``stop``, ``empty_bin``, ``empty_at_station``, ``locate``
    (Trigger), ``change_rooms`` (ChangeRooms).
    """

    def __init__(self, takes_drive: Callable[[], None], deadlines: DeadlinesConfig) -> None:
        """Connect nothing yet; ``takes_drive`` is called when the mission is about to drive."""
        self._under_way, self._answer_within = GoalUnderWay(takes_drive), deadlines.answer
        self._asked: deque[Order] = deque()
        self._emergency: str | None = None
        self._engaged = ""
        self._serves = False
        self._serves_by = time.monotonic() + deadlines.senses

    def start(self) -> None:
        """Connect; goals are taken from the first :meth:`serve` on."""
        self._servers = [
            server_of(
                kind,
                lambda goal: self.ask(GoalOrder(goal)),
                lambda identity: self.ask(Cancel(identity)),
            )
            for kind in GOALS
        ]
        self._beep = rospy.Publisher("beep", Empty, queue_size=1)
        HeldDrive(self.hold).start()
        for name, event in (
            ("pause", Event.PAUSE),
            ("resume", Event.RESUME),
            ("stop", Event.STOP),
            ("empty_bin", Event.EMPTIED),
            ("empty_at_station", Event.EMPTY),
        ):
            rospy.Service(name, Trigger, lambda _, event=event: self._on_order(event))
        rospy.Service("locate", Trigger, self._on_locate)
        rospy.Service("change_rooms", ChangeRooms, self._on_rooms)

    def ask(self, asked: Order) -> None:
        """Queue an order for the next :meth:`obey`."""
        self._asked.append(asked)

    def hold(self, reason: str) -> None:
        """Take an emergency stop for a reason; an empty reason releases it."""
        if reason:
            # Kept for the next tick even if a release comes before it.
            self._engaged = reason
        self._emergency = reason

    @property
    def goal(self) -> GoalIdentity | None:
        """The goal of the errand that is under way, if a client gave it."""
        return None if self._under_way.goal is None else self._under_way.goal.identity

    def adopt(self, goal: Goal | None) -> None:
        """Resume an errand's goal from before a restart: its client waits for the end."""
        if goal is None or self._serves:
            return
        identity = GoalIdentity(*goal)
        for kind, server in zip(GOALS, self._servers, strict=True):
            if kind.name == identity.action:
                self._under_way.goal = kind(server.adopt(identity))

    def serve(self, is_ready: bool) -> None:
        """Take goals from now on, if the mission is ready or did not become so in time."""
        if self._serves or not (is_ready or time.monotonic() > self._serves_by):
            return
        self._serves = True
        for server in self._servers:
            server.start()

    def refuse(self, reason: str) -> None:
        """Refuse all queued orders: there is no mission yet."""
        while self._asked:
            self._asked.popleft().refuse(reason)

    def obey(self, mission: Mission, senses: Senses, *, begins: bool = True) -> None:
        """Let the mission obey the queued orders; goals stay queued unless it ``begins`` errands.

        So a clean that follows an edit of zones begins with the new zones, and no other order
        waits. A queued goal ends when the robot is told to stop or pause: it must not set off after
        that.
        """
        self._obey_emergency_stop(mission, senses)
        waiting = self._under_way.waiting = []
        while self._asked:
            asked = self._asked.popleft()
            if asked.waits and not begins:
                waiting.append(asked)
            else:
                asked.obey(self._under_way, mission, senses)
        self._asked.extendleft(reversed(waiting))

    def answer(self) -> None:
        """Tell what came of what was obeyed."""
        self._under_way.answer()

    def follow(self, mission: Mission, senses: Senses) -> Ended:
        """Tell the end of what ended; return the results of what did, ordered or not."""
        return self._under_way.follow(mission, senses)

    def tell(self, state: VacuumState) -> None:
        """Send the progress to the client of the errand under way."""
        if self._under_way.goal is not None:
            self._under_way.goal.tell(state)

    def give_up(self, reason: str) -> None:
        """End what was ordered; its order is not fulfilled."""
        self._under_way.give_up(reason)

    def _obey_emergency_stop(self, mission: Mission, senses: Senses) -> None:
        """Hold the mission or release it; a stop counts that came and went between two ticks."""
        engaged, self._engaged = self._engaged, ""
        reason = self._emergency or engaged
        if reason and mission.state.phase is not Phase.EMERGENCY:
            mission.command(Event.EMERGENCY, senses, reason)
        if self._emergency == "" and mission.state.phase is Phase.EMERGENCY:
            mission.command(Event.RELEASE, senses)

    def _on_order(self, event: Event) -> TriggerResponse:
        return TriggerResponse(*self._answer_to(CommandOrder(event)))

    def _on_rooms(self, request: ChangeRoomsRequest) -> ChangeRoomsResponse:
        try:
            each = ways_of(request.room_passes, request.room_fans)
        except RoombaError as error:
            return ChangeRoomsResponse(False, str(error))
        return ChangeRoomsResponse(*self._answer_to(RoomsOrder(tuple(request.rooms), each)))

    def _answer_to(self, order: CommandOrder | RoomsOrder) -> tuple[bool, str]:
        self.ask(order)
        try:
            return order.answer.get(timeout=self._answer_within)
        except queue.Empty:
            late = f"no answer within {self._answer_within:g} s; see vacuum/state, and try again"
            return False, late

    def _on_locate(self, _: TriggerRequest) -> TriggerResponse:
        rospy.loginfo("beep, beep: here is the robot")
        self._beep.publish()
        return TriggerResponse(True, "it beeped")
