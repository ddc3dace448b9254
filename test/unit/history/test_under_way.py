"""A run under way grows from look to look, and tells what it was."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest
from unit.history.seen import HOME, REPORT, SOURCE, layer, view

from roomba.history.under_way import RunUnderWay, cells_of
from roomba.history.unfinished import RunSoFar
from roomba.vocabulary import Hindrance


def seen_at(times: Iterable[float]) -> RunUnderWay:
    """Look at a robot that cleans."""
    first, *later = times
    run = RunUnderWay(view(first, "cleaning"), SOURCE)
    for time in (first, *later):
        run.take(view(time, "cleaning"))
    return run


def test_a_run_has_two_rows_a_second_however_often_it_is_looked_at() -> None:
    run = seen_at(100.0 + tenth / 10.0 for tenth in range(101))
    assert [row[0] for row in run.so_far().rows] == pytest.approx([n / 2.0 for n in range(21)])
    figures, recording = run.figures(REPORT), run.recording(HOME, layer)
    assert figures.turning == pytest.approx(1.0)
    assert recording.duration == pytest.approx(10.0)
    assert set(recording.layers) == {"map", "coverage"}


def test_a_run_goes_on_with_what_was_seen_before() -> None:
    before = seen_at([0.0, 1.0]).so_far()
    run = RunUnderWay(view(5.0, "cleaning"), SOURCE)
    run.resume(RunSoFar(SOURCE, 0.0, 7.0, before.rows, before.words))
    run.take(view(5.0, "cleaning"))
    assert [row[0] for row in run.so_far().rows] == [0.0, 1.0, 5.0]
    assert run.figures(REPORT).began == 7.0
    ended = run.interrupted()
    assert ended is not None
    assert ended[1].duration == 5.0
    assert seen_at([0.0]).interrupted() is None


def test_what_hinders_a_robot_is_kept_as_its_word() -> None:
    shut = view(0.0, "cleaning")
    shut = replace(shut, vacuum=replace(shut.vacuum, hindrance=Hindrance.NO_WAY))
    run = RunUnderWay(shut, SOURCE)
    run.take(shut)
    (word,) = run.recording(HOME, layer).words
    assert word.hindrance == "no way"


def test_the_cells_that_are_kept_are_copies_of_what_there_is() -> None:
    cells = cells_of(layer)
    assert set(cells) == {"map", "coverage"}
    assert cells["map"].cells.shape == (4, 5)


def test_a_robot_that_stands_has_few_rows_and_its_time_line_is_right() -> None:
    run = RunUnderWay(view(0.0, "cleaning"), SOURCE)
    # It stands from 2 s to 27.4 s, and is looked at ten times a second.
    for tenth in range(300):
        time = tenth / 10.0
        way = min(time, 2.0) + max(time - 27.4, 0.0)
        run.take(replace(view(time, "cleaning"), pose=(way / 5.0, 0.0, 0.0)))
    recording = run.recording(HOME, layer)
    times = [0.0, 0.5, 1.0, 1.5, 2.0, 12.0, 22.0, 27.4, 27.5, 28.0, 28.5, 29.0, 29.5]
    assert recording.column("time").tolist() == pytest.approx(times)
    assert recording.column("x")[4:8] == pytest.approx([0.4] * 4)


def test_a_run_lasts_until_its_last_look_though_the_robot_stands() -> None:
    run = RunUnderWay(view(0.0, "cleaning"), SOURCE)
    for second in range(10):
        run.take(replace(view(0.0, "cleaning"), time=float(second)))
    assert len(run.so_far().rows) == 1
    assert run.recording(HOME, layer).column("time").tolist() == [0.0, 9.0]


def test_what_a_robot_says_while_it_stands_is_kept_at_once() -> None:
    run = RunUnderWay(view(0.0, "cleaning"), SOURCE)
    for second, phase in enumerate(["cleaning", "paused", "paused", "paused", "cleaning"]):
        run.take(replace(view(0.0, phase), time=float(second)))
    assert [row[0] for row in run.so_far().rows] == [0.0, 1.0, 3.0, 4.0]
    assert [word.time for word in run.so_far().words] == [0.0, 1.0, 4.0]
