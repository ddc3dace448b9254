"""Prints a run's result: tables for people, figures for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

from rich.console import Console
from rich.table import Table
from rich.text import Text

from roomba.commands.options import STANDARD_OUTPUT
from roomba.files.atomic import write_output
from roomba.geometry import Pose

_WIDTH: Final = 120
"""Columns of a table, if the output is no terminal."""


def named_table(rows: Iterable[tuple[str, str]], styles: Mapping[str, str] | None = None) -> Table:
    """Return a table of names and texts; ``styles`` has rich's styles for texts by their names."""
    table = Table.grid(padding=(0, 2))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, text in rows:
        table.add_row(name, Text(text, (styles or {}).get(name, "")))
    return table


def clock(seconds: float) -> str:
    """Return a time as text."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02d} min"
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"


def tell_tables(tables: Iterable[Table], figures: str | None, *, quiet: bool) -> None:
    """Print tables unless ``quiet``, on standard error if ``figures`` take standard output."""
    if quiet:
        return
    console = Console(stderr=figures == STANDARD_OUTPUT)
    console.width = told_width(console)
    for table in tables:
        console.print(table, highlight=False)


def told_width(console: Console) -> int:
    """Return how many columns a table may take: those of the terminal, if it goes to one."""
    return console.width if console.is_terminal else _WIDTH


def pose_as_json(pose: Pose) -> dict[str, float]:
    """Return a pose as figures: x and y, m, and theta, rad."""
    return {"x": round(pose.x, 4), "y": round(pose.y, 4), "theta": round(pose.theta, 6)}


def write_json(target: str, values: dict[str, Any]) -> None:
    """Write figures to a file, all or nothing, or to standard output; raises OSError."""
    text = json.dumps(values, allow_nan=False)
    if target == STANDARD_OUTPUT:
        print(text, flush=True)
    else:
        write_output(Path(target), f"{text}\n".encode())
