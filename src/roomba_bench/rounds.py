"""The contest: contestants take turns for several rounds, and the best round of each counts.

Noise makes a machine slower and never faster, and by turns it affects all contestants.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from roomba_bench.contestants import Contestant, ContestantError
from roomba_bench.record import PeerFigure


@dataclass(frozen=True)
class Pace:
    """How thorough: ``rounds`` of at least ``seconds`` each."""

    rounds: int = 4
    seconds: float = 0.5

    def __str__(self) -> str:
        """Say it as the report does."""
        return f"best of {self.rounds} interleaved rounds of at least {self.seconds:g} s each"


THOROUGH = Pace()
QUICK = Pace(2, 0.1)


@dataclass
class Outcome:
    """A contestant's result: its best ``rate``, or the ``error`` that kept it out."""

    name: str
    version: str = ""
    rate: float | None = None
    error: str = ""
    facts: dict[str, float] = field(default_factory=dict)

    def figure(self, of_rate: Callable[[float], float] = float) -> PeerFigure:
        """Return it as a peer's figure; ``of_rate`` converts units per second to the unit."""
        value = None if self.rate is None else of_rate(self.rate)
        return PeerFigure(self.name, self.version, value, self.error)

    def fact(self, name: str) -> PeerFigure:
        """Return one of its facts as a peer's figure."""
        error = self.error or ("" if name in self.facts else "it does not tell")
        return PeerFigure(self.name, self.version, self.facts.get(name), error)


def milliseconds(rate: float) -> float:
    """Return how long one unit takes."""
    return 1000.0 / rate


def compete(contestants: Sequence[Contestant], pace: Pace) -> list[Outcome]:
    """Measure all, in turns; outcomes in the order of the contestants."""
    outcomes = [Outcome(contestant.name) for contestant in contestants]
    try:
        for contestant, outcome in zip(contestants, outcomes, strict=True):
            _prepare(contestant, outcome)
        for _ in range(pace.rounds):
            for contestant, outcome in zip(contestants, outcomes, strict=True):
                if not outcome.error:
                    _run(contestant, outcome, pace.seconds)
    finally:
        for contestant in contestants:
            contestant.end()
    return outcomes


def _prepare(contestant: Contestant, outcome: Outcome) -> None:
    try:
        outcome.version, outcome.facts = contestant.prepare()
    except ContestantError as error:
        _leave_out(outcome, error)


def _run(contestant: Contestant, outcome: Outcome, seconds: float) -> None:
    try:
        outcome.rate = max(outcome.rate or 0.0, contestant.run(seconds))
    except ContestantError as error:
        _leave_out(outcome, error)


def _leave_out(outcome: Outcome, error: ContestantError) -> None:
    outcome.error, outcome.rate = str(error), None
    print(f"bench: {outcome.name} is left out: {error}", file=sys.stderr)
