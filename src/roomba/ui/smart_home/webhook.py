"""Events posted to an address: JSON, signed if there is a secret, tried again, never waited for.

Events wait in a short queue, of which the oldest is dropped when it is full. A thread of its own
posts one after the other; each attempt has a deadline, also when the receiver answers byte by byte.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import http.client
import json
import queue
import socket
import ssl
import threading
import time
from collections.abc import Callable
from typing import Final
from urllib.parse import urlsplit

from roomba.client.events import RobotEvent
from roomba.client.told_once import ToldOnce
from roomba.ui.smart_home.settings import WebhookConfig

MOST_WAITING: Final = 100
"""Events that wait; beyond that the oldest is dropped and counted."""
ATTEMPTS: Final = 4
"""How often an event is tried."""
_PAUSES: Final = (1.0, 5.0, 20.0)
"""s between the attempts."""
_WITHIN: Final = 5.0
"""s that an attempt may take, from the connection to the status."""
_FAULTY: Final = range(400, 500)
"""Statuses that a repeated request would get again, apart from these two:"""
_LATER: Final = (408, 429)


class Webhook:
    """One receiver; ``tell`` is called once with each kind of trouble."""

    def __init__(
        self,
        config: WebhookConfig,
        tell: Callable[[str], None],
        pauses: tuple[float, ...] = _PAUSES,
        within: float = _WITHIN,
    ) -> None:
        """Post nothing yet."""
        self._config, self._pauses, self._within = config, pauses, within
        host = urlsplit(config.url.get_secret_value()).hostname
        self._tell = ToldOnce(lambda text: tell(f"smart home: the webhook at {host}: {text}"))
        self._waiting: queue.Queue[bytes] = queue.Queue(MOST_WAITING)
        self.dropped = 0
        """Events that were not delivered."""
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._live, name="webhook", daemon=True)

    def start(self) -> None:
        """Begin to post."""
        self._thread.start()

    def stop(self) -> None:
        """End; what waits is not posted any more."""
        self._ends.set()
        self._thread.join(1.0)

    def take(self, event: RobotEvent) -> None:
        """Post an event when its turn comes; never waits."""
        if event.kind not in self._config.events:
            return
        told = {"type": event.kind, "robot": self._config.robot, "at": round(time.time(), 3)}
        body = json.dumps({**told, **event.values}, allow_nan=False).encode()
        while True:
            try:
                self._waiting.put_nowait(body)
                return
            except queue.Full:
                self._drop_oldest()

    def _drop_oldest(self) -> None:
        try:
            self._waiting.get_nowait()
        except queue.Empty:
            return
        self.dropped += 1

    def _live(self) -> None:
        while not self._ends.is_set():
            try:
                body = self._waiting.get(timeout=0.5)
            except queue.Empty:
                continue
            if not self._deliver(body):
                self.dropped += 1

    def _deliver(self, body: bytes) -> bool:
        """Post an event until it is taken or refused for good; return whether it was taken."""
        for attempt in range(ATTEMPTS):
            if attempt and self._ends.wait(self._pauses[min(attempt, len(self._pauses)) - 1]):
                return False
            try:
                status = self._post(body)
            except (OSError, http.client.HTTPException, ValueError) as error:
                self._tell(f"it does not answer: {type(error).__name__}")
                continue
            if 200 <= status < 300:
                self._tell("")
                return True
            self._tell(f"it answers with status {status}")
            if status in _FAULTY and status not in _LATER:
                return False
        return False

    def _post(self, body: bytes) -> int:
        """Return the status of one attempt; no redirection is followed."""
        parts = urlsplit(self._config.url.get_secret_value())
        host = parts.hostname or ""
        connection: http.client.HTTPConnection
        if parts.scheme == "https":
            context = ssl.create_default_context()
            connection = http.client.HTTPSConnection(
                host, parts.port, timeout=self._within, context=context
            )
        else:
            connection = http.client.HTTPConnection(host, parts.port, timeout=self._within)
        path = f"{parts.path or '/'}{'?' + parts.query if parts.query else ''}"
        connection.connect()
        # A socket's own time-out begins anew with each byte; this deadline does not.
        deadline = threading.Timer(self._within, _shut, (connection.sock,))
        deadline.daemon = True
        deadline.start()
        try:
            connection.request("POST", path, body, self._headers(body))
            return connection.getresponse().status
        finally:
            deadline.cancel()
            connection.close()

    def _headers(self, body: bytes) -> dict[str, str]:
        headers = {"Content-Type": "application/json", "User-Agent": "roomba_robot"}
        if self._config.secret is not None:
            key = self._config.secret.get_secret_value().encode()
            signature = hmac.new(key, body, hashlib.sha256).hexdigest()
            headers["X-Roomba-Signature"] = f"sha256={signature}"
        return headers


def _shut(connection: socket.socket) -> None:
    with contextlib.suppress(OSError):
        connection.shutdown(socket.SHUT_RDWR)
