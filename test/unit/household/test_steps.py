"""Steps that fail: the others are taken, and what went wrong is told once while it lasts."""

from __future__ import annotations

from roomba.household.steps import NotDoneError, Steps


def fail(error: Exception) -> None:
    raise error


def test_a_step_that_fails_holds_up_no_other_one_and_each_trouble_is_told() -> None:
    told, taken = list[str](), list[int]()
    Steps(told.append).take(
        lambda: fail(NotDoneError("wait")),
        lambda: taken.append(1),
        lambda: fail(OSError("it is full")),
        lambda: fail(ZeroDivisionError("a fault")),
        lambda: fail(OSError("it is full")),
        lambda: taken.append(2),
    )
    assert taken == [1, 2]
    waits, full, fault = told
    assert waits == "wait"
    assert full == "what belongs to the household was not kept: it is full"
    assert "in fail" in fault
    assert "ZeroDivisionError: a fault" in fault


def test_a_trouble_that_lasts_is_told_once_while_another_one_comes_and_goes() -> None:
    told = list[str]()
    steps = Steps(told.append)
    for others in ([], ["first"], [], ["second"], ["second"], ["first"], []):
        steps.take(
            *(lambda other=other: fail(NotDoneError(other)) for other in others),
            lambda: fail(NotDoneError("it lasts")),
        )
    assert told == ["it lasts", "first", "second", "first"]
    steps.take(lambda: None)
    steps.take(lambda: fail(NotDoneError("it lasts")))
    assert told[4:] == ["it lasts"]
