"""The robot in a smart home: looks at it, tells the broker and the webhook, and obeys commands.

It uses the client protocol alone, as the page does, so it serves any robot that a page serves. It
works in threads of its own: the robot waits for none of them.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from typing import Final

from roomba.client.events import EventFinder
from roomba.client.observed import ObservedRobot
from roomba.client.told_once import ToldOnce
from roomba.errors import RoombaError
from roomba.ui.smart_home.mqtt_bridge import MqttBridge
from roomba.ui.smart_home.settings import SmartHomeConfig
from roomba.ui.smart_home.webhook import Webhook

_LOOK: Final = 0.5
"""s between two looks at the robot."""
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
            self.mqtt.start()
        self._thread.start()

    def stop(self) -> None:
        """End, within some seconds."""
        self._ends.set()
        self._wake.set()
        self._thread.join(2.0)
        if self.mqtt is not None:
            self.mqtt.stop()
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
            # A robot of another program may raise anything; the next look may succeed.
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
