from __future__ import annotations

import pytest

from roomba.commands.exit_status import USAGE, guarded
from roomba.commands.options import UsageError
from roomba.errors import ConfigError, RoombaError


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (KeyboardInterrupt(), 130, "stopped on the way"),
        (OSError("the disk is full"), 1, "the disk is full; choose another file"),
    ],
)
def test_what_goes_wrong_is_told_in_a_line(
    error: BaseException, status: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> int:
        raise error

    assert guarded(work, "./roomba map") == status
    assert capsys.readouterr().err == f"./roomba map: {said}\n"


@pytest.mark.parametrize(("error", "status"), [(UsageError("no"), USAGE), (RoombaError("no"), 7)])
def test_what_cannot_be_used_has_the_status_that_is_given_for_it(
    error: RoombaError, status: int
) -> None:
    def work() -> int:
        raise error

    assert guarded(work, "./roomba map", 7) == status


def test_a_pipe_that_was_closed_is_not_told_as_an_error() -> None:
    def work() -> int:
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        guarded(work, "./roomba map")


def test_what_is_unfit_and_what_is_told_when_it_is_stopped_is_the_commands_own(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def unfit() -> int:
        raise ConfigError("no")

    def stopped() -> int:
        raise KeyboardInterrupt

    assert guarded(unfit, "./roomba campaign", 7, unfit=(ConfigError,)) == USAGE
    assert guarded(stopped, "./roomba campaign", stopped="the same command goes on") == 130
    assert capsys.readouterr().err.endswith("./roomba campaign: the same command goes on\n")
