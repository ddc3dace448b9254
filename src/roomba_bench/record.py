"""The rows of the result: a figure of ours, its aim, and the same figure of each peer."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from roomba.files.atomic import write_output


class Better(Enum):
    """Which of two figures is the better one."""

    HIGHER = "higher"
    """More is better: steps per second."""
    LOWER = "lower"
    """Less is better: milliseconds."""


@dataclass(frozen=True)
class PeerFigure:
    """The figure of a peer; without ``value``, ``error`` says why there is none."""

    name: str
    version: str = ""
    value: float | None = None
    error: str = ""

    def __post_init__(self) -> None:
        """Require a value or an error."""
        if self.value is None and not self.error:
            raise ValueError(f"peer {self.name}: expected a value, or an error that says why not")


@dataclass(frozen=True)
class Record:
    """One row of the result; without ``value``, ``error`` says why there is none.

    ``aim`` is in the unit of the figure; None without an aim. ``lacks_peer`` is True if the figure
    is relative to a peer that could not be measured, while ours could.
    """

    topic: str
    case: str
    figure: str
    value: float | None
    unit: str
    better: Better
    aim: float | None = None
    peers: tuple[PeerFigure, ...] = ()
    error: str = ""
    lacks_peer: bool = False

    def __post_init__(self) -> None:
        """Require a value or an error."""
        if self.value is None and not self.error:
            raise ValueError(f"{self.case}: expected a value, or an error that says why not")

    @property
    def is_reached(self) -> bool | None:
        """Whether the figure is as good as the aim; None where there is no aim."""
        if self.aim is None:
            return None
        if self.value is None:
            return False
        return self.value >= self.aim if self.better is Better.HIGHER else self.value <= self.aim

    def ratio(self, peer: PeerFigure) -> float | None:
        """Return how many times better ours is than the peer's; above 1 ours is better."""
        if self.value is None or peer.value is None:
            return None
        better, worse = (
            (self.value, peer.value) if self.better is Better.HIGHER else (peer.value, self.value)
        )
        return better / worse if worse > 0.0 else None

    def to_json(self) -> dict[str, Any]:
        """Return the record as plain values; ``error`` is a key only where there is no value."""
        row: dict[str, Any] = {
            "topic": self.topic,
            "case": self.case,
            "figure": self.figure,
            "value": self.value,
            "unit": self.unit,
            "better": self.better.value,
            "aim": self.aim,
            "reached": self.is_reached,
            "peers": [self._peer_to_json(peer) for peer in self.peers],
        }
        if self.value is None:
            row["error"] = self.error
        return row

    def _peer_to_json(self, peer: PeerFigure) -> dict[str, Any]:
        row: dict[str, Any] = {
            "name": peer.name,
            "version": peer.version,
            "value": peer.value,
            "ratio": self.ratio(peer),
        }
        if peer.value is None:
            row["error"] = peer.error
        return row


def gain(record: Record, peer_name: str, aim: float) -> Record:
    """Return a row for "so many times better than this peer", measured in the same run."""
    named = [
        peer
        for peer in record.peers
        if peer.name == peer_name or peer.name.startswith(f"{peer_name} (")
    ]
    ratio = record.ratio(named[0]) if named else None
    reason = f"{peer_name}: {named[0].error}" if named else f"{peer_name} was not measured"
    return Record(
        record.topic,
        record.case,
        f"{record.figure}: times better than {peer_name}",
        ratio,
        "x",
        Better.HIGHER,
        aim,
        error="" if ratio is not None else record.error or reason,
        lacks_peer=ratio is None and record.value is not None,
    )


def write_json(path: Path | None, records: Sequence[Record]) -> None:
    """Write the records as a list; to standard output without a path."""
    text = json.dumps([record.to_json() for record in records], indent=2)
    if path is None:
        print(text)
    else:
        write_output(path, f"{text}\n".encode())
