"""How a question to the robot deals with good answers, bad ones and none."""

from __future__ import annotations

import math

import pytest

from roomba.drivers.neato.answers import AnswerError
from roomba.drivers.neato.conversation import END, Conversation, SilenceError
from roomba.drivers.neato.questions import Question, UntoldError

PERIOD, LONGEST = 0.5, 2.0


class Talk:
    """A line with a clock: an answer ``takes`` s, and is ``said``; None: no answer comes."""

    def __init__(self) -> None:
        self.now, self.said = 10.0, "1"
        self.is_silent, self.takes = False, 0.1
        self._asked = b""
        self.took: list[str] = []
        self.line = Conversation(self, lambda: self.now)
        self.question = Question("GetIt", "its eyes", PERIOD, self._take)

    def _take(self, lines: list[str]) -> None:
        if lines != ["1"]:
            raise AnswerError("expected 1")
        self.took += lines

    def ask(self) -> None:
        self.question.ask(self.line, lambda: self.now)

    def write(self, data: bytes) -> None:
        self._asked = data

    def read(self, seconds: float) -> bytes:
        if self.is_silent:
            self.now += seconds
            return b""
        self.now += self.takes
        return self._asked + self.said.encode() + b"\n" + END

    def discard(self) -> None:
        pass

    def close(self) -> None:
        pass


def test_a_good_answer_is_taken_and_told_when() -> None:
    talk = Talk()
    talk.ask()
    assert talk.took == ["1"]
    assert (talk.question.asked_at, talk.question.told_at) == (10.0, pytest.approx(10.1))
    assert talk.question.took == pytest.approx(0.1)


def test_it_is_asked_by_its_period_and_at_once_after_its_first_failure() -> None:
    talk = Talk()
    assert talk.question.urgency(talk.now) == math.inf
    talk.ask()
    assert talk.question.urgency(talk.question.asked_at + 2.0 * PERIOD) == pytest.approx(2.0)
    talk.said = "2"
    with pytest.raises(AnswerError):
        talk.ask()
    assert talk.question.urgency(talk.now) == math.inf
    with pytest.raises(AnswerError):
        talk.ask()
    assert talk.question.urgency(talk.now) < 1.0


@pytest.mark.parametrize("is_silent", [False, True])
def test_failures_are_trouble_from_the_second_on_when_the_last_good_answer_is_old(
    *, is_silent: bool
) -> None:
    talk = Talk()
    talk.ask()
    talk.now += LONGEST
    talk.said, talk.is_silent = "2", is_silent
    with pytest.raises((AnswerError, SilenceError)):
        talk.ask()
    talk.question.check(talk.now, LONGEST)
    with pytest.raises((AnswerError, SilenceError)):
        talk.ask()
    talk.question.check(talk.now, 2.0 * LONGEST)
    with pytest.raises(UntoldError, match="expected GetIt to tell of its eyes, got none for 2"):
        talk.question.check(talk.now, LONGEST)
    talk.said, talk.is_silent = "1", False
    talk.ask()
    talk.question.check(talk.now, 0.0)


def test_what_was_not_asked_is_no_trouble() -> None:
    talk = Talk()
    talk.ask()
    talk.question.check(talk.now + 60.0, LONGEST)


def test_one_that_is_required_says_of_what_it_does_not_tell() -> None:
    talk = Talk()
    talk.said = "2"
    with pytest.raises(UntoldError, match="expected GetIt to tell of its eyes: expected 1"):
        talk.question.require(talk.line, lambda: talk.now)


def test_what_an_answer_took_longer_than_the_quickest_is_its_lateness() -> None:
    talk = Talk()
    for takes in (0.15, 0.1, 0.25):
        talk.takes = takes
        talk.ask()
    assert talk.question.lateness == pytest.approx(0.15)
