"""The server under clients that are slow, silent, senseless, or many: all is bounded."""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import random
import resource
import socket
import struct
import threading
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot
from fixtures.waiting import wait_until
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from roomba.ui.web.app import create_app
from roomba.ui.web.bounded.connections import most_connections
from roomba.ui.web.bounded.limits import BACKLOG, MOST_CONNECTIONS, OWN_FILES, PING
from roomba.ui.web.guard import Guard
from roomba.ui.web.server import PageServer, listen
from roomba.ui.web.streams import told

TOKEN = "the-token"
DEADLINE = 20.0
GARBAGE = int(os.environ.get("ROOMBA_GARBAGE", "3000"))
"""Frames; ./roomba soak sends more."""
FEW, MANY = 50, 400
"""Connections that are taken, and that come; ./roomba soak opens as many as it really takes."""
UPGRADE = (
    "GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
    "Connection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    "Sec-WebSocket-Version: 13\r\n\r\n"
)


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def sign_of_life() -> float:
    """s after which a viewer must give one; a test may want it sooner or later."""
    return PING


@pytest.fixture
def server(
    robot: WrittenRobot, sign_of_life: float, monkeypatch: pytest.MonkeyPatch
) -> Iterator[PageServer]:
    monkeypatch.setattr("roomba.ui.web.server.PING", sign_of_life)
    server = PageServer(create_app(robot, Guard(TOKEN)), listen("127.0.0.1", 0, is_fixed=True))
    server.start()
    yield server
    server.stop()


def port_of(server: PageServer) -> int:
    return int(server.address.rsplit(":", 1)[1].strip("/"))


def plug(server: PageServer) -> socket.socket:
    return socket.create_connection(("127.0.0.1", port_of(server)), timeout=DEADLINE)


def view(server: PageServer) -> ClientConnection:
    return connect(f"ws://127.0.0.1:{port_of(server)}/live", max_size=None)


def answers(server: PageServer) -> bool:
    """Whether the server still serves."""
    client = http.client.HTTPConnection("127.0.0.1", port_of(server), timeout=DEADLINE)
    with contextlib.closing(client):
        client.request("GET", "/api/v1/state")
        return client.getresponse().status == 200


def is_closed(open_one: socket.socket) -> bool:
    """Whether the other side closed, after what it sent is read."""
    open_one.settimeout(0.0)
    try:
        while open_one.recv(65536):
            pass
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


def test_a_message_is_made_text_once_for_all_viewers(
    server: PageServer, robot: WrittenRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []
    lock, plain = threading.Lock(), told.text_of

    def counted(value: told.Json) -> str:
        with lock:
            made.append(str(value["type"]))
        return plain(value)

    monkeypatch.setattr(told, "text_of", counted)
    with contextlib.ExitStack() as stack:
        viewers = [stack.enter_context(view(server)) for _ in range(20)]
        robot.view = replace(VIEW, time=99.0, pose=(5.0, 5.0, 0.0))
        states = trails = 0
        for viewer in viewers:
            taken: list[str] = []
            while len(taken) < 10:
                message = viewer.recv(DEADLINE)
                if isinstance(message, str):
                    kind = json.loads(message)["type"]
                    taken += [kind] if kind == "state" else []
                    trails += kind == "trail"
            states += len(taken)
    assert states == 200
    assert trails >= 20
    # The viewers came one after the other: some looks were shown to the first alone.
    assert made.count("state") < 50
    assert made.count("home") == 1
    assert made.count("trail") <= 5


def test_a_slow_viewer_skips_what_is_out_of_date(
    server: PageServer, robot: WrittenRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.ui.web.feed.PERIOD", 0.002)
    scan = np.random.default_rng(1).random((4000, 2), np.float32)
    with view(server) as slow, view(server) as quick:
        slow.recv_messages.pause()
        for number in range(200):
            robot.view = replace(VIEW, time=10.0 + number, scan=scan)
            while f'"time":{10 + number}.0' not in str(quick.recv(DEADLINE))[:60]:
                pass
        slow.recv_messages.resume()
        times: list[float] = []
        while not times or times[-1] != 209.0:
            message = slow.recv(DEADLINE)
            if isinstance(message, str) and '"type":"state"' in message:
                times.append(json.loads(message)["time"])
    assert times == sorted(times)
    assert len(set(times)) < 100


def test_a_viewer_that_tells_what_it_has_gets_the_next_look_only_then(server: PageServer) -> None:
    with view(server) as viewer:

        def looked(within: float) -> float:
            while True:
                message = viewer.recv(within)
                if isinstance(message, str) and '"looked"' in message:
                    return float(json.loads(message)["looked"])

        newest = 0.0
        for _ in range(3):
            viewer.send(json.dumps({"type": "seen", "looked": newest}))
            newest = looked(DEADLINE)
            # Those that were on their way already.
            with contextlib.suppress(TimeoutError):
                for _ in range(20):
                    newest = looked(0.3)
                pytest.fail("looks come that nothing was told of")


@pytest.mark.parametrize("sign_of_life", [0.3])
def test_who_never_reads_is_closed(
    server: PageServer, robot: WrittenRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.ui.web.feed.PERIOD", 0.01)
    robot.view = replace(VIEW, scan=np.random.default_rng(1).random((9000, 2), np.float32))
    with plug(server) as silent:
        silent.sendall(UPGRADE.format(port=port_of(server)).encode())
        wait_until(lambda: server.connections == 1, DEADLINE, "it is connected")
        wait_until(lambda: server.connections == 0, DEADLINE, "it is closed")


# Not because it gives no sign of life.
@pytest.mark.parametrize("sign_of_life", [1000.0])
@pytest.mark.parametrize("frame", [b"\x89\xfd" + 4 * b"\0" + 125 * b"x", b"\x00\x80" + 4 * b"\0"])
def test_pings_and_parts_without_end_are_ended(server: PageServer, frame: bytes) -> None:
    with plug(server) as flood:
        flood.sendall(UPGRADE.format(port=port_of(server)).encode())
        flood.recv(12)
        flood.sendall(b"\x01\x80" + 4 * b"\0" if frame[0] == 0 else b"")
        with contextlib.suppress(OSError):
            for _ in range(3000):
                flood.sendall(100 * frame)
        wait_until(lambda: server.connections == 0, DEADLINE, "it is closed")
    assert answers(server)


@pytest.fixture
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let requests come whole within a moment."""
    monkeypatch.setattr("roomba.ui.web.bounded.connections.BODY_WITHIN", 0.3)


POST = f"POST /api/v1/clean HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer {TOKEN}\r\n"


@pytest.mark.parametrize(
    "begin",
    [
        "",
        "GET / HT",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ",
        f"{POST}Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{{",
    ],
    ids=["nothing", "a part of a line", "a part of a header", "a part of a body"],
)
@pytest.mark.usefixtures("hasty")
def test_a_request_that_does_not_come_whole_is_closed(
    server: PageServer, robot: WrittenRobot, begin: str
) -> None:
    with plug(server) as half_open:
        if begin.startswith("POST"):
            half_open.sendall(b"GET /api/v1/limits HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            assert half_open.recv(65536).startswith(b"HTTP/1.1 200")
        half_open.sendall(begin.encode())
        wait_until(lambda: is_closed(half_open), DEADLINE, "it is closed")
    assert robot.told == []
    assert answers(server)


def test_connections_are_bounded_and_a_viewer_sees_on(
    server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.ui.web.bounded.connections.MOST_CONNECTIONS", FEW)
    # None is closed because it says nothing.
    monkeypatch.setattr("roomba.ui.web.bounded.connections.BODY_WITHIN", 10.0 * DEADLINE)
    with view(server) as viewer, contextlib.ExitStack() as stack:
        for _ in range(MANY):
            with contextlib.suppress(OSError):
                stack.enter_context(plug(server))
        assert server.connections <= FEW + BACKLOG
        wait_until(lambda: server.connections <= FEW, DEADLINE)
        while '"state"' not in str(viewer.recv(DEADLINE)):
            pass
    wait_until(lambda: server.connections == 0, DEADLINE, "all are gone")
    assert answers(server)


@pytest.mark.parametrize(
    ("allowed", "most", "asked_for", "connections"),
    [
        (1024, 524_288, MOST_CONNECTIONS + OWN_FILES, MOST_CONNECTIONS),
        (1024, resource.RLIM_INFINITY, MOST_CONNECTIONS + OWN_FILES, MOST_CONNECTIONS),
        (resource.RLIM_INFINITY, resource.RLIM_INFINITY, None, MOST_CONNECTIONS),
        (524_288, 524_288, None, MOST_CONNECTIONS),
        (256, OWN_FILES + 50, OWN_FILES + 50, 50),
        (64, 64, 64, 1),
    ],
)
def test_as_many_stay_as_the_system_has_files_for(
    allowed: int,
    most: int,
    asked_for: int | None,
    connections: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[tuple[int, tuple[int, int]]] = []
    monkeypatch.setattr(resource, "getrlimit", lambda _: (allowed, most))
    monkeypatch.setattr(resource, "setrlimit", lambda *request: asked.append(request))
    assert most_connections() == connections
    assert [limits for _, limits in asked] == ([] if asked_for is None else [(asked_for, most)])


def test_where_asking_is_forbidden_it_makes_do(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(resource, "getrlimit", lambda _: (OWN_FILES + 724, 524_288))
    monkeypatch.setattr(resource, "setrlimit", refuse)
    assert most_connections() == 724


FRAMES: tuple[str | bytes, ...] = (
    *("", "garbage", "[" * 5000, "9" * 5000, '{"type": 3}', "null", b"\x00\xff" * 50),
    *('{"type": "drive", "linear": NaN, "angular": 0}', '{"type": "drive", "linear": 1e999}'),
)


def test_garbage_of_viewers_moves_nothing(server: PageServer, robot: WrittenRobot) -> None:
    sent, before = 0, resident()
    while sent < GARBAGE:
        with contextlib.suppress(ConnectionClosed), view(server) as viewer:
            viewer.send(json.dumps({"type": "hello", "token": TOKEN}))
            for number in range(150):
                viewer.send(FRAMES[number % len(FRAMES)])
                sent += 1
            while True:
                viewer.recv(DEADLINE)
        assert viewer.close_code == 1008
    assert robot.told == []
    assert answers(server)
    assert resident() - before < 50_000_000


def resident() -> int:
    """Return how much memory this process has, bytes."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def test_garbage_on_the_wire_ends_no_server(server: PageServer, robot: WrittenRobot) -> None:
    made = random.Random(1)
    frames = [
        bytes([made.randrange(256), made.randrange(256)]) + made.randbytes(40) for _ in range(100)
    ]
    upgrade = UPGRADE.format(port=port_of(server)).encode()
    begins = [b"", b"GET / HTTP/1.1\r\n", b"POST ", upgrade, upgrade + b"\x81\xff" + b"\xff" * 8]
    for number in range(300):
        with plug(server) as client, contextlib.suppress(OSError):
            client.sendall(begins[number % len(begins)] + frames[number % 100])
            client.shutdown(socket.SHUT_WR)
    client = plug(server)
    client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    client.sendall(upgrade)
    client.close()
    # As long as so many are open it lets no other in.
    wait_until(lambda: server.connections == 0, DEADLINE, "all are closed")
    assert answers(server)
    assert robot.told == []


PATHS = (
    *("/../app.py", "/..%2fapp.py", "/%2e%2e/app.py", "/%2e%2e%2fapp.py", "/....//app.py"),
    *("/..\\app.py", "/%5c..%5capp.py", "/map/../../app.py", "/map/%2e%2e/%2e%2e/guard.py"),
    *("//etc/passwd", "/%2fetc/passwd", "/etc/passwd", "/./../../../../../../etc/passwd"),
    *("/index.html%00.py", "/%00", "/..;/app.py", "/%c0%ae%c0%ae/app.py", "/" + "../" * 500),
    *("/replay/../app.py", "/replay/1/../../app.py", "/api/v1/../../app.py", "/%", "/%zz", "/\x7f"),
    *("/api/v1/history/%2e%2e/report.html", "/replay/999999999/../x", "/a" * 20000),
)


@pytest.mark.parametrize("path", PATHS, ids=range(len(PATHS)))
def test_no_file_beside_the_page_is_served(server: PageServer, path: str) -> None:
    with plug(server) as client:
        client.sendall(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode()
        )
        answer = b""
        with contextlib.suppress(ConnectionResetError):
            while part := client.recv(65536):
                answer += part
    status = int(answer.split(b" ", 2)[1])
    assert 400 <= status < 500, answer[:200]
    assert b"def " not in answer
    assert b"root:" not in answer
