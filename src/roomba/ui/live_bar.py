"""The progress bar, with the same look for walks, cleans and commands."""

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

    The bar is drawn when a caller updates a task, and by no thread of its own: a view without news
    costs nothing. Texts are not read as markup, since a room's name may look like it. If it
    ``stays``, the bar is left on the terminal at the end.
    """
    progress = Progress(
        TextColumn("{task.description}", markup=False),
        # on a terminal with 16 colours, rich's own colours of a bar all look the same
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
