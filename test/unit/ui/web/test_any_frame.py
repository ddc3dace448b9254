"""Any frame of a page over its WebSocket is answered, and the robot is driven within limits.

``ROOMBA_EXAMPLES=5000`` tries so many frames, others each time.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any, Final

import pytest
from fastapi.testclient import TestClient
from fixtures.households.written_robot import WrittenRobot
from fixtures.spoiled import NUMBERS, spoiled, spoiled_values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from starlette.testclient import WebSocketTestSession

from roomba.ui.web.app import create_app
from roomba.ui.web.guard import Guard

TOKEN = "the-token"
MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 150,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
DRIVE: Final = {"type": "drive", "linear": 0.25, "angular": -0.5}
SEEN: Final = {"type": "seen", "looked": 1.0}
ANY_NUMBER: Final = st.one_of(st.sampled_from(NUMBERS), st.floats(), st.integers())
SAID: Final[st.SearchStrategy[str | bytes]] = st.one_of(
    spoiled_values(DRIVE).map(json.dumps),
    spoiled_values(SEEN).map(json.dumps),
    spoiled(json.dumps(DRIVE).encode()).map(lambda said: said.decode("utf-8", errors="replace")),
    st.tuples(ANY_NUMBER, ANY_NUMBER).map(
        lambda pair: json.dumps({**DRIVE, "linear": pair[0], "angular": pair[1]})
    ),
    st.text(max_size=60),
    st.binary(max_size=60),
    st.sampled_from(["[" * 60_000, "9" * 60_000, '"' + "x" * 60_000 + '"', "{}", "[]", "null"]),
)


class Talk:
    """A page with a WebSocket."""

    def __init__(self, page: TestClient, robot: WrittenRobot, token: str) -> None:
        self.robot, self._page, self._token = robot, page, token
        self._stack = ExitStack()
        self._count = 0

    def __enter__(self) -> Talk:
        self._socket: WebSocketTestSession = self._stack.enter_context(
            self._page.websocket_connect("/live", headers={"Host": "127.0.0.1"})
        )
        return self

    def __exit__(self, *error: Any) -> None:
        self._stack.close()

    def say(self, said: str | bytes) -> None:
        """Say it, and then hello, which must be answered."""
        hello = json.dumps({"type": "hello", "token": self._token})
        self._socket.send_text(hello)
        self._hears("welcome")
        if isinstance(said, bytes):
            self._socket.send_bytes(said)
        else:
            self._socket.send_text(said)
        self._socket.send_text(hello)
        self._hears("welcome")

    def _hears(self, kind: str) -> None:
        while True:
            message = self._socket.receive()
            assert message["type"] == "websocket.send", message
            text = message.get("text")
            if text and json.loads(text)["type"] == kind:
                return


@pytest.fixture(scope="module", params=[TOKEN, ""], ids=["known", "unknown"])
def talk(request: pytest.FixtureRequest) -> Iterator[Talk]:
    robot = WrittenRobot()
    page = TestClient(create_app(robot, Guard(TOKEN)), base_url="http://127.0.0.1")
    with page, Talk(page, robot, request.param) as talk:
        yield talk


@FUZZ
@given(said=SAID)
def test_any_frame_is_answered_and_drives_within_limits(talk: Talk, said: str | bytes) -> None:
    talk.robot.told.clear()
    talk.say(said)
    for name, (linear, angular) in talk.robot.told:
        assert name == "drive"
        assert abs(linear) <= 2.0
        assert abs(angular) <= math.tau


def test_only_a_page_with_the_token_drives(talk: Talk, request: pytest.FixtureRequest) -> None:
    talk.robot.told.clear()
    talk.say(json.dumps(DRIVE))
    is_known = request.node.callspec.params["talk"] == TOKEN
    assert talk.robot.told == ([("drive", (0.25, -0.5))] if is_known else [])
