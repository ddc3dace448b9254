"""The menu's option for making a map. Speaks to :mod:`roomba.client.protocol` alone, and decides
nothing."""

from __future__ import annotations

import math

from roomba.client.protocol import ErrandOutcome, ExploreReport
from roomba.ui.cleaning import CLEANING, empty_bin, leave_alone, say_end
from roomba.ui.errand_progress import follow_errand, time_text
from roomba.ui.menu import Menu, Option
from roomba.ui.progress import quantity

STEP = 5.0
"""m2 of newly known floor after which the menu tells the area again."""

_ENDS = {
    ErrandOutcome.COMPLETED: "All that can be seen is mapped, and the robot is back on its station",
    ErrandOutcome.STOPPED: "The exploration was stopped",
    ErrandOutcome.REFUSED: "The robot refuses",
    ErrandOutcome.BATTERY: "The battery did not last",
    ErrandOutcome.STUCK: "The robot is stuck",
    ErrandOutcome.LOST: "The robot does not know where it is",
    ErrandOutcome.NOT_DOCKED: "All was seen, but the robot is not on its station",
    ErrandOutcome.FAULT: "The robot gave up",
    ErrandOutcome.DISCONNECTED: "The connection to the exploration was lost",
}
"""The sentence for each end of an exploration."""


def explore(menu: Menu) -> None:
    """Let the robot make its map, tell how much it knows, and what came of it."""
    said = -math.inf

    def show(known: float) -> None:
        nonlocal said
        if known >= said + STEP:
            said = known
            menu.say(f"The robot knows {quantity(known, 'm²')}.")

    with menu.interrupts.held():
        report = follow_errand(
            menu.robot.explore(), show, wants_to_leave=menu.interrupts.noted, clock=menu.clock
        )
    if report is None:
        leave_alone(menu)
        return
    say_end(menu, _ENDS[report.outcome], report.outcome, report.message)
    if report.outcome is not ErrandOutcome.REFUSED:
        _tell_numbers(menu, report)


def _tell_numbers(menu: Menu, report: ExploreReport) -> None:
    if math.isfinite(report.known):
        menu.say(f"Known: {quantity(report.known, 'm²')}")
    if math.isfinite(report.distance):
        menu.say(f"Distance travelled: {quantity(report.distance, 'm')}")
    menu.say(f"Time taken: {time_text(report.duration)}")


TASKS: tuple[Option, ...] = (
    *CLEANING,
    Option("Explore: make a map of a home that it does not know", explore),
    Option("The dust bin was emptied", empty_bin),
)
"""The options that the menu has for a robot that cleans and makes maps."""
