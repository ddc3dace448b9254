"""Telling what came of a run: tables for people, figures for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from rich.console import Console
from rich.table import Table

STANDARD_OUTPUT: Final = "-"
"""In place of a file's name."""
_WIDTH: Final = 120
"""Columns of a table that does not go to a terminal."""


def tell_tables(tables: Iterable[Table], figures: str | None, *, quiet: bool) -> None:
    """Print tables, unless ``quiet``; with ``figures`` on standard output to standard error."""
    if quiet:
        return
    console = Console(stderr=figures == STANDARD_OUTPUT)
    if not console.is_terminal:
        console.width = _WIDTH
    for table in tables:
        console.print(table, highlight=False)


def write_json(target: str, values: dict[str, Any]) -> None:
    """Write figures to a file, or standard output; raises OSError."""
    text = json.dumps(values, allow_nan=False)
    if target == STANDARD_OUTPUT:
        print(text, flush=True)
    else:
        Path(target).write_text(f"{text}\n", encoding="utf-8")
