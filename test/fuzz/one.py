"""Fuzzes one target in this process until its time is over, or until it found something."""

from __future__ import annotations

import contextlib
import importlib
import inspect
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import FunctionType
from typing import Any, Final

from fuzz.targets import target_of

LONGEST: Final = 20
"""s that one input may take."""
MOST_MEMORY: Final = 3000
"""MB of the process."""
_LARGEST: Final = 200_000
"""Bytes of an input."""
_LOOKED_INTO: Final = (
    *(
        "roomba.configuration",
        "roomba.files",
        "roomba.history",
        "roomba.recordings",
        "roomba.storage",
        "roomba_ros",
    ),
    *("rosbags", "zipfile", "rosgraph.network", "numpy.lib._format_impl", "numpy.lib.format"),
)
"""Modules whose branches lead the search; not those that are compiled."""


def main(name: str, corpus: Path, seconds: float) -> None:
    """Fuzz it; the process ends within this call, with status 0 if nothing was found."""
    atheris: Any = importlib.import_module("atheris")
    # Where files are written fast: some hundred a second.
    with tempfile.TemporaryDirectory(dir="/dev/shm" if Path("/dev/shm").is_dir() else None) as made:
        target = target_of(name, Path(made))
        corpus.mkdir(parents=True, exist_ok=True)
        (corpus / "whole").write_bytes(target.whole())
        target.read(target.whole())
        for function in _functions():
            atheris.instrument_func(function)

        def try_one(content: bytes) -> None:
            with contextlib.suppress(*target.errors):
                target.read(content)

        arguments = {
            "max_total_time": round(seconds),
            "max_len": _LARGEST,
            "timeout": LONGEST,
            "rss_limit_mb": MOST_MEMORY,
            "print_final_stats": 1,
            "artifact_prefix": f"{corpus.parent}/found-{name}-",
        }
        flags = [f"-{flag}={value}" for flag, value in arguments.items()]
        atheris.Setup([sys.argv[0], *flags, str(corpus)], try_one)
        atheris.Fuzz()


def _functions() -> Iterator[FunctionType]:
    """Give the functions and methods of the modules that are looked into."""
    for name, module in list(sys.modules.items()):
        if not name.startswith(_LOOKED_INTO):
            continue
        for value in list(vars(module).values()):
            if getattr(value, "__module__", None) != name:
                continue
            if isinstance(value, FunctionType):
                yield value
            elif inspect.isclass(value):
                yield from (each for each in vars(value).values() if isinstance(each, FunctionType))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), float(sys.argv[3]))
