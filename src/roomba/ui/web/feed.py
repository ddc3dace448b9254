"""Looks at the robot ten times a second for all viewers: its state, layers and home.

However many viewers there are, the robot is asked once, and the answer is made text once. A viewer
takes the newest state when it is ready for more; there is no queue.
"""

from __future__ import annotations

import asyncio
import time
from typing import Final

from roomba.client.household import Household, told_of
from roomba.client.observed import ObservedRobot, Timeline
from roomba.client.plain import home_of, replay_of, state_of
from roomba.client.protocol import CleanReport
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.errors import RoombaError
from roomba.history.keeping import KeepingThread
from roomba.history.recorder import HistoryKeeper
from roomba.ui.web.streams.events import Events, first_of
from roomba.ui.web.streams.metrics import RobotMetrics
from roomba.ui.web.streams.told import Told
from roomba.ui.web.streams.trail import ShownTrail
from roomba.ui.web.tiles import TiledLayer

PERIOD: Final = 0.1
"""s between two looks."""
_LAYERS_EVERY: Final = 3
"""Looks at the robot for one look at its layers."""


class Feed:
    """The newest state for viewers; ``number`` grows with each look."""

    def __init__(
        self,
        robot: ObservedRobot,
        keeper: HistoryKeeper | None = None,
        household: Household | None = None,
    ) -> None:
        """Begin with nothing; :meth:`run` shows the keeper, if there is one, each look."""
        self._robot, self._keeper, self._household = robot, keeper, household
        self._keeping = None if keeper is None else KeepingThread(keeper)
        self._recorded = robot if isinstance(robot, Timeline) else None
        self._looked = asyncio.Event()
        self._looks = 0
        self._layers: dict[LayerName, GridLayer] = {}
        """The layers as they were when last looked at."""
        self._last: CleanReport | None = None
        self.number = 0
        self.events = Events(first_of(time.time()))
        self.metrics = RobotMetrics(robot)
        self.state = Told({"type": "state", "link": "connecting"})
        self.home: Told | None = None
        self.home_version = 0
        self.layers = {name: TiledLayer(name.value) for name in LayerName}
        self.trail = ShownTrail()
        self._jumps = 0
        """How often a viewer of a recording jumped to another time."""

    async def run(self) -> None:
        """Look at the robot until it is cancelled; what was seen is kept before it ends."""
        if self._keeping is not None:
            self._keeping.start()
        try:
            while True:
                await self.look()
                await asyncio.sleep(PERIOD)
        finally:
            if self._keeping is not None:
                await asyncio.to_thread(self._keeping.stop)

    async def look(self) -> None:
        """Look at the robot once, and let waiting viewers know."""
        self._looks += 1
        try:
            view, home, layers = await asyncio.to_thread(self._look_at_robot)
            self._layers = layers or self._layers
            self._show(view, home)
            if self._keeping is not None:
                self._keeping.look(view, home, self._layers)
            # In the event loop's thread, not the looking one: viewers take tiles and versions
            # meanwhile.
            for name, layer in layers.items():
                self.layers[name].update(layer)
        except RoombaError as reason:
            self._lose_sight(str(reason))
        # A robot of another program may raise anything; the next look may succeed.
        except Exception as fault:
            self._lose_sight(f"a look failed: {type(fault).__name__}: {fault}")
        self.number += 1
        looked, self._looked = self._looked, asyncio.Event()
        looked.set()

    async def newer(self, number: int) -> int:
        """Wait for a look after number ``number``; return the number of the newest."""
        while self.number <= number:
            await self._looked.wait()
        return self.number

    def _show(self, view: RobotView, home: HomeView) -> None:
        """Publish a view and a home to the viewers."""
        if self._recorded is not None:
            self._follow_jumps(self._recorded)
        self.trail.follow(view.time, view.pose[0], view.pose[1])
        told = told_of(self._household)
        state = {**state_of(view), **told, "looked": round(time.time(), 3)}
        if view.last is None and self._keeper is not None:
            state["last"] = self._keeper.interrupted
        if self._recorded is not None:
            state["replay"] = replay_of(self._recorded.timeline())
        self.state = Told(state)
        if home.version != self.home_version:
            self.home, self.home_version = Told(home_of(home)), home.version
        self.metrics.look(view, self.events.note(view))

    def _lose_sight(self, reason: str) -> None:
        """Keep the last state on the page, greyed, with the reason."""
        self.state = Told({**self.state.value, "link": "gone", "reason": reason})
        self.trail.lose_sight()
        self.metrics.look(None, self.events.note_gone(reason))

    def _look_at_robot(self) -> tuple[RobotView, HomeView, dict[LayerName, GridLayer]]:
        """Return the robot's state and home, and its layers if they are due.

        Layers are also due when a run has ended, so that the history has the floor of that time.
        """
        view, home = self._robot.robot(), self._robot.home()
        is_end = view.last is not self._last
        is_time = self._looks % _LAYERS_EVERY == 1
        layers = self._look_at_layers() if is_end or is_time else {}
        self._last = view.last
        return view, home, layers

    def _look_at_layers(self) -> dict[LayerName, GridLayer]:
        layers = ((name, self._robot.layer(name)) for name in self.layers)
        return {name: layer for name, layer in layers if layer is not None}

    def _follow_jumps(self, recorded: Timeline) -> None:
        """After a jump to another time, replace the trail by the way up to that time."""
        jumps = recorded.timeline().jumps
        if jumps != self._jumps:
            self._jumps = jumps
            self.trail.replace(recorded.way())
