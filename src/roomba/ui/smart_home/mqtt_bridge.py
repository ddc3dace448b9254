"""Tells the broker about one robot, and obeys the commands that come from the broker.

:class:`~roomba.ui.smart_home.smart_home.SmartHome` calls it. A thread of its own draws the map.
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
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Final

from roomba.client.floor_map import FloorMap, valetudo_of
from roomba.client.observed import ObservedRobot
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.files.valetudo.home import ValetudoError
from roomba.geometry import Point
from roomba.ui.smart_home.announcement import announcements
from roomba.ui.smart_home.broker import Broker
from roomba.ui.smart_home.commands import SmartCommands
from roomba.ui.smart_home.map_picture import picture_of
from roomba.ui.smart_home.settings import MqttConfig
from roomba.ui.smart_home.told_state import StateTeller, attributes_of
from roomba.ui.smart_home.topics import OFFLINE, ONLINE, MqttTopics

_BIRTH_PERIOD: Final = 0.5
"""s between two births that are answered."""
_MOST_WAY: Final = 2000
"""Places of the robot's way that are kept; the oldest are dropped."""
_STEP: Final = 0.05
"""m between two of them."""


class MqttBridge:
    """One robot and its broker, from :meth:`start` to :meth:`stop`."""

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
        self._broker = Broker(config, self.topics, wake.set, tell)
        self._commands = SmartCommands(robot)
        self._teller = StateTeller()
        self._home_version = 0
        self._way: deque[Point] = deque(maxlen=_MOST_WAY)
        self._state_told = self._map_told = self._announced = -math.inf
        self._drawn: tuple[object, ...] = ()
        self._painter = ThreadPoolExecutor(1, "smart home map")
        self._drawing: Future[None] | None = None
        for topic, entity in announcements(self.topics, config.robot, config.name).items():
            self._broker.hold(topic, json.dumps(entity))

    def start(self) -> None:
        """Begin to connect; returns at once."""
        self._broker.start()

    def stop(self) -> None:
        """Draw no more, and say that the robot is gone: within 2 s, as the broker does."""
        self._painter.shutdown(wait=False, cancel_futures=True)
        self._broker.stop()

    def obey(self) -> bool:
        """Obey the commands that came; return whether one was obeyed."""
        has_obeyed = False
        while True:
            try:
                topic, payload = self._broker.commands.get_nowait()
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
            self._broker.hold(self.topics.answer, json.dumps(take(payload)))
            self._state_told = -math.inf

    def show_gone(self) -> None:
        """Publish that the robot does not answer."""
        self._broker.hold(self.topics.available, OFFLINE)

    def show(self, view: RobotView, home: HomeView, *, is_new_run: bool) -> None:
        """Publish what was seen now, at most as often as the configuration says."""
        self._broker.hold(self.topics.available, ONLINE)
        now = time.monotonic()
        if is_new_run:
            self._way.clear()
        if not self._way or math.dist(self._way[-1], view.pose[:2]) > _STEP:
            self._way.append(view.pose[:2])
        if home.version != self._home_version:
            self._home_version = home.version
            self._broker.hold(self.topics.attributes, json.dumps(attributes_of(home)))
        state = self._teller.state_of(view, self._commands.fan.value)
        if now - self._state_told >= self._config.state_period:
            self._state_told = now
            self._broker.hold(self.topics.state, json.dumps(state))
        before = self._drawing
        is_free = before is None or before.done()
        if is_free and now - self._map_told >= self._config.map_period:
            self._map_told = now
            way = tuple(self._way)
            self._drawing = self._painter.submit(self._show_map, view, home, way)
            if before is not None:
                before.result()  # raises the error of the drawing, if there was one

    def _announce_again(self, payload: str) -> None:
        """Send all messages again: Home Assistant has started, and knows none of them."""
        now = time.monotonic()
        if payload == ONLINE and now - self._announced >= _BIRTH_PERIOD:
            self._announced = now
            self._broker.hold_again()

    def _show_map(self, view: RobotView, home: HomeView, way: tuple[Point, ...]) -> None:
        """Draw the map, if it differs from the one that was drawn last."""
        cells = self._robot.layer(LayerName.MAP)
        if cells is None or not cells.cells.any():
            return
        coverage = self._robot.layer(LayerName.COVERAGE)
        pose = tuple(round(value, 2) for value in view.pose)
        drawn = (home.version, pose, _sum_of(cells), _sum_of(coverage))
        if drawn == self._drawn:
            return
        self._drawn = drawn
        floor = FloorMap(cells, coverage, home, view.pose, way)
        valetudo = _valetudo_text(floor)
        if valetudo:
            self._broker.hold(self.topics.map_data, zlib.compress(valetudo.encode()))
        self._broker.hold(self.topics.map, picture_of(floor, valetudo))


def _sum_of(layer: GridLayer | None) -> int:
    return 0 if layer is None else zlib.crc32(layer.cells.tobytes())


def _valetudo_text(floor: FloorMap) -> str:
    """Return Valetudo's map as JSON; empty for a map that its format cannot hold."""
    try:
        return json.dumps(valetudo_of(floor), separators=(",", ":"))
    except ValetudoError:
        return ""
