"""When a job goes home to charge, and when for good."""

from __future__ import annotations

from typing import Any
from unittest.mock import Mock

import pytest

from roomba.mission.phases.charges import when_low
from roomba.mission.phases.machine import Event


def asked(*, is_low: bool, is_in_vain: bool = False) -> Event | None:
    """What comes of it."""
    job: Any = Mock()
    job.ledger.must_go_home.return_value = is_low
    job.note_charge.return_value = is_in_vain
    step = when_low(job, Mock(), Mock())
    assert job.note_charge.called == is_low
    return None if step is None else step.event


def test_with_enough_it_goes_on() -> None:
    assert asked(is_low=False) is None


@pytest.mark.parametrize(("is_in_vain", "event"), [(False, Event.LOW), (True, Event.FINISHED)])
def test_with_too_little_it_goes_home_and_for_good_where_charges_bring_nothing(
    is_in_vain: bool, event: Event
) -> None:
    assert asked(is_low=True, is_in_vain=is_in_vain) is event
