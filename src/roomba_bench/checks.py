"""Checks that a peer measured the same as we did: speed at another question counts nothing."""

from __future__ import annotations

from dataclasses import replace

from roomba_bench.rounds import Outcome


def agreed(ours: Outcome, peer: Outcome, fact: str, tolerance: float) -> Outcome:
    """Return the peer's outcome, or an error if one of its facts departs from ours.

    ``tolerance`` is relative. Without a figure of either, the outcome is returned unchecked.
    """
    if fact not in ours.facts or fact not in peer.facts or peer.rate is None:
        return peer
    expected, got = ours.facts[fact], peer.facts[fact]
    if abs(got - expected) <= tolerance * abs(expected):
        return peer
    reason = f"measured something else: {fact} {got:.3f}, ours {expected:.3f}"
    return replace(peer, rate=None, error=reason)
