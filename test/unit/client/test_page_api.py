"""A client of the page's API, against a server with prepared answers."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from threading import Thread

import pytest

from roomba.client.page_api import PageApi
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError

ANSWERS = {
    "/api/v1/state": (200, '{"phase": "idle"}'),
    "/api/v1/stop": (409, '{"detail": "it stands already"}'),
    "/api/v1/gone": (404, "no JSON"),
    "/api/v1/starting": (503, '{"detail": "the robot is starting"}'),
    "/api/v1/list": (200, "[1, 2]"),
    "/api/v1/cut": (200, '{"phase":'),
}
SENT: list[tuple[str, str | None, object]] = []


class Asked(BaseHTTPRequestHandler):
    """Answers with what stands beside a path, and keeps what was sent."""

    def do_GET(self) -> None:
        self._answer()

    def do_PUT(self) -> None:
        content = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        SENT.append((self.path, self.headers["Authorization"], content))
        self._answer()

    def do_POST(self) -> None:
        self.do_PUT()

    def _answer(self) -> None:
        status, content = ANSWERS[self.path]
        self.send_response(status)
        self.end_headers()
        self.wfile.write(content.encode())

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture
def address() -> Iterator[str]:
    SENT.clear()
    with HTTPServer(("127.0.0.1", 0), Asked) as server:
        thread = Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
        thread.join()


def test_what_is_told_is_returned(address: str) -> None:
    assert PageApi(address).get("api/v1/state") == {"phase": "idle"}


def test_values_are_sent_with_the_token(address: str) -> None:
    assert PageApi(address, "abc").send("state", {"often": 2}, "PUT") == {"phase": "idle"}
    assert SENT == [("/api/v1/state", "Bearer abc", {"often": 2})]


def test_a_refusal_has_the_reason_of_the_server(address: str) -> None:
    with pytest.raises(RequestRefusedError, match=r"^it stands already$"):
        PageApi(address, "abc").send("stop")
    with pytest.raises(RequestRefusedError, match="404"):
        PageApi(address).get("api/v1/gone")


def test_a_robot_that_does_not_answer_its_server_is_unavailable(address: str) -> None:
    with pytest.raises(RobotUnavailableError, match=r"^the robot is starting$"):
        PageApi(address).get("api/v1/starting")


@pytest.mark.parametrize("path", ["list", "cut"])
def test_what_is_no_answer_of_a_page_is_told(address: str, path: str) -> None:
    with pytest.raises(RobotUnavailableError, match=r"cannot be reached|a list"):
        PageApi(address).get(f"api/v1/{path}")


def test_a_port_at_which_nothing_listens_is_told() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(RobotUnavailableError, match="cannot be reached"):
        PageApi(f"http://127.0.0.1:{port}").get("api/v1/state")


def test_a_proxy_is_passed_by(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    assert PageApi(address).get("api/v1/state") == {"phase": "idle"}
