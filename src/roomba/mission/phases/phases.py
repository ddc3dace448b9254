"""The phases of exploring and of going home."""

from __future__ import annotations

from dataclasses import replace

from roomba.mission.cleaning.request import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.path_driver import DriveState
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.planning.path.planner import NoPathError


def explore(job: Job, drives: Drives, senses: Senses, limit: float, most_stuck: int) -> PhaseStep:
    """Go to the nearest place from where more can be seen; stuck too often it fails."""
    exploration = job.exploration
    assert exploration is not None
    if job.ledger.must_go_home(senses, drives.distance_home):
        return PhaseStep(event=Event.LOW)
    if drives.driver is not None:
        return look_on(exploration, drives, senses, limit, most_stuck)
    obstacles = drives.obstacles.standing(senses.now)
    given_up = len(exploration.unseen)
    points = exploration.next_path(senses.pose, drives.context, obstacles)
    if points is None:
        # It may have given up before it tried all.
        tried_all = len(exploration.unseen) == given_up
        is_done = tried_all and not forget_obstacles_once(exploration, drives)
        return PhaseStep(event=Event.FINISHED if is_done else None)
    drives.begin(points, senses)
    return replace(look_on(exploration, drives, senses, limit, most_stuck), message="")


def forget_obstacles_once(exploration: Exploration, drives: Drives) -> bool:
    """Forget what stands in the way, once before the end: it may have gone; return whether now."""
    if exploration.looked_again:
        return False
    exploration.looked_again = True
    drives.obstacles.forget()
    return True


def look_on(
    exploration: Exploration, drives: Drives, senses: Senses, limit: float, most_stuck: int
) -> PhaseStep:
    """Drive on to a frontier; one where it got stuck is given up, the last time it fails."""
    assert drives.driver is not None
    if exploration.is_too_long(senses.now):
        exploration.cut_off()
        drives.driver = None
        return PhaseStep()
    step = drives.driver.tick(senses, limit)
    if step.state is DriveState.BACKING:
        exploration.note_touch(senses.pose)
    elif exploration.is_as_near_as_it_gets:
        exploration.cut_off()
        drives.driver = None
        return PhaseStep()
    is_stuck = step.state is DriveState.STUCK
    if is_stuck and exploration.times_stuck >= most_stuck:
        return PhaseStep(step.twist, failure=Failure(CleanOutcome.STUCK, step.reason))
    if step.state.is_over:
        if step.state is not DriveState.DONE:
            exploration.cut_off(is_stuck=is_stuck)
        drives.driver = None
    return PhaseStep(step.twist)


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
    return step if step.message else replace(step, message="")


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
    """Once more without what was remembered; a door may open; then it says there is no way."""
    retries.found_no_way_home()
    if retries.is_over:
        return PhaseStep(failure=Failure(CleanOutcome.NOT_DOCKED, reason))
    if retries.must_wait:
        return wait(reason, drives, retries, senses)
    drives.obstacles.forget()
    return PhaseStep()


def wait(reason: str, drives: Drives, retries: RetryPolicy, senses: Senses) -> PhaseStep:
    """Wait for a while, and then look anew: a door that is shut is opened again.

    A person before the robot may be waiting for it to go: it makes room.
    """
    retries.wait(senses.now)
    drives.make_room(senses)
    drives.obstacles.forget()
    return PhaseStep(message=f"{reason}; it waits for a way to open")


def wait_on(drives: Drives, retries: RetryPolicy, senses: Senses, limit: float) -> PhaseStep | None:
    """While it waits: stand, or drive on to where others can pass; None when it does not wait.

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
