"""Tells which function is being compiled, line by line: the first set-up compiles for a minute.

``python3 -m roomba.commands.compiling`` prints how many functions are not compiled yet.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

from numba.core import event
from numba.extending import is_jitted

from roomba.compiled_sources import PACKAGE, files_with_compiled_functions

_SELDOM: Final = 10
"""Factor by which garbage collection is made rarer: compiling makes millions of objects that stay,
and collecting them took a tenth of its time."""


@contextlib.contextmanager
def compiled_functions_told() -> Iterator[None]:
    """Print the number and the name of each function that numba begins to compile here.

    Functions that are loaded from the cache on disk are not printed.
    """
    with _garbage_looked_for_seldom(), event.install_listener("numba:compile", _Teller(_print)):
        yield


@contextlib.contextmanager
def compiling_counted(tell: Callable[[str], None]) -> Iterator[None]:
    """Tell, in words for people, how many functions numba has begun to compile here.

    In an installed library a first exploration compiles what only mapping needs.
    """

    def count(number: int, _: str) -> None:
        tell(f"compiling, this once: function {number}")

    with event.install_listener("numba:compile", _Teller(count)):
        yield


@contextlib.contextmanager
def _garbage_looked_for_seldom() -> Iterator[None]:
    """Exclude all present objects from garbage collection, and collect new ones more seldom."""
    usual = gc.get_threshold()
    gc.freeze()
    gc.set_threshold(_SELDOM * usual[0], *usual[1:])
    try:
        yield
    finally:
        gc.set_threshold(*usual)
        gc.unfreeze()


class _Teller(event.Listener):
    """Counts the functions that begin to be compiled, and tells number and name of each."""

    def __init__(self, tell: Callable[[int, str], None]) -> None:
        self._count = 0
        self._tell = tell

    def on_start(self, event: Any) -> None:
        """Tell the function that the event is about."""
        function = event.data["dispatcher"].py_func
        self._count += 1
        self._tell(self._count, f"{function.__module__}.{function.__qualname__}")

    def on_end(self, event: Any) -> None:
        """Say nothing: the next function tells that this one is done."""


def _print(number: int, name: str) -> None:
    print(f"{number}: {name}", flush=True)


def left_to_compile() -> list[str]:
    """Return this package's functions whose present sources have no compiled code cached."""
    modules = [
        ".".join(("roomba", *path.relative_to(PACKAGE).with_suffix("").parts))
        for path in files_with_compiled_functions(PACKAGE)
    ]
    return [
        f"{module}.{name}"
        for module in modules
        for name, value in vars(importlib.import_module(module)).items()
        if is_jitted(value)
        and value.__module__ == module
        and not is_kept(value)
        # A function that is inlined into its callers is compiled with them.
        and value.targetoptions.get("inline") != "always"
    ]


def is_kept(dispatcher: Any) -> bool:
    """Return whether compiled code is in the cache; True also for functions that use no cache."""
    folder = dispatcher.stats.cache_path
    return folder is None or any(Path(folder).glob(f"*.{dispatcher.__qualname__}-*.nbi"))


if __name__ == "__main__":
    print(len(left_to_compile()))
