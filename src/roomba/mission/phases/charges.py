"""Going home to charge: a job that charges take no further is over."""

from __future__ import annotations

from roomba.mission.driving.drives import Drives
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import PhaseStep


def when_low(job: Job, drives: Drives, senses: Senses) -> PhaseStep | None:
    """Return what is to be done when what is left just suffices for the way home; else None.

    It goes home to charge, and for good once charge after charge went into the ways alone.
    """
    if not job.ledger.must_go_home(senses, drives.distance_home):
        return None
    is_over = job.note_charge(drives.context.occupancy.free_area)
    return PhaseStep(event=Event.FINISHED if is_over else Event.LOW)
