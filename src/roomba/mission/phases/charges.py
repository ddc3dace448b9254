"""Going home to charge; a job is over when charges take it no further."""

from __future__ import annotations

from roomba.mission.driving.drives import Drives
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import PhaseStep


def when_low(job: Job, drives: Drives, senses: Senses) -> PhaseStep | None:
    """Return the step that leads home when the charge just suffices for the way; else None.

    The robot goes home to charge. It goes home for good once charge after charge went into the ways
    alone.
    """
    if not job.ledger.must_go_home(senses, drives.distance_home):
        return None
    is_over = job.note_charge(drives.context.occupancy.free_area)
    return PhaseStep(event=Event.FINISHED if is_over else Event.LOW)
