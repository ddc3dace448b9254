"""Where things lie: in a checkout, or where the library is installed without one."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final


@dataclass(frozen=True)
class Places:
    """The program whose commands are timed, the folder of pictures, the Python of the peers.

    ``peers`` is None if the user must name one. ``root`` is the folder that messages leave out of
    paths.
    """

    root: Path
    program: Path
    results: Path
    peers: Path | None

    @classmethod
    def of(cls, root: Path) -> Places:
        """Return the places of a checkout at ``root``, or else of an installed library."""
        program = root / "roomba"
        if not program.is_file():
            installed = Path(sys.executable).with_name("roomba")
            return cls(root, installed, Path("bench.results"), None)
        peers = root / ".venv-bench" / "bin" / "python3"
        results = root / "benchmarks" / "results"
        return cls(root, program, results, peers if peers.exists() else None)


HERE: Final = Places.of(Path(__file__).parents[2])
"""Those of this package."""
