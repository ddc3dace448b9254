"""The bar that shows how far something is: one look for walks, cleans and commands."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn


@contextlib.contextmanager
def live_bar(
    console: Console, fields: Sequence[str], *, width: int | None = 40, stays: bool = True
) -> Iterator[Progress]:
    """Give rich's display of a task: its name, a bar of ``width`` columns, and its ``fields``.

    It is drawn when a caller updates a task, and not by a thread of its own: a view that shows
    nothing new costs nothing. What it holds is no markup, as a room's name may look like some. One
    that ``stays`` is left on the terminal at the end.
    """
    progress = Progress(
        TextColumn("{task.description}", markup=False),
        # rich's own colours look all the same on a terminal with 16 of them
        BarColumn(
            bar_width=width,
            style="bright_black",
            complete_style="cyan",
            finished_style="green",
        ),
        *(TextColumn(f"{{task.fields[{field}]}}", markup=False) for field in fields),
        console=console,
        auto_refresh=False,
        transient=not stays,
    )
    with progress:
        yield progress
