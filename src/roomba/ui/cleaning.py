"""The menu's options for cleaning: what to clean, pause, stop, dock, and what the robot does.

Speaks to :mod:`roomba.client.protocol` alone, and decides nothing, as the rest of the menu.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from roomba.client.protocol import (
    CleanHandle,
    CleanReport,
    ErrandOutcome,
    MissedFloor,
    VacuumSnapshot,
)
from roomba.time_spent import TimeSpent, square_metres_a_minute
from roomba.ui.errand_progress import (
    area_text,
    clean_view,
    follow_errand,
    percent,
    time_text,
    to_go_text,
)
from roomba.ui.menu import Menu, Option, place
from roomba.ui.progress import quantity
from roomba.vocabulary import HELD, CleanMode

MOST_MISSED = 10
"""The most missed areas that a report names, the largest first."""

_ENDS = {
    ErrandOutcome.COMPLETED: "The clean is done, and the robot is back on its station",
    ErrandOutcome.STOPPED: "The clean was stopped",
    ErrandOutcome.REFUSED: "The robot refuses",
    ErrandOutcome.BATTERY: "The battery did not last",
    ErrandOutcome.STUCK: "The robot is stuck",
    ErrandOutcome.LOST: "The robot does not know where it is",
    ErrandOutcome.NOT_DOCKED: "The floor is done, but the robot is not on its station",
    ErrandOutcome.FAULT: "The robot gave up",
    ErrandOutcome.DISCONNECTED: "The connection to the clean was lost",
}
"""The sentence for each end of a clean."""

_DOCK_ENDS = {
    ErrandOutcome.COMPLETED: "The robot is on its charging station",
    ErrandOutcome.STOPPED: "The way to the station was stopped",
    ErrandOutcome.REFUSED: "The robot refuses",
    ErrandOutcome.DISCONNECTED: "The connection to the robot was lost",
}
"""The sentence for each end of a way to the station; at any other end the robot gave up."""


def clean(menu: Menu) -> None:
    """Ask what to clean, clean it, and tell what came of it."""
    mode, rooms = _ask_what(menu)
    with menu.interrupts.held():
        _follow_clean(menu, menu.robot.clean(mode, rooms=rooms))


def pause_or_go_on(menu: Menu) -> None:
    """Pause the robot; if it is paused or held, let it go on."""
    if menu.robot.vacuum().state in HELD:
        menu.robot.resume()
        menu.say("The robot goes on.")
    else:
        menu.robot.pause()
        menu.say(f"The robot pauses; press {menu.key_of(pause_or_go_on)} to let it go on.")


def stop(menu: Menu) -> None:
    """End what the robot does."""
    menu.robot.stop()
    menu.say("The robot has stopped, and stays where it is.")


def dock(menu: Menu) -> None:
    """Send the robot onto its station, and tell what came of it."""
    said: list[str] = []

    def show(state: str) -> None:
        if said[-1:] != [state]:
            said.append(state)
            menu.say(f"The robot is {state}.")

    with menu.interrupts.held():
        report = follow_errand(
            menu.robot.dock(), show, wants_to_leave=menu.interrupts.noted, clock=menu.clock
        )
    if report is None:
        leave_alone(menu)
        return
    end = _DOCK_ENDS.get(report.outcome, "The robot did not get onto its station")
    say_end(menu, end, report.outcome, report.message)


def empty_bin(menu: Menu) -> None:
    """Tell the robot that its dust bin was emptied."""
    menu.robot.empty_bin()
    menu.say("The robot knows that its dust bin is empty.")


def tell_state(menu: Menu) -> None:
    """Tell in one line what the robot does."""
    state = menu.robot.vacuum()
    menu.say(_state_line(state), style="yellow" if state.message else None)


CLEANING: tuple[Option, ...] = (
    Option("Clean", clean),
    Option("Pause, or go on", pause_or_go_on),
    Option("Stop, and stay", stop),
    Option("Dock: onto the charging station, by its beams", dock),
    Option("What the robot does", tell_state),
)
"""The options that the menu has for a robot that cleans."""

CLEANING_HEADING = "to clean"


def _ask_what(menu: Menu) -> tuple[CleanMode, Sequence[str]]:
    menu.say("  1. The whole home")
    menu.say("  2. Rooms")
    menu.say("  3. Here, around the robot")
    while True:
        answer = menu.ask(" What to clean (Enter: the whole home): ")
        if answer in ("", "1"):
            return CleanMode.WHOLE, ()
        if answer == "2":
            return CleanMode.ROOMS, _ask_rooms(menu, menu.robot.rooms())
        if answer == "3":
            return CleanMode.SPOT, ()
        menu.say("Please choose a valid number", style="red")


def _ask_rooms(menu: Menu, names: Sequence[str]) -> list[str]:
    for number, name in enumerate(names, start=1):
        menu.say(f"  {number}. {name}")
    known = {str(number): name for number, name in enumerate(names, start=1)}
    # a room's name takes precedence over a number that reads the same
    known |= {name.casefold(): name for name in names}
    while True:
        text = menu.ask(" Rooms, by name or number, with commas between: ")
        words = [word.strip().casefold() for word in text.split(",") if word.strip()]
        if words and all(word in known for word in words):
            return list(dict.fromkeys(known[word] for word in words))
        menu.say(f"Expected rooms of this list, got {text!a}. Please try again.", style="red")


def _follow_clean(menu: Menu, under_way: CleanHandle) -> None:
    with clean_view(menu.console, menu.clock) as view:
        report = follow_errand(
            under_way, view.show, wants_to_leave=menu.interrupts.noted, clock=menu.clock
        )
    if report is None:
        leave_alone(menu)
        return
    say_end(menu, _ENDS[report.outcome], report.outcome, report.message)
    if report.outcome is not ErrandOutcome.REFUSED:
        _tell_numbers(menu, report)
    if report.outcome is ErrandOutcome.DISCONNECTED:
        menu.say(f"Press {menu.key_of(tell_state)} to see whether the robot goes on with it.")


def leave_alone(menu: Menu) -> None:
    """Tell what can be done while the robot goes on by itself."""
    pauses, stops, tells = (menu.key_of(act) for act in (pause_or_go_on, stop, tell_state))
    menu.say(
        f"The robot goes on by itself: press {pauses} to pause it, {stops} to stop it, {tells} to "
        "see how far it is."
    )


def say_end(menu: Menu, text: str, outcome: ErrandOutcome, message: str) -> None:
    """Tell how an errand ended, and why if it did not end well."""
    reason = " ".join(message.split())
    is_good = outcome in (ErrandOutcome.COMPLETED, ErrandOutcome.STOPPED)
    menu.say(f"{text}: {reason}" if reason else f"{text}.", style=None if is_good else "red")


def _tell_numbers(menu: Menu, report: CleanReport) -> None:
    menu.say(f"Cleaned: {area_text(report.covered, report.wanted)}")
    if math.isfinite(report.distance):
        menu.say(f"Distance travelled: {quantity(report.distance, 'm')}")
    rate = square_metres_a_minute(report.covered, report.duration)
    at_rate = "" if rate is None else f", {rate:.2f} m² a minute"
    menu.say(f"Time taken: {time_text(report.duration)}{at_rate}")
    if report.times.times_least is not None:
        menu.say(f"Where it went: {_times_text(report.times)}")
    if math.isfinite(report.energy):
        menu.say(f"Energy used: {quantity(report.energy, 'Wh')}")
        menu.say(f"Dirt picked up: {quantity(report.dirt, 'g')}")
    for floor in report.missed[:MOST_MISSED]:
        menu.say(f"Missed: {_missed_text(floor)}")
    if len(report.missed) > MOST_MISSED:
        menu.say(f"Missed: {len(report.missed) - MOST_MISSED} smaller areas more")


def _times_text(times: TimeSpent) -> str:
    return ", ".join(f"{name} {time_text(spent)}" for name, spent in times.parts if spent >= 0.5)


def _missed_text(floor: MissedFloor) -> str:
    room = f" in {floor.room}" if floor.room else ""
    return f"{quantity(floor.area, 'm²')}{room}, at {place(floor.x, floor.y)}: {floor.reason}"


def _state_line(state: VacuumSnapshot) -> str:
    parts = [
        state.state if state.phase in ("", state.state) else f"{state.state} ({state.phase})",
        f"in {state.room}" if state.room else "",
        f"battery {percent(state.battery)}",
    ]
    if state.wanted > 0.0:
        parts.append(f"cleaned {area_text(state.covered, state.wanted)}")
        parts.append(to_go_text(state.seconds_to_go))
    line = f"State: {', '.join(part for part in parts if part)}"
    return f"{line}: {' '.join(state.message.split())}" if state.message else line
