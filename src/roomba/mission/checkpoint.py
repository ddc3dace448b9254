"""Checkpoints of a mission: its state as plain values, and back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from roomba.clean_request import CleanRequest
from roomba.configuration.mission import ExploringConfig
from roomba.errors import RoombaError
from roomba.mission.cleaning.checkpoint import VERSION, CheckpointError, Values, request_of
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, MissionState
from roomba.vocabulary import EdgeReason, Hindrance, OpenEdge, Phase, Reason


@dataclass(frozen=True, slots=True, eq=False)
class Remembered:
    """A checkpoint's content; ``ledger`` is distance m, energy Wh and dirt g; ``duration`` s.

    ``driven`` is the way, m, and the energy, Wh, of that while it drove.
    ``times`` are those of a time ledger; ``open_edges`` and ``rough_way``, m, those of the job.
    ``bin_full_at`` is what the bin's sensor read as it became full, g; None: that is not known.
    """

    state: MissionState
    reason: Reason
    outcome: CleanOutcome | None
    cleaning: Cleaning | None
    exploration: Exploration | None
    ledger: tuple[float, float, float]
    driven: tuple[float, float]
    duration: float
    is_bin_full: bool
    bin_full_at: float | None
    times: dict[str, float]
    open_edges: tuple[OpenEdge, ...]
    rough_way: float


def checkpoint_of(state: MissionState, reason: Reason, job: Job, now: float) -> Values | None:
    """Return the checkpoint of a job as plain values; None without an errand."""
    if state.errand is Errand.NONE or state.errand is Errand.UNDOCK:
        return None
    return {
        "version": VERSION,
        "phase": state.phase.name,
        "errand": state.errand.name,
        "resumes": None if state.resumes is None else state.resumes.name,
        "message": reason.text,
        "hindrance": reason.hindrance.name,
        "outcome": None if job.outcome is None else job.outcome.name,
        "cleaning": None if job.cleaning is None else job.cleaning.values(),
        "exploration": None if job.exploration is None else job.exploration.values(),
        "ledger": [job.ledger.distance, job.ledger.energy, job.ledger.dirt],
        "driven": [job.ledger.driven, job.ledger.used],
        "duration": job.duration(now),
        "times": job.times.values(),
        "bin_full": job.bin.is_full,
        "bin_full_at": job.bin.full_at,
        "open_edges": [[edge.length, edge.x, edge.y, edge.reason.name] for edge in job.open_edges],
        "rough_way": job.rough_way,
    }


def remembered(
    values: Values, begin: Callable[[CleanRequest], Cleaning], config: ExploringConfig
) -> Remembered:
    """Return the content of a checkpoint; ``begin`` makes a request's clean in the present map.

    Raises CheckpointError for values that are no checkpoint, or one of another map.
    """
    try:
        return _remembered(values, begin, config)
    except (LookupError, ArithmeticError, AttributeError, TypeError, ValueError) as error:
        raise CheckpointError(f"expected a checkpoint of this map: {error!r}") from error
    except RoombaError as error:
        raise CheckpointError(f"expected a checkpoint of this map: {error!r}") from error


def _remembered(
    values: Values, begin: Callable[[CleanRequest], Cleaning], config: ExploringConfig
) -> Remembered:
    if values["version"] != VERSION:
        raise CheckpointError(f"expected version {VERSION}, got {values['version']}")
    resumes, outcome = values["resumes"], values["outcome"]
    phase, errand = Phase[values["phase"]], Errand[values["errand"]]
    state = MissionState(phase, errand, None if resumes is None else Phase[resumes])
    cleaning = None
    if values["cleaning"] is not None:
        cleaning = begin(request_of(values["cleaning"]["request"]))
        cleaning.restore(values["cleaning"])
    elif errand is Errand.CLEAN:
        raise CheckpointError("expected the clean that it was on, got none")
    unseen = values["exploration"]
    exploration = None if unseen is None else Exploration.of(unseen, config)
    if errand is Errand.EXPLORE and exploration is None:
        raise CheckpointError("expected the exploration that it was on, got none")
    distance, energy, dirt = (float(value) for value in values["ledger"])
    duration = float(values["duration"])
    times = {str(name): float(value) for name, value in values["times"].items()}
    # Older checkpoints have none of these.
    reason = Reason(str(values["message"]), Hindrance[values.get("hindrance", "NONE")])
    driven, used = (float(value) for value in values.get("driven", (distance, energy)))
    full_at = None if values.get("bin_full_at") is None else float(values["bin_full_at"])
    rough_way = float(values.get("rough_way", 0.0))
    edges = tuple(
        OpenEdge(float(length), float(x), float(y), EdgeReason[reason])
        for length, x, y, reason in values.get("open_edges", [])
    )
    lengths = (value for edge in edges for value in (edge.length, edge.x, edge.y))
    numbers = (distance, energy, dirt, driven, used, duration, full_at or 0.0, rough_way)
    if not all(math.isfinite(value) for value in (*numbers, *times.values(), *lengths)):
        raise CheckpointError("expected finite numbers")
    return Remembered(
        state,
        reason,
        None if outcome is None else CleanOutcome[outcome],
        cleaning,
        exploration,
        (distance, energy, dirt),
        (driven, used),
        duration,
        bool(values["bin_full"]),
        full_at,
        times,
        edges,
        rough_way,
    )


def take_up(found: Remembered, job: Job, senses: Senses) -> None:
    """Let ``job`` go on as the one that was remembered."""
    job.cleaning, job.exploration, job.outcome = found.cleaning, found.exploration, found.outcome
    job.goes_on_after(found.duration, senses)
    job.times.restore(found.times)
    job.open_edges, job.rough_way = found.open_edges, found.rough_way
    job.ledger.distance, job.ledger.energy, job.ledger.dirt = found.ledger
    job.ledger.driven, job.ledger.used = found.driven
    if found.is_bin_full:
        # It may have been emptied while the program was not running.
        job.bin.fill(senses.in_bin if found.bin_full_at is None else found.bin_full_at)


def state_after(state: MissionState, *, is_docked: bool) -> MissionState:
    """Return the state in which a mission resumes from a checkpoint."""
    goes_on = state.errand in (Errand.CLEAN, Errand.EXPLORE)
    if state.resumes is not None and goes_on and is_docked:
        return replace(state, resumes=Phase.CHARGING)
    if state.resumes in (Phase.CLEANING, Phase.EXPLORING):
        return replace(state, resumes=Phase.UNDOCKING)
    if not state.drives:
        return state
    if goes_on:
        if is_docked and state.phase in (Phase.RETURNING, Phase.DOCKING):
            return MissionState(Phase.CHARGING, state.errand)
        return MissionState(Phase.UNDOCKING, state.errand)
    if is_docked:
        return MissionState(Phase.DOCKED)
    return MissionState(Phase.RETURNING, state.errand)
