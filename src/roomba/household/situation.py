"""What a look at the robot means for plans: whether it works, can begin, and what ended."""

from __future__ import annotations

import math
from typing import Final

from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.under_way import is_done
from roomba.client.view import RobotView
from roomba.plans.scheduler import PlanEnd, Situation
from roomba.vocabulary import AT_REST, Phase

_DONE: Final = (ErrandOutcome.COMPLETED, ErrandOutcome.NOT_DOCKED)


class EndedErrands:
    """Finds errands that ended since the last look; one that ended before the first is ignored."""

    def __init__(self) -> None:
        """Begin before the first look."""
        self._last: CleanReport | None = None
        self._is_first = True

    def news(self, view: RobotView | None) -> CleanReport | None:
        """Return the report of an errand that ended since the look before; None if none did."""
        if view is None:
            return None
        is_news = not self._is_first and view.last is not self._last
        self._last, self._is_first = view.last, False
        return view.last if is_news else None


def situation_of(
    view: RobotView | None, ended: CleanReport | None, least_battery: float
) -> Situation:
    """Return what the robot does, by a look and how an errand ended since the one before.

    ``view`` is None while the robot does not answer; with a battery below ``least_battery``, 0..1,
    the robot cannot begin.
    """
    if view is None:
        return Situation(unfit="the robot does not answer")
    end, message = (None, "") if ended is None else _ending(ended)
    phase = view.vacuum.phase
    is_busy, is_paused = phase not in AT_REST, phase == Phase.PAUSED
    return Situation(
        _unfit(view, least_battery),
        is_busy,
        is_paused,
        bool(view.held),
        is_done(view.vacuum),
        end,
        message,
    )


def _unfit(view: RobotView, least_battery: float) -> str:
    """Return why no clean can begin; the same words while the reason is the same."""
    vacuum = view.vacuum
    if view.held:
        return "the emergency stop holds the drive"
    if vacuum.state == "error":
        return "the robot needs help"
    if vacuum.phase not in AT_REST:
        return "the robot is busy"
    if vacuum.battery < least_battery:  # a battery that is not heard of is not judged
        return f"the battery is below {100.0 * least_battery:.0f} %"
    return ""


def _ending(report: CleanReport) -> tuple[PlanEnd, str]:
    """Return how an errand ended, and what is said of it."""
    if report.outcome in _DONE:
        return PlanEnd.DONE, "; ".join(filter(None, (_cleaned(report), report.message)))
    if report.outcome is ErrandOutcome.STOPPED:
        return PlanEnd.STOPPED, ""
    return PlanEnd.FAILED, report.message or report.outcome.value


def _cleaned(report: CleanReport) -> str:
    """Return how much became clean; empty of a robot that does not tell it."""
    is_told = math.isfinite(report.covered) and math.isfinite(report.wanted)
    return f"{report.covered:.1f} of {report.wanted:.1f} m²" if is_told else ""
