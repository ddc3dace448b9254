"""A question that a Neato is asked again and again, and since when it gave no good answer."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from roomba.drivers.line import LineError
from roomba.drivers.neato.answers import AnswerError
from roomba.drivers.neato.conversation import Conversation, SilenceError
from roomba.vocabulary import Hindrance

ANSWER: Final = 0.3
"""s; the longest wait for a short answer."""
_MOST_FAILURES: Final = 2
"""Failures in a row that count: a single one may be the line's, and is asked again at once."""


class UntoldError(LineError):
    """The robot is there, and does not tell what it must; the message says what."""

    trouble = "the robot stands, as it does not tell what it senses"
    remedy = "Look at that sensor, or switch the robot off and on"
    hindrance = Hindrance.SENSOR_SILENT


@dataclass(slots=True, eq=False)
class Question:
    """A command that is asked every ``period`` s; ``tells`` says of what its answer tells.

    Times in s. ``within`` is the longest wait for an answer, ``asked_at`` when it was asked last,
    ``told_at`` when its newest good answer came, ``took`` how long the newest answer took, and
    ``quickest`` the quickest one.
    """

    command: str
    tells: str
    period: float
    take: Callable[[list[str]], None]
    """Takes the lines of an answer; raises AnswerError."""
    within: float = ANSWER
    asked_at: float = -math.inf
    told_at: float = -math.inf
    took: float = 0.0
    quickest: float = math.inf
    _failures: int = 0
    _why: str = ""

    def ask(self, line: Conversation, now: Callable[[], float]) -> None:
        """Ask, and take the answer; raises AnswerError, SilenceError or LineError."""
        self.asked_at = now()
        try:
            lines = line.ask(self.command, self.within)
            self.took, self.quickest = line.took, min(self.quickest, line.took)
            self.take(lines)
        except (AnswerError, SilenceError) as error:
            self._failures += 1
            self._why = str(error)
            raise
        self.told_at, self._failures = now(), 0

    @property
    def lateness(self) -> float:
        """How much longer the newest answer took than the quickest one: it may have waited, s."""
        return self.took - self.quickest

    def require(self, line: Conversation, now: Callable[[], float]) -> None:
        """Ask for the first time; raises UntoldError where the answer is not good."""
        try:
            self.ask(line, now)
        except AnswerError as error:
            raise UntoldError(f"{self._expected}: {self._why}") from error

    def check(self, now: float, longest: float) -> None:
        """Raise UntoldError after two failures if the last good answer is ``longest`` s old."""
        age = now - self.told_at
        if self._failures >= _MOST_FAILURES and age > longest:
            raise UntoldError(f"{self._expected}, got none for {age:.1f} s: {self._why}")

    def urgency(self, now: float) -> float:
        """Return the time since it was asked, in periods; infinite after a first failure."""
        is_to_be_repeated = 0 < self._failures < _MOST_FAILURES
        return math.inf if is_to_be_repeated else (now - self.asked_at) / self.period

    @property
    def _expected(self) -> str:
        return f"expected {self.command} to tell of {self.tells}"
