"""The results of one kind of fault, and the table of all results."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

from fixtures.processes.forked import run_forked


@dataclass
class Row:
    """One kind of fault: how often it came, the worst figures by name, and broken promises."""

    what: str
    times: int = 0
    worst: dict[str, float] = field(default_factory=dict)
    broken: list[str] = field(default_factory=list)

    def add(self, other: Row) -> None:
        """Add the results of another fault of this kind."""
        self.times += other.times
        for name, value in other.worst.items():
            self.measured(name, value)
        self.broken += other.broken

    def measured(self, name: str, value: float) -> None:
        """Note a figure, of which a larger one is worse."""
        self.worst[name] = max(value, self.worst.get(name, value))

    def expect(self, name: str, value: float, most: float) -> None:
        """Note a figure, and a broken promise if it is more than ``most``."""
        self.measured(name, value)
        if not value <= most:
            self.broken.append(f"{name}: {value:.2f}, promised {most:g}")

    def expect_within(self, name: str, seconds: float, holds: Callable[[], object]) -> bool:
        """Wait until something holds; note the time, s of wall time, and return whether it came."""
        took = until(holds, 10.0 * seconds)
        self.expect(name, 10.0 * seconds if took is None else took, seconds)
        return took is not None


def tell(what: str) -> None:
    """Print what is done now: some parts take long."""
    print(f"{time.strftime('%H:%M:%S')} {what} …", file=sys.stderr, flush=True)


def until(holds: Callable[[], object], seconds: float) -> float | None:
    """Return after how many s of wall time something holds; None if that is not in time."""
    begin = time.monotonic()
    while not holds():
        if time.monotonic() - begin > seconds:
            return None
        time.sleep(0.01)
    return time.monotonic() - begin


def in_child(folder: Path, work: Callable[[], Iterable[Row]], seconds: float) -> list[Row]:
    """Do work in a child process, which may be a node, within s of wall time; return its rows."""
    told = folder / "rows.json"

    def child() -> None:
        told.write_text(json.dumps([asdict(row) for row in work()]), encoding="utf-8")

    run_forked(child, deadline=seconds)
    return [Row(**row) for row in json.loads(told.read_text(encoding="utf-8"))]


def table(rows: Iterable[Row]) -> str:
    """Return all results, a line for each kind of fault."""
    lines = [f"{'fault':44} times  the worst, in s of wall time unless it says otherwise"]
    for row in rows:
        figures = ", ".join(f"{name} {value:.2f}" for name, value in row.worst.items())
        lines.append(f"{row.what:44} {row.times:5}  {figures or '-'}")
        lines += [f"    broken: {broken}" for broken in row.broken]
    return "\n".join(lines)
