"""What came of the faults of one kind, and the table of all."""

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
    """One kind of fault: how often, what was measured (the worst by name), what was not kept."""

    what: str
    times: int = 0
    worst: dict[str, float] = field(default_factory=dict)
    broken: list[str] = field(default_factory=list)

    def add(self, other: Row) -> None:
        """Take what came of another fault of this kind."""
        self.times += other.times
        for name, value in other.worst.items():
            self.measured(name, value)
        self.broken += other.broken

    def measured(self, name: str, value: float) -> None:
        """Note a figure, which is the worse the larger it is."""
        self.worst[name] = max(value, self.worst.get(name, value))

    def expect(self, name: str, value: float, most: float) -> None:
        """Note a figure, and that a promise was broken if it is more than promised."""
        self.measured(name, value)
        if not value <= most:
            self.broken.append(f"{name}: {value:.2f}, promised {most:g}")

    def expect_within(self, name: str, seconds: float, holds: Callable[[], object]) -> bool:
        """Wait until something is so; note after how many s of wall time, and return whether."""
        took = until(holds, 10.0 * seconds)
        self.expect(name, 10.0 * seconds if took is None else took, seconds)
        return took is not None


def tell(what: str) -> None:
    """Say what is done now: some parts take long."""
    print(f"{time.strftime('%H:%M:%S')} {what} …", file=sys.stderr, flush=True)


def until(holds: Callable[[], object], seconds: float) -> float | None:
    """Return after how many s of wall time something was so; None if it was not in time."""
    begin = time.monotonic()
    while not holds():
        if time.monotonic() - begin > seconds:
            return None
        time.sleep(0.01)
    return time.monotonic() - begin


def in_child(folder: Path, work: Callable[[], Iterable[Row]], seconds: float) -> list[Row]:
    """Do work in a process that may be a node, in so many s of wall time; return its rows."""
    told = folder / "rows.json"

    def child() -> None:
        told.write_text(json.dumps([asdict(row) for row in work()]), encoding="utf-8")

    run_forked(child, deadline=seconds)
    return [Row(**row) for row in json.loads(told.read_text(encoding="utf-8"))]


def table(rows: Iterable[Row]) -> str:
    """Return what came of it all, a line for each kind."""
    lines = [f"{'fault':44} times  the worst, in s of wall time unless it says otherwise"]
    for row in rows:
        figures = ", ".join(f"{name} {value:.2f}" for name, value in row.worst.items())
        lines.append(f"{row.what:44} {row.times:5}  {figures or '-'}")
        lines += [f"    broken: {broken}" for broken in row.broken]
    return "\n".join(lines)
