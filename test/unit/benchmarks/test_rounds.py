"""The contest: turns, the best round, and those who cannot take part."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from benchmarks import contestants
from benchmarks.contestants import ContestantError, Local, Peer, Unavailable
from benchmarks.peers.protocol import Work
from benchmarks.rounds import Pace, compete

PACE = Pace(rounds=3, seconds=0.0)


class Scripted:
    """Runs at the rates that it is given; an error among them is raised."""

    def __init__(
        self, name: str, rates: Sequence[float | Exception], log: list[str] | None = None
    ) -> None:
        self.name = name
        self.rates = list(rates)
        self.log = [] if log is None else log
        self.has_ended = False

    def prepare(self) -> tuple[str, dict[str, float]]:
        return "1.0", {"length": 7.0}

    def run(self, seconds: float) -> float:
        self.log.append(self.name)
        rate = self.rates.pop(0)
        if isinstance(rate, Exception):
            raise rate
        return rate

    def end(self) -> None:
        self.has_ended = True


def test_the_best_of_all_rounds_counts_and_all_take_turns() -> None:
    log: list[str] = []
    ours, peer = compete(
        [Scripted("ours", [1.0, 3.0, 2.0], log), Scripted("peer", [9.0, 8.0, 7.0], log)], PACE
    )
    assert (ours.rate, peer.rate) == (3.0, 9.0)
    assert log == ["ours", "peer"] * 3
    assert peer.figure(lambda rate: 10.0 * rate).value == 90.0
    assert peer.fact("length").value == 7.0
    assert peer.fact("weight").error == "it does not tell"


def test_who_fails_is_left_out_with_the_reason_and_the_others_go_on() -> None:
    broken = Scripted("peer", [5.0, ContestantError("out of memory")])
    ours, peer = compete([Scripted("ours", [1.0] * 3), broken], PACE)
    assert ours.rate == 1.0
    assert peer.rate is None
    assert peer.figure().error == "out of memory"
    assert broken.has_ended


def test_ours_may_be_unfinished() -> None:
    def make() -> Work:
        raise ImportError("no module named fleet")

    [ours] = compete([Local("ours", make)], PACE)
    assert ours.error == "ImportError: no module named fleet"


def test_ours_is_measured_in_this_process() -> None:
    [ours] = compete([Local("ours", lambda: Work(lambda: 2.0, {"length": 1.0}))], PACE)
    assert ours.rate is not None
    assert ours.rate > 0.0
    assert ours.facts == {"length": 1.0}


def test_a_peer_that_pip_refused_is_named_with_its_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contestants, "BENCH_ENVIRONMENT", tmp_path)
    (tmp_path / "not-installed").mkdir()
    (tmp_path / "not-installed" / "range-libc").write_text("No matching distribution found\n")
    peer, unavailable = compete([Peer("range-libc", "none", {}), Unavailable("range-libc")], PACE)
    assert peer.error == "not installed: No matching distribution found"
    assert unavailable.error == "not installed: No matching distribution found"


def test_without_the_peers_environment_each_peer_says_what_makes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contestants, "BENCH_ENVIRONMENT", tmp_path)
    [peer] = compete([Peer("pymunk", "pymunk", {})], PACE)
    assert "./roomba bench makes it" in peer.error


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ("import sys; sys.exit(3)", "its process ended with status 3"),
        ('print(\'{"error": "no OpenGL"}\', flush=True); input()', "no OpenGL"),
    ],
)
def test_a_process_that_cannot_take_part_says_why(program: str, reason: str) -> None:
    command = (sys.executable, "-c", program)
    [outcome] = compete([contestants.Program("peer", command, {})], PACE)
    assert outcome.error == reason
