"""Progress of a run: a bar on a terminal, plain lines in a pipe, both on standard error."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from typing import Final

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

Show = Callable[[float, str], None]
"""Takes the share that is done, 0..1, and some words."""

_REDRAWN: Final = 0.1
"""s between two pictures of the bar."""
_FIRST_LINE, _SLOWER, _SELDOM = 1.0, 1.5, 30.0
"""s before the first plain line; so many times longer before each next one, at most so long."""


@contextlib.contextmanager
def progress(title: str, is_quiet: bool) -> Iterator[Show]:
    """Give a function that shows the share of the work that is done."""
    console = Console(stderr=True)
    told, pause = time.monotonic(), _FIRST_LINE
    if is_quiet:
        yield lambda share, words: None
        return
    if not console.is_interactive:

        def tell(share: float, words: str) -> None:
            nonlocal told, pause
            if time.monotonic() - told >= pause:
                told, pause = time.monotonic(), min(_SLOWER * pause, _SELDOM)
                print(f"{title}: {100.0 * share:.0f} %, {words}", file=sys.stderr, flush=True)

        yield tell
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %  {task.fields[words]}"),
    )
    # without a refresh thread, which would take its time from the work
    with Progress(*columns, console=console, auto_refresh=False, transient=True) as bar:
        task = bar.add_task(title, total=1.0, words="")

        def draw(share: float, words: str) -> None:
            nonlocal told
            if time.monotonic() - told >= _REDRAWN:
                told = time.monotonic()
                bar.update(task, completed=share, words=words, refresh=True)

        yield draw
