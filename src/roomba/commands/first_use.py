"""Compiles what a clean needs before the first one: in two processes at once, for two cores.

``python3 -m roomba.commands.first_use ticks|bursts`` is a step of a checkout's set-up. A library
that pip installed has no set-up: there the first command that cleans calls
:func:`require_compiled`. All else is compiled when it is first called.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from typing import Final

from rich.console import Console

from roomba.commands.compiling import is_kept
from roomba.commands.process_end import quiet_end, quiet_loading

_CLEAN, _PLAN = "roomba.commands.trials.warm", "roomba.commands.warm_up"
_TITLE: Final = "Compiling what a clean needs, once"
_LONGEST_END: Final = 10.0
"""s that a process may take to end when it is told to."""

Tell = Callable[[int, str], None]
"""Called with the number of functions that were begun, and the name of the newest."""


def require_compiled(*, is_quiet: bool) -> None:
    """Compile what a headless clean needs, unless it is in the cache; show the progress.

    A function that fails to compile is compiled again at its first call, and raises its error
    there.
    """
    with quiet_loading():
        from roomba.headless.burst_kernels import run
        from roomba.planning.coverage.tour.tour import iterated_local_search

    # The last, and the largest, functions of both halves.
    if is_kept(run) and is_kept(iterated_local_search):
        return
    with _shown(is_quiet) as tell:
        compile_for_a_clean("bursts", tell)


def compile_for_a_clean(half: str, tell: Tell) -> bool:
    """Compile by ticks or bursts, and beside it a plan; return whether both did well."""
    read, write = os.pipe()
    with contextlib.ExitStack() as stack:
        lines = stack.enter_context(open(read, encoding="utf-8"))
        try:
            halves = [
                stack.enter_context(_started(words, write)) for words in ((_CLEAN, half), (_PLAN,))
            ]
        finally:
            os.close(write)
        for count, line in enumerate(lines, 1):
            tell(count, line.strip().rpartition(": ")[2])
        ends = [process.wait() for process in halves]
    return not any(ends)


@contextlib.contextmanager
def _started(words: tuple[str, ...], told_to: int) -> Iterator[subprocess.Popen[bytes]]:
    """Yield a process of this Python that runs a module; it ends with the block.

    Ctrl-C reaches only this process, which ends the other one.
    """
    # Unbuffered output writes a line and its end separately: lines of both halves would mix.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    command = [sys.executable, "-m", *words]
    process = subprocess.Popen(command, stdout=told_to, env=environment, start_new_session=True)
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(_LONGEST_END)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextlib.contextmanager
def _shown(is_quiet: bool) -> Iterator[Tell]:
    """Yield a function that shows the count on a terminal; a pipe gets only begin and end."""
    console, began = Console(stderr=True, quiet=is_quiet), time.monotonic()
    console.print(f"{_TITLE}; it takes about a minute on two cores.", soft_wrap=True)
    with console.status("") as status:
        yield lambda count, name: status.update(
            f"{time.monotonic() - began:.0f} s, {count} functions, {name.rpartition('.')[2]}"
        )
    console.print(f"Compiled in {time.monotonic() - began:.0f} s.")


def main() -> int:
    """Print the number and the name of each function that is compiled; returns the exit status."""
    parser = argparse.ArgumentParser(description="Compile what a first clean needs.")
    parser.add_argument("half", choices=("ticks", "bursts"))
    is_fine = compile_for_a_clean(
        parser.parse_args().half, lambda count, name: print(f"{count}: {name}", flush=True)
    )
    return 0 if is_fine else 1


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
