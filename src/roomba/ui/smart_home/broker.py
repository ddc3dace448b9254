"""The connection to an MQTT broker: it comes back by itself, and what waits for it is bounded.

The broker shall hold one message of each topic: a newer one replaces one that has not been sent. So
a broker that is away, or takes nothing, costs the memory of one message of each topic here, and one
in the connection. Commands wait in a short queue. A thread of its own waits for the broker; paho is
called only in that thread.
"""

from __future__ import annotations

import queue
import ssl
import threading
import time
from collections.abc import Callable
from typing import Any, Final

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.subscribeoptions import SubscribeOptions

from roomba.client.told_once import ToldOnce
from roomba.errors import RoombaError
from roomba.ui.smart_home.settings import MqttConfig, TlsConfig
from roomba.ui.smart_home.topics import OFFLINE, ONLINE, MqttTopics

MOST_WAITING: Final = 20
"""Commands that wait; further ones are dropped and counted."""
LONGEST_COMMAND: Final = 16384
"""Bytes of a command; longer ones are dropped. The broker is asked not to send any."""
MOST_RATE: Final = 50.0
"""Messages per s that are taken from the broker; the others wait at the broker."""
_AT_ONCE: Final = 20
"""Messages that may come at once, beyond that rate."""
_KEEP_ALIVE: Final = 10
"""s."""
_RECONNECT: Final = (1.0, 20.0)
"""s between two attempts, at first and at most; each failure doubles them."""
_CONNECT: Final = 5.0
"""s within which a connection must stand."""
_LOOK: Final = 0.1
"""s after which the connection's thread looks for something to send."""
_END: Final = 1.0
"""s that the last message, that the robot is gone, may take."""


class BrokerError(RoombaError):
    """The broker cannot be spoken to at all; the message says why."""


class Broker:
    """One connection. ``commands`` holds topic and payload of each; ``wake`` tells of news."""

    def __init__(
        self,
        config: MqttConfig,
        topics: MqttTopics,
        wake: Callable[[], None],
        tell: Callable[[str], None],
        keep_alive: int = _KEEP_ALIVE,
    ) -> None:
        """Connect nothing yet; raises BrokerError when the authority of TLS cannot be read.

        After ``keep_alive`` s of silence the broker is asked for a sign of life, and given as long
        to answer.
        """
        self._keep_alive = keep_alive
        self._config, self._topics, self._wake = config, topics, wake
        self._tell = ToldOnce(lambda text: tell(f"smart home: {text}"))
        self.commands: queue.Queue[tuple[str, str]] = queue.Queue(MOST_WAITING)
        self.dropped = 0
        """Messages that were dropped."""
        self.connections = 0
        """How many times the broker accepted the connection."""
        self.is_connected = False
        """Whether the broker has accepted the connection."""
        self._wanted: dict[str, bytes] = {}
        self._to_send: dict[str, None] = {}
        self._lock = threading.Lock()
        self._on_the_way: dict[str, mqtt.MQTTMessageInfo] = {}
        self._ends = threading.Event()
        self._budget, self._filled = float(_AT_ONCE), time.monotonic()
        self._client = self._made()
        self._thread = threading.Thread(target=self._live, name="mqtt", daemon=True)

    def start(self) -> None:
        """Begin to connect; returns at once."""
        self._thread.start()

    def stop(self) -> None:
        """Tell the broker that the robot is gone, and end: within 2 s, even if the broker hangs."""
        self._ends.set()
        self._thread.join(2.0 * _END)

    def hold(self, topic: str, payload: str | bytes) -> None:
        """Let the broker hold a message of a topic, sent as soon as possible; never waits."""
        content = payload.encode() if isinstance(payload, str) else payload
        with self._lock:
            if self._wanted.get(topic) != content:
                self._wanted[topic] = content
                self._to_send[topic] = None

    def hold_again(self) -> None:
        """Send all that the broker shall hold once more."""
        with self._lock:
            self._to_send = dict.fromkeys(self._wanted)

    def _live(self) -> None:
        """Connect, and connect again, until the end."""
        pause, most = _RECONNECT
        while not self._ends.is_set():
            before = self.connections
            try:
                self._speak()
            # A broker can send anything; an error that paho makes of it ends this connection alone.
            except Exception as reason:
                host, port = self._config.address
                self._tell(f"no connection to the broker at {host}:{port}: {reason}")
            self.is_connected = False
            if self.connections > before:
                pause = _RECONNECT[0]
            self._ends.wait(pause)
            pause = min(2.0 * pause, most)

    def _speak(self) -> None:
        """Connect, and speak with the broker as long as it answers."""
        host, port = self._config.address
        wishes = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]
        wishes.MaximumPacketSize = LONGEST_COMMAND + 1024
        self._client.connect(host, port, keepalive=self._keep_alive, properties=wishes)
        while self._client.loop(_LOOK) == mqtt.MQTT_ERR_SUCCESS:
            if self._ends.is_set():
                self._say_farewell()
                return
            if self.is_connected:
                self._send()

    def _send(self) -> None:
        """Send the waiting messages, except of topics whose last message has not left yet."""
        with self._lock:
            ready = [topic for topic in self._to_send if self._is_out(topic)]
            sent = {topic: self._wanted[topic] for topic in ready}
            for topic in ready:
                del self._to_send[topic]
        for topic, content in sent.items():
            self._on_the_way[topic] = self._client.publish(topic, content, retain=True)

    def _is_out(self, topic: str) -> bool:
        """Whether the last message of a topic left this process, or never will."""
        last = self._on_the_way.get(topic)
        try:
            return last is None or last.is_published()
        except (ValueError, RuntimeError):
            return True

    def _say_farewell(self) -> None:
        if self.is_connected:
            self._client.publish(self._topics.available, OFFLINE, retain=True)
        self._client.disconnect()
        until = time.monotonic() + _END
        while self._client.loop(_LOOK) == mqtt.MQTT_ERR_SUCCESS and time.monotonic() < until:
            pass

    def _made(self) -> mqtt.Client:
        client = mqtt.Client(CallbackAPIVersion.VERSION2, protocol=mqtt.MQTTv5)
        client.connect_timeout = _CONNECT
        client.will_set(self._topics.available, OFFLINE, retain=True)
        if self._config.user is not None:
            secret = self._config.password
            password = None if secret is None else secret.get_secret_value()
            client.username_pw_set(self._config.user, password)
        if self._config.tls:
            client.tls_set_context(_tls(self._config.tls))
        client.on_connect = self._connected
        client.on_disconnect = self._disconnected
        client.on_message = self._came
        return client

    def _connected(
        self, _client: Any, _user_data: Any, _flags: Any, reason: Any, _properties: Any
    ) -> None:
        if reason.is_failure:
            self._tell(f"the broker refuses the robot: {reason}")
            return
        wanted = [(topic, SubscribeOptions(qos=1)) for topic in self._topics.heard]
        # Messages of others about this robot's availability, from now on.
        others = SubscribeOptions(
            qos=1, noLocal=True, retainHandling=SubscribeOptions.RETAIN_DO_NOT_SEND
        )
        wanted.append((self._topics.available, others))
        self._client.subscribe(wanted)
        self._on_the_way.clear()
        self.hold_again()
        self.connections += 1
        self.is_connected = True
        self._tell(f"connected to the broker at {self._config.host}")
        self._wake()

    def _disconnected(
        self, _client: Any, _user_data: Any, _flags: Any, reason: Any, _properties: Any
    ) -> None:
        if self.is_connected and not self._ends.is_set():
            self._tell(f"the broker is gone ({reason}); the robot connects again by itself")
        self.is_connected = False

    def _came(self, _client: Any, _user_data: Any, message: mqtt.MQTTMessage) -> None:
        """Queue a command, unless it is too long or retained; beyond the rate, the broker waits."""
        self._wait_for_budget()
        if message.topic == self._topics.available:
            self._correct(message.payload)
            return
        is_old = message.retain and message.topic != self._topics.birth
        if is_old or len(message.payload) > LONGEST_COMMAND:
            self.dropped += 1
            return
        try:
            self.commands.put_nowait((message.topic, message.payload.decode()))
        except (queue.Full, UnicodeDecodeError):
            self.dropped += 1
            return
        self._wake()

    def _correct(self, told: bytes | bytearray) -> None:
        """Publish again that the robot is available, if its topic says otherwise.

        The broker publishes the last will of a cut connection when it notices the cut, perhaps long
        after the next connection began. Another program with the robot's name may also end.
        """
        topic = self._topics.available
        with self._lock:
            if told == OFFLINE.encode() and self._wanted.get(topic) == ONLINE.encode():
                self._to_send[topic] = None

    def _wait_for_budget(self) -> None:
        now = time.monotonic()
        self._budget = min(self._budget + MOST_RATE * (now - self._filled), float(_AT_ONCE)) - 1.0
        self._filled = now
        if self._budget < 0.0:
            self._ends.wait(-self._budget / MOST_RATE)


def _tls(config: TlsConfig | bool) -> ssl.SSLContext:
    authority = config.ca if isinstance(config, TlsConfig) else None
    try:
        context = ssl.create_default_context(cafile=authority)
    except OSError as error:
        raise BrokerError(
            f"mqtt.tls.ca: expected a file of certificates (PEM) at {authority}: {error}"
        ) from error
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    return context
