"""Any request to any route is answered soon, and obeyed only within its limits.

All routes are taken from the application. ``ROOMBA_EXAMPLES=5000`` tries so many requests of each,
others each time.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

import pytest
from fastapi import FastAPI
from fastapi.routing import APIRoute
from fastapi.testclient import TestClient
from fixtures.robots.able_robot import AbleRobot
from fixtures.routes import all_routes
from fixtures.spoiled import TOKENS, spoiled, spoiled_values
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from unit.history.made import made_figures, made_recording

from roomba.configuration.household import HouseholdConfig
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunSource
from roomba.household.household import LiveHousehold
from roomba.ui.web.app import create_app
from roomba.ui.web.bounded.limits import MOST_BODY
from roomba.ui.web.guard import Guard

TOKEN = "the-token"
ADDRESS = "http://127.0.0.1:8400"
RIGHT = {"Authorization": f"Bearer {TOKEN}", "Content-Type": "application/json"}
WITHOUT_END: Final = "/api/v1/events"
MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 15,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
SOON: Final = 5.0
"""s of processor time for one answer."""
WORDS: Final = st.one_of(
    st.sampled_from([token.decode("utf-8", errors="replace") for token in TOKENS]),
    st.sampled_from(["1", "0", "9" * 19, "9" * 25, "-1", "x", "map", "..", "%2e%2e", "a/b"]),
    st.text(max_size=40),
)
"""What stands in a path, or in a question."""
ANY_JSON: Final = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=30)),
    lambda parts: st.one_of(
        st.lists(parts, max_size=4), st.dictionaries(st.text(max_size=12), parts, max_size=4)
    ),
    max_leaves=12,
)


class Served:
    """An application with all that any robot has, and what it is told."""

    def __init__(self, folder: Path) -> None:
        self.robot = AbleRobot()
        history = History(folder)
        history.add(made_figures(), made_recording())
        keeper = HistoryKeeper(history, RunSource("play", "box"), lambda _: None)
        household = LiveHousehold(
            self.robot, folder, HouseholdConfig(), 100.0, lambda text: pytest.fail(text)
        )
        self.app = create_app(self.robot, Guard(TOKEN), keeper, None, household)
        self.client = TestClient(self.app, base_url=ADDRESS, follow_redirects=False)


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = Served(tmp_path_factory.mktemp("served"))
    with ExitStack() as stack:
        stack.enter_context(served.client)
        yield served


def routes_of(app: FastAPI) -> list[tuple[str, str]]:
    """Return the method and the path of each route, with the names of what is to be filled in."""
    return sorted(
        (method, route.path_format)
        for route in all_routes(app.routes)
        if isinstance(route, APIRoute) and route.path != WITHOUT_END
        for method in route.methods or ()
    )


@pytest.fixture(scope="module")
def examples(served: Served) -> dict[tuple[str, str], Any]:
    """The example of each body, by method and path."""
    described = served.client.get("/openapi.json").json()["paths"]
    return {
        (method.upper(), path): operation["requestBody"]["content"]["application/json"]["example"]
        for path, methods in described.items()
        for method, operation in methods.items()
        if "requestBody" in operation
    }


@pytest.fixture(scope="module")
def routes(served: Served) -> list[tuple[str, str]]:
    return routes_of(served.app)


def bodies_like(example: Any) -> st.SearchStrategy[bytes]:
    """Return bodies: of another kind, or like an example to which anything happened."""
    any_kind: list[st.SearchStrategy[bytes]] = [
        ANY_JSON.map(lambda values: json.dumps(values).encode()),
        st.binary(max_size=200),
        st.sampled_from(TOKENS),
        st.just(b"[" * (MOST_BODY - 1)),
    ]
    if example is not None:
        any_kind += [
            spoiled(json.dumps(example).encode()),
            spoiled_values(example).map(lambda values: json.dumps(values).encode()),
        ]
    return st.one_of(any_kind)


def filled(path: str, words: list[str]) -> str:
    """Return a path with words in it."""
    for name in ("name", "number"):
        while "{" + name + "}" in path:
            path = path.replace("{" + name + "}", quote(words.pop(), safe=""), 1)
    assert "{" not in path
    return path


def numbers_in(values: Any) -> Iterator[float]:
    """Give each number among values, however deep."""
    if isinstance(values, float | int):
        yield float(values)
    elif isinstance(values, dict):
        yield from numbers_in(list(values.values()))
    elif isinstance(values, list | tuple | set):
        for each in values:
            yield from numbers_in(each)
    elif hasattr(values, "__slots__"):
        yield from numbers_in([getattr(values, name) for name in values.__slots__])


def test_there_are_many_routes_and_most_have_an_example(
    routes: list[tuple[str, str]], examples: dict[tuple[str, str], Any]
) -> None:
    assert len(routes) > 50
    assert len(set(examples) & set(routes)) > 18


def test_any_request_of_any_route_is_answered(
    served: Served, routes: list[tuple[str, str]], examples: dict[tuple[str, str], Any]
) -> None:
    for method, path in routes:
        ask_anything(served, method, path, examples.get((method, path)))


def ask_anything(served: Served, method: str, path: str, example: Any) -> None:
    """Ask a route many things, with the token and without it."""

    @FUZZ
    @given(
        words=st.lists(WORDS, min_size=2, max_size=2),
        body=bodies_like(example),
        question=st.dictionaries(
            st.sampled_from(["limit", "one", "other", "number", "token", "x"]), WORDS
        ),
        is_known=st.booleans(),
    )
    def ask(words: list[str], body: bytes, question: dict[str, str], is_known: bool) -> None:
        served.robot.told.clear()
        headers = RIGHT if is_known else {"Content-Type": "application/json"}
        began = time.process_time()
        answer = served.client.request(
            method, filled(path, words), content=body, headers=headers, params=question
        )
        assert time.process_time() - began < SOON
        assert answer.status_code < 500, answer.text
        if not is_known and method not in ("GET", "HEAD"):
            assert answer.status_code in (401, 413)
        if not is_known or answer.status_code >= 400:
            assert served.robot.told == []
        for _, arguments in served.robot.told:
            assert all(abs(number) <= 1000.0 for number in numbers_in(arguments))

    ask()


@FUZZ
@given(
    pieces=st.lists(
        st.one_of(
            st.sampled_from(["..", "%2e%2e", ".", "", "replay", "1", "api", "v1", "map", "..%2f"]),
            st.sampled_from(["app.js", "index.html", "%00", "..\\", "etc", "passwd", "state"]),
            st.text(max_size=12).map(lambda text: quote(text, safe="")),
        ),
        max_size=8,
    )
)
def test_no_path_leads_out_of_the_page(served: Served, pieces: list[str]) -> None:
    path = "/" + "/".join(pieces)
    if path.startswith(WITHOUT_END):
        return
    answer = served.client.request("GET", f"{ADDRESS}{path}")
    assert answer.status_code < 500
    assert b"root:" not in answer.content
    assert b"from __future__" not in answer.content


LINES: Final = st.text(
    st.characters(min_codepoint=32, max_codepoint=255, exclude_characters="\x7f"), max_size=60
)


@FUZZ
@given(
    headers=st.dictionaries(
        st.sampled_from(
            [
                *("Authorization", "Host", "Origin", "Content-Type", "Content-Length", "Cookie"),
                *("Accept", "Range", "If-None-Match", "If-Modified-Since", "Transfer-Encoding"),
                *("X-Forwarded-Host", "Upgrade", "Connection", "Expect", "Accept-Encoding"),
            ]
        ),
        st.one_of(
            LINES,
            st.sampled_from(
                [
                    *(f"Bearer {TOKEN}x", "Bearer ", TOKEN, "127.0.0.1:8400", "null", "bytes=0-"),
                    *("bytes=-1,0-0,9999999999999999999-", "chunked", "100-continue", "[::1"),
                ]
            ),
        ),
    ),
    path=st.sampled_from(["/", "/api/v1/state", "/api/v1/dock", "/app.js", "/replay/1/", "/live"]),
    method=st.sampled_from(["GET", "POST", "PUT", "DELETE", "HEAD", "OPTIONS", "TRACE"]),
)
def test_any_headers_are_answered_and_open_nothing(
    served: Served, headers: dict[str, str], path: str, method: str
) -> None:
    served.robot.told.clear()
    encoded = [(name.encode(), value.encode("latin-1")) for name, value in headers.items()]
    answer = served.client.request(method, path, content=b"{}", headers=encoded)
    assert answer.status_code < 500
    assert served.robot.told == []
