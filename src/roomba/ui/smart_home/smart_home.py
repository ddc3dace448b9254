"""The robot in a smart home: looks at it, tells the broker and the webhook, and obeys commands.

It speaks to the client protocol alone, as the page does, so it serves any robot that a page serves.
All happens in threads of its own: the robot waits for none of them.
"""

from __future__ import annotations

import json
import math
import queue
import threading
import time
import zlib
from collections import deque
from collections.abc import Callable
from typing import Final

from roomba.client.events import EventFinder
from roomba.client.floor_map import FloorMap, valetudo_of
from roomba.client.observed import ObservedRobot
from roomba.client.told_once import ToldOnce
from roomba.client.view import GridLayer, HomeView, LayerName, Point, RobotView
from roomba.errors import RoombaError
from roomba.files.valetudo.home import ValetudoError
from roomba.ui.smart_home.announcement import announcements
from roomba.ui.smart_home.broker import Broker
from roomba.ui.smart_home.commands import SmartCommands
from roomba.ui.smart_home.map_picture import picture_of
from roomba.ui.smart_home.settings import MqttConfig, SmartHomeConfig
from roomba.ui.smart_home.told_state import StateTeller, attributes_of
from roomba.ui.smart_home.topics import OFFLINE, ONLINE, MqttTopics
from roomba.ui.smart_home.webhook import Webhook

_LOOK: Final = 0.5
"""s between two looks at the robot, and between two births that are answered."""
_MOST_WAY: Final = 2000
"""Places of the way that are kept; older ones are forgotten."""
_STEP: Final = 0.05
"""m between two of them."""
_BEGINS: Final = "begun"


class SmartHome:
    """One robot in a smart home, from :meth:`start` to :meth:`stop`."""

    def __init__(
        self, robot: ObservedRobot, config: SmartHomeConfig, tell: Callable[[str], None]
    ) -> None:
        """Connect nothing yet; ``tell`` is told of trouble. Raises BrokerError."""
        self._robot = robot
        self._finder = EventFinder()
        self._wake, self._ends = threading.Event(), threading.Event()
        self._webhook = None if config.webhook is None else Webhook(config.webhook, tell)
        self.mqtt = (
            None if config.mqtt is None else MqttBridge(robot, config.mqtt, self._wake, tell)
        )
        """The bridge to the broker, if there is one."""
        self._tell = ToldOnce(tell)
        self._thread = threading.Thread(target=self._live, name="smart home", daemon=True)

    def start(self) -> None:
        """Begin; returns at once, whether or not there is a broker."""
        if self._webhook is not None:
            self._webhook.start()
        if self.mqtt is not None:
            self.mqtt.broker.start()
        self._thread.start()

    def stop(self) -> None:
        """End, within some seconds."""
        self._ends.set()
        self._wake.set()
        self._thread.join(2.0)
        if self.mqtt is not None:
            self.mqtt.broker.stop()
        if self._webhook is not None:
            self._webhook.stop()

    def _live(self) -> None:
        """Obey at once, look now and then."""
        looked = -math.inf
        while not self._ends.is_set():
            self._wake.wait(max(0.0, looked + _LOOK - time.monotonic()))
            self._wake.clear()
            try:
                obeyed = self.mqtt is not None and self.mqtt.obey()
                if obeyed or time.monotonic() - looked >= _LOOK:
                    looked = time.monotonic()
                    self._look()
            # What a robot of another program answers is not known here: the next look may do.
            except Exception as fault:
                self._tell(f"smart home: a look failed: {type(fault).__name__}: {fault}")

    def _look(self) -> None:
        try:
            view, home = self._robot.robot(), self._robot.home()
        except RoombaError as reason:
            found = self._finder.gone(str(reason))
            if self.mqtt is not None:
                self.mqtt.show_gone()
        else:
            found = self._finder.look(view)
            if self.mqtt is not None:
                is_new_run = any(event.kind == _BEGINS for event in found)
                self.mqtt.show(view, home, is_new_run=is_new_run)
        if self._webhook is not None:
            for event in found:
                self._webhook.take(event)


class MqttBridge:
    """What the broker is told of one robot, and what of its commands comes of them."""

    def __init__(
        self,
        robot: ObservedRobot,
        config: MqttConfig,
        wake: threading.Event,
        tell: Callable[[str], None],
    ) -> None:
        """Connect nothing yet; raises BrokerError."""
        self._robot, self._config = robot, config
        self.topics = MqttTopics(f"{config.topics}/{config.robot}", config.discovery)
        self.broker = Broker(config, self.topics, wake.set, tell)
        self._commands = SmartCommands(robot)
        self._teller = StateTeller()
        self._home_version = 0
        self._way: deque[Point] = deque(maxlen=_MOST_WAY)
        self._state_told = self._map_told = self._announced = -math.inf
        self._drawn: tuple[object, ...] = ()
        for topic, entity in announcements(self.topics, config.robot, config.name).items():
            self.broker.hold(topic, json.dumps(entity))

    def obey(self) -> bool:
        """Obey what came; returns whether something did."""
        has_obeyed = False
        while True:
            try:
                topic, payload = self.broker.commands.get_nowait()
            except queue.Empty:
                return has_obeyed
            if topic == self.topics.birth:
                self._announce_again(payload)
                continue
            has_obeyed = True
            take = {
                self.topics.command: self._commands.command,
                self.topics.fan_speed: self._commands.set_fan,
                self.topics.send_command: self._commands.send,
            }[topic]
            self.broker.hold(self.topics.answer, json.dumps(take(payload)))
            self._state_told = -math.inf

    def show_gone(self) -> None:
        """Tell that the robot does not answer."""
        self.broker.hold(self.topics.available, OFFLINE)

    def show(self, view: RobotView, home: HomeView, *, is_new_run: bool) -> None:
        """Tell what is seen now, not more often than is wanted."""
        self.broker.hold(self.topics.available, ONLINE)
        now = time.monotonic()
        if is_new_run:
            self._way.clear()
        if not self._way or math.dist(self._way[-1], view.pose[:2]) > _STEP:
            self._way.append(view.pose[:2])
        if home.version != self._home_version:
            self._home_version = home.version
            self.broker.hold(self.topics.attributes, json.dumps(attributes_of(home)))
        state = self._teller.state_of(view, self._commands.fan.value)
        if now - self._state_told >= self._config.state_period:
            self._state_told = now
            self.broker.hold(self.topics.state, json.dumps(state))
        if now - self._map_told >= self._config.map_period:
            self._map_told = now
            self._show_map(view, home)

    def _announce_again(self, payload: str) -> None:
        """Home Assistant has started: it knows nothing any more."""
        now = time.monotonic()
        if payload == ONLINE and now - self._announced >= _LOOK:
            self._announced = now
            self.broker.hold_again()

    def _show_map(self, view: RobotView, home: HomeView) -> None:
        """Draw the map, if it is not the one that was drawn last."""
        cells = self._robot.layer(LayerName.MAP)
        if cells is None or not cells.cells.any():
            return
        coverage = self._robot.layer(LayerName.COVERAGE)
        pose = tuple(round(value, 2) for value in view.pose)
        drawn = (home.version, pose, _sum_of(cells), _sum_of(coverage))
        if drawn == self._drawn:
            return
        self._drawn = drawn
        floor = FloorMap(cells, coverage, home, view.pose, tuple(self._way))
        valetudo = _valetudo_text(floor)
        if valetudo:
            self.broker.hold(self.topics.map_data, zlib.compress(valetudo.encode()))
        self.broker.hold(self.topics.map, picture_of(floor, valetudo))


def _sum_of(layer: GridLayer | None) -> int:
    return 0 if layer is None else zlib.crc32(layer.cells.tobytes())


def _valetudo_text(floor: FloorMap) -> str:
    """Return Valetudo's map as JSON; empty for a map that its format cannot hold."""
    try:
        return json.dumps(valetudo_of(floor), separators=(",", ":"))
    except ValetudoError:
        return ""
