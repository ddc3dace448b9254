"""``./roomba fuzz [TARGET ...] [--minutes N]``: readers of bytes, led by which branches they take.

Each target runs in a process of its own for its share of the time. Inputs that led to new branches
stay in ``.cache/fuzz``, and the next run begins with them; what was found lies beside them, as a
file. The exit status is 1 when something was found.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

from fuzz.targets import NAMES

KEPT: Final = Path(__file__).resolve().parents[2] / ".cache" / "fuzz"
_LONGER: Final = 120.0
"""s of wall time that a target may take longer than it was given, to begin and to end."""
_FIGURE: Final = re.compile(r"stat::(number_of_executed_units|peak_rss_mb):\s+(\d+)")
_BRANCHES: Final = re.compile(r"\bcov: (\d+)")
_SAID: Final = 40
"""Lines of what was found that are shown."""


def main(arguments: list[str] | None = None) -> int:
    """Fuzz the targets one after the other."""
    parser = argparse.ArgumentParser(prog="./roomba fuzz", description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=", ".join(NAMES))
    parser.add_argument("--minutes", type=float, default=10.0, help="of all together")
    given = parser.parse_args(arguments)
    names = given.targets or NAMES
    unknown = sorted(set(names) - set(NAMES))
    if unknown:
        parser.error(f"expected targets of {', '.join(NAMES)}, got {', '.join(unknown)}")
    print(f"{'target':20} {'inputs':>9} {'branches':>9} {'MB':>6}  found", flush=True)
    found = [name for name in names if not _fuzz(name, 60.0 * given.minutes / len(names))]
    print(f"{len(found)} of {len(names)} targets failed", *found)
    return 1 if found else 0


def _fuzz(name: str, seconds: float) -> bool:
    """Fuzz a target for so many s and tell of it; return whether nothing was found."""
    command = [sys.executable, "-m", "fuzz.one", name, str(KEPT / name), f"{seconds:.0f}"]
    began = time.time()
    try:
        done = subprocess.run(
            command,
            check=False,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=seconds + _LONGER,
        )
        output, is_well = done.stdout.decode("utf-8", errors="replace"), done.returncode == 0
    except subprocess.TimeoutExpired as error:
        output, is_well = f"not done within {error.timeout:g} s", False
    figures = dict(_FIGURE.findall(output))
    branches = max((int(count) for count in _BRANCHES.findall(output)), default=0)
    files = [path.name for path in KEPT.glob(f"found-{name}-*") if path.stat().st_mtime >= began]
    print(
        f"{name:20} {figures.get('number_of_executed_units', '?'):>9} {branches:>9} "
        f"{figures.get('peak_rss_mb', '?'):>6}  {' '.join(files) or ('-' if is_well else '?')}",
        flush=True,
    )
    if not is_well:
        print("\n".join(output.splitlines()[-_SAID:]))
    return is_well


if __name__ == "__main__":
    sys.exit(main())
