"""The contest: turns, the best round, and peers that cannot take part."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from roomba_bench import contestants
from roomba_bench.contestants import ContestantError, Local, Peer, Unavailable
from roomba_bench.peers.protocol import Work
from roomba_bench.rounds import Pace, compete

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


def test_a_peer_that_pip_refused_is_named_with_its_reason(tmp_path: Path) -> None:
    python = tmp_path / "bin" / "python3"
    (tmp_path / "not-installed").mkdir()
    (tmp_path / "not-installed" / "range-libc").write_text("No matching distribution found\n")
    peer, unavailable = compete(
        [Peer(python, "range-libc", "none", {}), Unavailable(python, "range-libc")], PACE
    )
    assert peer.error == "not installed: No matching distribution found"
    assert unavailable.error == "not installed: No matching distribution found"


def test_without_a_python_of_the_peers_each_peer_says_what_to_name() -> None:
    peer, unavailable = compete(
        [Peer(None, "pymunk", "simulators.pymunk", {}), Unavailable(None, "range-libc")], PACE
    )
    assert peer.error == "there is no Python for it; name one that has pymunk: --peers PYTHON"
    assert unavailable.error == "there is no script for it here"


def test_a_peer_runs_under_the_python_that_is_named() -> None:
    """This one has all that the script imports: Python's own library."""
    [peer] = compete([Peer(Path(sys.executable), "raw TCP", "transport.tcp", {"bytes": 64})], PACE)
    assert peer.error == ""
    assert peer.rate is not None
    assert peer.rate > 0.0


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
