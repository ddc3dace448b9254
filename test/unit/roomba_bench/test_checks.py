"""Whether a peer measured the same thing."""

from __future__ import annotations

import pytest

from roomba_bench.checks import agreed
from roomba_bench.rounds import Outcome

OURS = Outcome("ours", rate=9.0, facts={"mean range": 2.0})


@pytest.mark.parametrize(
    ("mean", "agrees"), [(2.01, True), (1.97, True), (2.1, False), (12.0, False)]
)
def test_a_peer_that_measured_something_else_has_no_figure(mean: float, agrees: bool) -> None:
    peer = agreed(OURS, Outcome("peer", rate=5.0, facts={"mean range": mean}), "mean range", 0.02)
    assert (peer.rate is not None) is agrees
    assert ("measured something else" in peer.error) is not agrees


def test_nothing_is_held_against_a_peer_while_ours_has_no_figure() -> None:
    peer = Outcome("peer", rate=5.0, facts={"mean range": 7.0})
    assert agreed(Outcome("ours", error="unfinished"), peer, "mean range", 0.02) is peer
