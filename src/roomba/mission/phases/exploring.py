"""The phase of exploring: driving to where more can be seen, until there is no such place."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.path_driver import DriveState
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.charges import when_low
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.vocabulary import NO_REASON

_MOST_SHUT_IN: Final = 3
"""Times that the robot forgets what shuts it in; then it takes the floor it knows for all."""


def explore(job: Job, drives: Drives, senses: Senses, limit: float, most_stuck: int) -> PhaseStep:
    """Go to the next place from where more can be seen; fail when stuck too often."""
    exploration = job.exploration
    assert exploration is not None
    if (charging := when_low(job, drives, senses)) is not None:
        return charging
    if drives.driver is not None:
        return look_on(exploration, drives, senses, limit, most_stuck)
    obstacles = drives.obstacles.standing(senses.now)
    given_up = exploration.times_given_up
    points = exploration.next_path(senses.pose, drives.context, obstacles)
    if points is None:
        # It may have given up before it tried all.
        if (
            exploration.times_given_up > given_up
            or forget_obstacles_once(exploration, drives)
            or _forgets_what_shuts_in(exploration, drives, senses)
        ):
            return PhaseStep()
        if not drives.may_go_home(senses):
            exploration.give_up_all(senses.pose, drives.context)
        return PhaseStep(event=Event.FINISHED)
    drives.begin(points, senses)
    return replace(look_on(exploration, drives, senses, limit, most_stuck), reason=NO_REASON)


def _forgets_what_shuts_in(exploration: Exploration, drives: Drives, senses: Senses) -> bool:
    """Forget obstacles that shut the robot in, as it has not seen all; return whether it did.

    The robot came in there, so what it touched must be narrower than it is taken to be.
    """
    if exploration.times_shut_in >= _MOST_SHUT_IN or drives.may_go_home(senses):
        return False
    exploration.times_shut_in += 1
    drives.obstacles.forget()
    return True


def forget_obstacles_once(exploration: Exploration, drives: Drives) -> bool:
    """Forget, once before the end, what may have left the way; return whether that was now."""
    if exploration.looked_again:
        return False
    exploration.looked_again = True
    drives.obstacles.forget_what_goes()
    return True


def look_on(
    exploration: Exploration, drives: Drives, senses: Senses, limit: float, most_stuck: int
) -> PhaseStep:
    """Drive on to a frontier; give it up when stuck there, and fail when stuck too often."""
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
