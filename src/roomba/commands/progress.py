"""Shows a run's progress on standard error: a bar on a terminal, plain lines in a pipe."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from typing import Final

from rich.console import Console

from roomba.shares import whole_percent
from roomba.ui.live_bar import live_bar

Show = Callable[[float, str], None]
"""Called with the share that is done, 0..1, and a text."""

_REDRAWN: Final = 0.1
"""s between two drawings of the bar."""
_FIRST_LINE, _SLOWER, _SELDOM = 1.0, 1.5, 30.0
"""s before the first plain line; the factor by which each further pause is longer; the longest
pause."""


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
                print(f"{title}: {whole_percent(share)} %, {words}", file=sys.stderr, flush=True)

        yield tell
        return
    with live_bar(console, ("percent", "words"), stays=False) as bar:
        task = bar.add_task(title, total=100, percent="", words="")

        def draw(share: float, words: str) -> None:
            nonlocal told
            if time.monotonic() - told >= _REDRAWN:
                told = time.monotonic()
                percent = whole_percent(share)
                bar.update(
                    task, completed=percent, percent=f"{percent} %", words=words, refresh=True
                )

        yield draw
