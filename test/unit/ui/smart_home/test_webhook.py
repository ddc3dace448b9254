"""Events posted to a real receiver: signed, tried again, and never waited for."""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import json
import socket
import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest
from fixtures.waiting import wait_until
from pydantic import SecretStr

from roomba.client.events import RobotEvent
from roomba.ui.smart_home.settings import WebhookConfig
from roomba.ui.smart_home.webhook import ATTEMPTS, MOST_WAITING, Webhook

QUICK = (0.01, 0.02)


class Receiver:
    """Writes down what is posted, and answers with the statuses that it was given, then 200."""

    def __init__(self) -> None:
        self.came: list[tuple[str, dict[str, str], bytes]] = []
        self.statuses: list[int] = []
        receiver = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                receiver.came.append((self.path, dict(self.headers), body))
                self.send_response(receiver.statuses.pop(0) if receiver.statuses else 200)
                self.send_header("Location", "/elsewhere")
                self.end_headers()

            def log_message(self, *_: Any) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}/hook/key?x=1"

    def end(self) -> None:
        self._server.shutdown()
        self._server.server_close()


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    made = Receiver()
    yield made
    made.end()


def hook_to(url: str, told: list[str], **more: Any) -> Webhook:
    config = WebhookConfig(url=SecretStr(url), **more)
    hook = Webhook(config, told.append, QUICK, within=0.3)
    hook.start()
    return hook


def test_an_event_is_posted_and_signed(receiver: Receiver) -> None:
    told: list[str] = []
    hook = hook_to(receiver.url, told, secret="key", events=("ended",))
    hook.take(RobotEvent("state", {"phase": "docked"}))
    hook.take(RobotEvent("ended", {"outcome": "completed", "covered": 38.1}))
    wait_until(lambda: receiver.came, 10.0)
    hook.stop()
    ((path, headers, body),) = receiver.came
    assert path == "/hook/key?x=1"
    values = json.loads(body)
    assert (values["type"], values["robot"], values["covered"]) == ("ended", "roomba", 38.1)
    assert headers["Content-Type"] == "application/json"
    signature = hmac.new(b"key", body, hashlib.sha256).hexdigest()
    assert headers["X-Roomba-Signature"] == f"sha256={signature}"
    assert (told, hook.dropped) == ([], 0)


def test_it_is_tried_again_a_few_times(receiver: Receiver) -> None:
    told: list[str] = []
    receiver.statuses = [500, 503, 429]
    hook = hook_to(receiver.url, told)
    hook.take(RobotEvent("begun", {}))
    wait_until(lambda: len(receiver.came) == 4, 10.0)
    receiver.statuses = [500] * ATTEMPTS
    hook.take(RobotEvent("begun", {}))
    wait_until(lambda: hook.dropped == 1, 10.0)
    hook.stop()
    assert len(receiver.came) == 4 + ATTEMPTS
    assert all("key" not in text for text in told)


@pytest.mark.parametrize("status", [302, 307, 400, 404])
def test_refusals_and_redirections_lead_nowhere(receiver: Receiver, status: int) -> None:
    told: list[str] = []
    receiver.statuses = [status] * 9
    hook = hook_to(receiver.url, told)
    hook.take(RobotEvent("begun", {}))
    wait_until(lambda: hook.dropped == 1, 10.0)
    hook.stop()
    assert {path for path, _, _ in receiver.came} == {"/hook/key?x=1"}
    assert len(receiver.came) == (1 if status >= 400 else ATTEMPTS)
    assert told == [
        f"smart home: the webhook at 127.0.0.1: it answers with status {status}",
    ]


def test_a_receiver_that_trickles_or_hangs_holds_nothing_up() -> None:
    """A byte now and then keeps a socket's own time-out away: the attempt ends all the same."""
    ends = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:
        taken = []

        def trickle() -> None:
            server.settimeout(0.1)
            while not ends.is_set():
                with contextlib.suppress(TimeoutError):
                    taken.append(server.accept()[0])
                for connection in taken:
                    with contextlib.suppress(OSError):
                        connection.send(b"H" if len(taken) % 2 else b"")

        thread = threading.Thread(target=trickle)
        thread.start()
        hook = hook_to(f"http://127.0.0.1:{server.getsockname()[1]}/", [])
        began = time.monotonic()
        for number in range(MOST_WAITING + 50):
            hook.take(RobotEvent("begun", {"number": number}))
        assert time.monotonic() - began < 1.0
        assert hook.dropped >= 49
        before = hook.dropped
        wait_until(lambda: hook.dropped > before and len(taken) >= ATTEMPTS, 10.0)
        hook.stop()
        ends.set()
        thread.join()
        for connection in taken:
            connection.close()
