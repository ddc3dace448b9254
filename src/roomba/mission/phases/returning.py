"""The phase of returning home, and of waiting where no way leads there."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.path_driver import DriveState
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.planning.path.planner import NoPathError
from roomba.vocabulary import NO_REASON, Hindrance, Reason

_PARTED: Final = (
    "; walls or zones of its map part it from its station: carry it there, or take the zone away"
)


def go_home(drives: Drives, retries: RetryPolicy, senses: Senses, limit: float) -> PhaseStep:
    """Drive to the place before the station; where no way leads there it waits for one."""
    staging = drives.context.staging
    if senses.battery.is_docked:
        return PhaseStep(event=Event.CONTACT)
    if senses.pose.distance_to(staging.x, staging.y) < drives.context.staging_tolerance:
        return PhaseStep(event=Event.ARRIVED)
    waiting = wait_on(drives, retries, senses, limit)
    if waiting is not None:
        return waiting
    if drives.driver is not None:
        return _go_home_on(drives, retries, senses, limit)
    if not drives.begin_to_leave_zone(senses):
        try:
            points = drives.way_home(senses)
        except NoPathError as error:
            return try_home_again(f"no way home: {error}", drives, retries, senses)
        drives.begin(points, senses)
    step = _go_home_on(drives, retries, senses, limit)
    return step if step.reason else replace(step, reason=NO_REASON)


def _go_home_on(drives: Drives, retries: RetryPolicy, senses: Senses, limit: float) -> PhaseStep:
    assert drives.driver is not None
    step = drives.driver.tick(senses, limit)
    if step.state is DriveState.STUCK:
        return PhaseStep(step.twist, failure=Failure(CleanOutcome.STUCK, step.reason))
    if step.state.is_over:
        drives.driver = None
    if step.state is DriveState.CUT_OFF:
        return try_home_again(step.reason, drives, retries, senses)
    return PhaseStep(step.twist)


def try_home_again(reason: str, drives: Drives, retries: RetryPolicy, senses: Senses) -> PhaseStep:
    """Try again without remembered obstacles, then wait for a way to open, and fail at last.

    If walls or zones of the map are in between, no way opens: then it fails without a wait.
    """
    retries.found_no_way_home()
    if retries.is_over:
        return PhaseStep(failure=Failure(CleanOutcome.NOT_DOCKED, reason))
    if retries.must_wait:
        if drives.is_parted_from_home(senses):
            return PhaseStep(failure=Failure(CleanOutcome.NOT_DOCKED, f"{reason}{_PARTED}"))
        return wait(reason, drives, retries, senses)
    drives.obstacles.forget()
    return PhaseStep()


def wait(reason: str, drives: Drives, retries: RetryPolicy, senses: Senses) -> PhaseStep:
    """Wait for a while, and then look anew: a door that is shut may be opened.

    A person before the robot may be waiting for it to go: it makes room.
    """
    retries.wait(senses.now)
    drives.make_room(senses)
    drives.obstacles.forget()
    text = f"{reason}; it waits for a way to open, and looks again within {retries.length:g} s"
    return PhaseStep(reason=Reason(text, Hindrance.NO_WAY, retries.length))


def wait_on(drives: Drives, retries: RetryPolicy, senses: Senses, limit: float) -> PhaseStep | None:
    """While waiting: stand, or drive on to where people can pass; None when it does not wait.

    As soon as there is a way it waits no longer.
    """
    stands = drives.driver is None and retries.is_waiting(senses.now)
    if stands and retries.take_look(senses.now) and drives.may_go_home(senses):
        retries.end()
    if retries.take_end(senses.now):
        drives.driver = None
    if not retries.is_waiting(senses.now):
        return None
    if drives.driver is None:
        return PhaseStep()
    step = drives.driver.tick(senses, limit)
    if step.state.is_over:
        drives.driver = None
    return PhaseStep(step.twist)
