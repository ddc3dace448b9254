"""Tables and percentiles, of made-up figures."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rich.console import Console

from roomba.commands.sim.percentiles import percentiles_of
from roomba.commands.sim.report import failure_lines, lines_of, percentile_table, table_of
from roomba.commands.trials.figures import Figures, MissedShare
from roomba.commands.trials.unreached import NOTHING, Unreached
from roomba.time_spent import TimeSpent
from roomba.world.home.home import StationPlace

FIGURES = Figures(
    outcome="COMPLETED",
    message="",
    docked=True,
    duration_s=1024.35,
    wall_s=0.5,
    planning_s=0.1,
    plans=1,
    distance_m=150.0,
    turning_rad=390.0,
    energy_wh=4.61,
    dirt_g=21.7,
    coverable_m2=20.0,
    covered_m2=19.9,
    tool_width_m=0.2,
    hits=1,
    missed=(MissedShare(0.1, 1.0, -2.0, "kitchen", "a door is shut"),),
)


def text_of(figures: Figures) -> dict[str, str]:
    return dict(lines_of(figures))


def test_what_follows_from_the_figures() -> None:
    assert FIGURES.fraction == pytest.approx(0.995)
    assert FIGURES.path_ratio == pytest.approx(1.5)
    assert FIGURES.times_real_time == pytest.approx(2048.7)
    assert FIGURES.is_completed
    assert not replace(FIGURES, docked=False).is_completed
    assert not replace(FIGURES, outcome="STUCK").is_completed


def test_where_the_program_put_the_station_it_is_told_what_to_do() -> None:
    left, way_out = Unreached(7.0), "--station X Y THETA puts it elsewhere"
    told = dict(lines_of(FIGURES, left))
    assert way_out not in told["unreached"]
    assert "station" not in told
    found = dict(lines_of(FIGURES, left, StationPlace.FOUND))
    assert found["unreached"].endswith(f"; {way_out}")
    assert "station" not in found
    on_paper = dict(lines_of(FIGURES, NOTHING, StationPlace.ON_PAPER))
    assert on_paper["station"] == f"put on floor that ends with the picture; {way_out}"


def test_a_home_without_floor_to_reach_has_no_path_ratio() -> None:
    nothing = replace(FIGURES, coverable_m2=0.0, covered_m2=0.0)
    assert (nothing.fraction, nothing.path_ratio) == (1.0, None)
    assert "path ratio unknown" in text_of(nothing)["way"]
    assert text_of(nothing)["coverage"] == "the tool can reach nothing of what was asked for"
    assert "path_ratio" not in percentiles_of([nothing])


def test_the_table_tells_all_of_it() -> None:
    lines = text_of(FIGURES)
    assert lines["outcome"] == "COMPLETED, docked"
    assert "99.50 %" in lines["coverage"]
    assert "19.90 of 20.00 m²" in lines["coverage"]
    assert lines["way"] == "150.0 m, path ratio 1.500"
    assert lines["robot time"] == "17 min 04 s"
    assert lines["planning"] == "0.10 s in 1 plan"
    assert lines["wall time"] == "0.50 s, 2049 times real time"
    assert lines["missed"] == "0.100 m² at (1.00, -2.00) in kitchen: a door is shut"
    console = Console(width=120, record=True, force_terminal=False)
    with console.capture() as capture:
        console.print(table_of(FIGURES))
    assert "1.500" in capture.get()
    assert "\x1b" not in capture.get()


def test_the_time_is_told_beside_the_least_and_where_it_went() -> None:
    times = TimeSpent(least=331.7, straight=400.0, slowed=100.0, turning=300.0, charging=224.35)
    told = text_of(replace(FIGURES, times=times))
    assert told["robot time"] == "17 min 04 s, 1.17 m² a minute, 2.41 times the least time"
    assert told["of it"] == (
        "sweeping at full speed 5 min 32 s, ways, and floor passed twice 1 min 08 s, slower for "
        "corners 1 min 40 s, turning on the spot 5 min 00 s, charging 3 min 44 s"
    )


def test_a_clean_that_failed_says_why() -> None:
    stuck = replace(FIGURES, outcome="STUCK", docked=False, message="held by a chair")
    assert text_of(stuck)["outcome"] == "STUCK, not docked: held by a chair"


def test_many_missed_patches_are_summed_up() -> None:
    many = replace(FIGURES, missed=FIGURES.missed * 20)
    assert lines_of(many)[-1] == ("missed", "and 12 smaller patches: 1.200 m²")


def test_percentiles_of_many_runs() -> None:
    runs = [replace(FIGURES, covered_m2=10.0 + number, hits=number) for number in range(11)]
    spread = percentiles_of(runs)
    assert spread["hits"] == {"p0": 0.0, "p5": 0.5, "p50": 5.0, "p95": 9.5, "p100": 10.0}
    assert spread["fraction"]["p50"] == pytest.approx(0.75)
    console = Console(width=120)
    with console.capture() as capture:
        console.print(percentile_table(spread))
    assert "75.00" in capture.get()


def test_a_failure_names_its_seed_and_the_command_that_repeats_it() -> None:
    figures = {1: FIGURES, 2: replace(FIGURES, outcome="LOST", message="where is it")}
    lines = failure_lines(figures, {7: "no floor"}, "./roomba sim --home random")
    assert lines == [
        ("seed 2", "LOST, docked: where is it; again: ./roomba sim --home random --seed 2"),
        ("seed 7", "no floor; again: ./roomba sim --home random --seed 7"),
    ]
    many = failure_lines({}, dict.fromkeys(range(10), "no floor"), "x")
    assert many[-1] == ("and seeds", "8, 9")
