"""The peers' side of the protocol."""

from __future__ import annotations

import io
import json
import sys
from types import ModuleType
from typing import Any

import pytest

from roomba_bench.peers.protocol import LeftOutError, Parameters, Work, rate, serve


def answers_of(prepare: object, *requests: object) -> list[dict[str, Any]]:
    """Return what a peer with this ``prepare`` answers."""
    module = ModuleType("scripted_peer")
    vars(module).update(DISTRIBUTION="", prepare=prepare)
    sys.modules["scripted_peer"] = module
    answers = io.StringIO()
    try:
        serve("scripted_peer", [json.dumps(request) for request in requests], answers)
    finally:
        del sys.modules["scripted_peer"]
    return [json.loads(line) for line in answers.getvalue().splitlines()]


def test_it_tells_facts_and_then_rates() -> None:
    ready, measured = answers_of(
        lambda case: Work(lambda: case["units"], {"length": 2.5}),
        {"prepare": {"units": 4.0}},
        {"run": 0.0},
    )
    assert ready["facts"] == {"length": 2.5}
    assert ready["version"].startswith("3.")
    assert measured["rate"] > 0.0


def test_what_its_library_raises_is_an_answer() -> None:
    def prepare(case: Parameters) -> Work:
        raise OSError("libEGL.so.1: cannot open\nmore lines")

    [answer] = answers_of(prepare, {"prepare": {}})
    assert answer == {"error": "OSError: libEGL.so.1: cannot open"}


def test_a_peer_that_is_not_for_the_case_says_so_in_its_own_words() -> None:
    def prepare(case: Parameters) -> Work:
        raise LeftOutError("a graph of 9 cells is too much")

    assert answers_of(prepare, {"prepare": {}}) == [{"error": "a graph of 9 cells is too much"}]


def test_a_script_that_cannot_be_imported_is_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    answers = io.StringIO()
    serve("roomba_bench.peers.no_such_peer", ['{"prepare": {}}'], answers)
    assert "ModuleNotFoundError" in json.loads(answers.getvalue())["error"]


def test_running_before_preparing_is_refused() -> None:
    [answer] = answers_of(None, {"run": 1.0})
    assert "expected 'prepare'" in answer["error"]


def test_a_rate_is_units_by_time(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([10.0, 10.4, 12.0])
    monkeypatch.setattr("roomba_bench.peers.protocol.time.perf_counter", lambda: next(clock))
    assert rate(lambda: 3.0, seconds=1.0) == pytest.approx(6.0 / 2.0)
