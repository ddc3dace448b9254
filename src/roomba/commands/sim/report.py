"""A run as a table for people, and many runs as one."""

from __future__ import annotations

from typing import Final

from rich.table import Table

from roomba.commands.output import clock, named_table
from roomba.commands.sim.percentiles import PERCENTS, ROWS
from roomba.commands.trials.figures import Figures, MissedShare
from roomba.commands.trials.unreached import NOTHING, Unreached
from roomba.world.home.home import StationPlace

_SHOWN: Final = 8
"""The most missed areas or failures that are listed one by one."""
_ELSEWHERE: Final = "--station X Y THETA puts it elsewhere"


def lines_of(
    figures: Figures, unreached: Unreached = NOTHING, place: StationPlace = StationPlace.TOLD
) -> list[tuple[str, str]]:
    """Return the rows of a run's table: a name and a text.

    ``place`` is how the station's place is known; unless it was given, the rows tell how to give
    it.
    """
    ratio = figures.path_ratio
    lines = [
        ("outcome", _outcome(figures)),
        ("coverage", _coverage(figures)),
        (
            "way",
            f"{figures.distance_m:.1f} m, path ratio "
            + ("unknown" if ratio is None else f"{ratio:.3f}"),
        ),
        ("turning", f"{figures.turning_rad:.0f} rad"),
        ("robot time", f"{clock(figures.duration_s)}{_rate(figures)}"),
        *_times(figures),
        ("energy", f"{figures.energy_wh:.2f} Wh"),
        ("dirt", _dirt(figures)),
        ("hits", f"{figures.hits}"),
        ("calibration", figures.calibration),
        ("wheels alone", _off(figures.wheels_error, figures.calibrated_wheels_error)),
        ("wheels, gyro", _off(figures.odometry_error, figures.calibrated_error)),
        ("planning", f"{figures.planning_s:.2f} s in {_count(figures.plans, 'plan')}"),
        (
            "wall time",
            f"{figures.wall_s:.2f} s, {figures.times_real_time:.0f} times real time",
        ),
    ]
    lines += [("missed", _missed(each)) for each in figures.missed[:_SHOWN]]
    rest = figures.missed[_SHOWN:]
    if rest:
        area = sum(each.area_m2 for each in rest)
        lines.append(("missed", f"and {_count(len(rest), 'smaller patch', 'es')}: {area:.3f} m²"))
    is_told = place is StationPlace.TOLD
    if unreached.area:
        lines.append(("unreached", unreached.words + ("" if is_told else f"; {_ELSEWHERE}")))
    if place is StationPlace.ON_PAPER:
        lines.append(("station", f"put on floor that ends with the picture; {_ELSEWHERE}"))
    return lines


def table_of(
    figures: Figures, unreached: Unreached = NOTHING, place: StationPlace = StationPlace.TOLD
) -> Table:
    """Return a run's table, with the rows of :func:`lines_of`."""
    rows = lines_of(figures, unreached, place)
    return named_table(rows, {"outcome": "green" if figures.is_completed else "red"})


def percentile_table(spread: dict[str, dict[str, float]]) -> Table:
    """Return the table of many runs: a row for each figure, a column for each percentile."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column("", style="bold", no_wrap=True)
    for percent in PERCENTS:
        name = {0: "least", 50: "median", 100: "most"}.get(percent, f"{percent} %")
        table.add_column(name, justify="right", no_wrap=True)
    for figure, numbers in spread.items():
        label, form = ROWS[figure]
        scale = 100.0 if figure == "fraction" else 1.0
        table.add_row(label, *(f"{scale * numbers[f'p{each}']:{form}}" for each in PERCENTS))
    return table


def failure_lines(
    figures: dict[int, Figures], failures: dict[int, str], repeat: str
) -> list[tuple[str, str]]:
    """Return a row for each run that was not completed, and how to see it again.

    ``repeat`` is the command for one of them, without its seed.
    """
    bad = {seed: _outcome(each) for seed, each in figures.items() if not each.is_completed}
    bad.update(failures)
    lines = [
        (f"seed {seed}", f"{why}; again: {repeat} --seed {seed}")
        for seed, why in sorted(bad.items())[:_SHOWN]
    ]
    if len(bad) > _SHOWN:
        others = ", ".join(str(seed) for seed in sorted(bad)[_SHOWN:])
        lines.append(("and seeds", others))
    return lines


def _outcome(figures: Figures) -> str:
    where = "docked" if figures.docked else "not docked"
    outcome = f"{figures.outcome}, {where}"
    return f"{outcome}: {figures.message}" if figures.message else outcome


def _dirt(figures: Figures) -> str:
    picked_up = f"{figures.dirt_g:.1f} g picked up"
    if not figures.bins_emptied:
        return picked_up
    return f"{picked_up}, the full bin emptied {_count(figures.bins_emptied, 'time')}"


def _rate(figures: Figures) -> str:
    """Return a text about the speed of a clean, to follow its time."""
    if figures.rate is None or figures.times_least is None:
        return ""
    return f", {figures.rate:.2f} m² a minute, {figures.times_least:.2f} times the least time"


def _times(figures: Figures) -> list[tuple[str, str]]:
    """Return where a run's time went, if that was counted."""
    told = [f"{name} {clock(seconds)}" for name, seconds in figures.times.parts if seconds >= 0.5]
    return [("of it", ", ".join(told))] if told else []


def _off(before: float | None, after: float | None) -> str:
    if before is None or after is None:
        return "too short a way to tell how far they are off"
    return f"{1e3 * before:.1f} mm off per metre, {1e3 * after:.1f} mm as calibrated"


def _coverage(figures: Figures) -> str:
    if figures.coverable_m2 <= 0.0:
        return "the tool can reach nothing of what was asked for"
    return (
        f"{100.0 * figures.fraction:.2f} % of the floor that the tool can reach: "
        f"{figures.covered_m2:.2f} of {figures.coverable_m2:.2f} m²"
    )


def _missed(each: MissedShare) -> str:
    room = f" in {each.room}" if each.room else ""
    return f"{each.area_m2:.3f} m² at ({each.x:.2f}, {each.y:.2f}){room}: {each.reason}"


def _count(number: int, word: str, plural: str = "s") -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}{plural}"
