"""The result on the terminal and as Markdown."""

from __future__ import annotations

import pytest
from rich.console import Console

from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.table import markdown, number, rich_table

ROWS = [
    Record(
        "sim",
        "apartment",
        "steps",
        612_345.0,
        "steps/s",
        Better.HIGHER,
        600_000.0,
        (PeerFigure("mujoco", "4.0", 7654.0), PeerFigure("range-libc", error="not installed: [x]")),
    ),
    Record("ros", "graph", "speed", None, "x", Better.HIGHER, 50.0, error="a node ended | badly"),
]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((0.04567, "0.0457"), (7.0, "7"), (324.492, "324.5"), (3180.585, "3,181")),
        *((612_345.0, "612,300"), (None, "–")),
    ],
)
def test_numbers_have_the_digits_that_count(value: float | None, text: str) -> None:
    assert number(value) == text


def test_markdown_has_a_table_for_each_topic() -> None:
    lines = markdown(ROWS, ["On a machine."]).splitlines()
    assert lines[0] == "On a machine."
    assert "### sim" in lines
    assert "### ros" in lines
    [row] = [line for line in lines if line.startswith("| apartment")]
    assert row == (
        "| apartment | steps | 612,300 steps/s | ≥ 600,000 | yes | mujoco 4.0: 7,654 (**80x**); "
        "range-libc: not measured (not installed: [x]) |"
    )


def test_markdown_tells_what_could_not_be_measured_in_one_cell() -> None:
    [row] = [line for line in markdown(ROWS, []).splitlines() if line.startswith("| graph")]
    assert row == "| graph | speed | – (a node ended \\| badly) | ≥ 50 | no |  |"


def test_the_terminal_shows_ours_and_below_it_each_peer() -> None:
    console = Console(width=200, record=True, file=open("/dev/null", "w"))  # noqa: SIM115
    console.print(rich_table(ROWS))
    lines = console.export_text().splitlines()
    order = [
        next(number for number, line in enumerate(lines) if text in line)
        for text in ("612,300", "mujoco 4.0", "range-libc: not installed: [x]", "a node ended")
    ]
    assert order == sorted(order)
    assert "80x" in lines[order[1]]
