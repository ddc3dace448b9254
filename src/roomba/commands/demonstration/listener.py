"""What a smart home hears of the robot by MQTT: each message with when it came."""

from __future__ import annotations

import json
import threading
import time
from dataclasses import dataclass
from typing import Any, Final

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion

from roomba.client.address import HERE

_SENT: Final = 10.0
"""s that a command may take to the broker."""


@dataclass(frozen=True, slots=True)
class HeardMessage:
    """One message; ``time`` is the time of day, s since 1970."""

    time: float
    topic: str
    payload: bytes

    def values(self) -> dict[str, Any]:
        """Return what JSON holds."""
        values: dict[str, Any] = json.loads(self.payload)
        return values


class Listener:
    """Hears all that is said below a topic, and can say something itself."""

    def __init__(self, port: int, base: str) -> None:
        """Connect to the broker at a port of this machine."""
        self._base = base
        self._messages: list[HeardMessage] = []
        self._lock = threading.Lock()
        self._client = mqtt.Client(CallbackAPIVersion.VERSION2)
        self._client.on_connect = lambda client, *_: client.subscribe(f"{base}/#")
        self._client.on_message = self._came
        self._client.connect(HERE, port)
        self._client.loop_start()

    def messages(self, topic: str) -> list[HeardMessage]:
        """Return what was said to a topic below the base, the oldest first."""
        with self._lock:
            return [each for each in self._messages if each.topic == f"{self._base}/{topic}"]

    def state(self) -> dict[str, Any]:
        """Return the newest state; empty before the first."""
        told = self.messages("state")
        return told[-1].values() if told else {}

    def say(self, topic: str, payload: str) -> None:
        """Say something to a topic below the base."""
        sent = self._client.publish(f"{self._base}/{topic}", payload, qos=1)
        sent.wait_for_publish(_SENT)

    def end(self) -> None:
        """Disconnect."""
        self._client.disconnect()
        self._client.loop_stop()

    def _came(self, _: Any, __: Any, message: mqtt.MQTTMessage) -> None:
        with self._lock:
            self._messages.append(HeardMessage(time.time(), message.topic, bytes(message.payload)))
