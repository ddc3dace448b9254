"""Runs under way, kept line by line: a program that is killed loses half a second of its run.

Each program has a file of its own beside the history, which it holds locked for as long as it
lives. A file that no program holds is of a run that was interrupted.
"""

from __future__ import annotations

import base64
import contextlib
import fcntl
import math
import os
import secrets
import time
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from roomba.arrays import Floats32
from roomba.client.protocol import ErrandOutcome
from roomba.files.atomic import make_private
from roomba.files.damaged import is_no_file, set_aside
from roomba.files.journal import append_line, read_lines
from roomba.files.lock import try_to_lock
from roomba.history.run import (
    CELL_LAYERS,
    TRACE,
    CellLayer,
    RunFigures,
    RunRecording,
    RunSource,
    Word,
    kind_of,
    told,
    turning_of,
)
from roomba.history.run_file import figures_from, plain_of

INTERRUPTED: Final = ErrandOutcome.INTERRUPTED.value
"""The outcome of a run whose program ended in the middle of it."""
WHY: Final = "the program that kept this run ended in the middle of it"
_LEFT: Final = "it is left as it is, and the next start tries again"
_EVERY: Final = 0.5
"""s of wall time between two writes of what was seen."""
_LAYERS_EVERY: Final = 10.0
"""The same of the cells of the floor, which are larger."""
_GAP: Final = 60.0
"""s of the robot's clock for which a run may have gone on unseen."""
_MOST_CELLS: Final = 100_000_000

Row = tuple[float, ...]
Layers = Callable[[], Mapping[str, CellLayer]]


@dataclass(slots=True)
class RunSoFar:
    """What was seen of a run: it began at ``clock``, s of the robot's, and ``wall``, s since 1970.

    ``rows`` are those of a trace. ``ended`` is what it achieved, if it came to an end that the
    history refused.
    """

    source: RunSource
    clock: float
    wall: float
    rows: list[Row] = field(default_factory=list)
    words: list[Word] = field(default_factory=list)
    home: Mapping[str, Any] = field(default_factory=dict)
    layers: dict[str, CellLayer] = field(default_factory=dict)
    ended: RunFigures | None = None

    def may_go_on(self, source: RunSource, now: float) -> bool:
        """Whether a robot that is under way at a time of its clock, s, may be on this run."""
        is_same = (source.program, source.home) == (self.source.program, self.source.home)
        return self.ended is None and is_same and 0.0 <= now - self.clock - self.rows[-1][0] <= _GAP

    @property
    def trace(self) -> Floats32:
        """The rows so far, float32 [n, len(TRACE)], as :class:`RunRecording` has them."""
        return np.array(self.rows, np.float32).reshape(-1, len(TRACE))

    def closed(self) -> tuple[RunFigures, RunRecording]:
        """Return the run as it ended, or else as interrupted."""
        figures = self._interrupted() if self.ended is None else self.ended
        return figures, RunRecording(self.trace, tuple(self.words), self.home, self.layers)

    def _interrupted(self) -> RunFigures:
        last = dict(zip(TRACE, self.rows[-1], strict=True))
        trace = self.trace
        steps = np.diff(trace[:, 1:3].astype(np.float64), axis=0)
        return RunFigures(
            self.source,
            kind_of(self.words),
            self.wall,
            INTERRUPTED,
            WHY,
            last["time"],
            last["covered"],
            last["wanted"],
            float(np.hypot(steps[:, 0], steps[:, 1]).sum()),
            turning_of(trace),
            told(last["dirt"]),
            math.nan,
        )


@dataclass(slots=True)
class _Written:
    """What is written: how many rows and words, the newest home and floor; when, monotonic s."""

    rows: int = 0
    words: int = 0
    home: Mapping[str, Any] | None = None
    layers: Mapping[str, CellLayer] = field(default_factory=dict)
    at: float = -math.inf
    layers_at: float = -math.inf


class UnfinishedFile:
    """The file of the run under way; it is there from its first row until :meth:`remove`."""

    def __init__(self, folder: Path) -> None:
        """Touch nothing yet."""
        self._folder = folder
        self._path: Path | None = None
        self._held: int | None = None
        self._written = _Written()

    def keep(self, run: RunSoFar, home: Mapping[str, Any], layers: Layers) -> None:
        """Write what is new, unless the last write was a moment ago; it is on the disk then.

        Raises OSError, ValueError for what is not finite, and TypeError for what is not plain.
        """
        now, written = time.monotonic(), self._written
        if now - written.at < _EVERY or len(run.rows) == written.rows:
            return
        try:
            self._write(run, home, layers, now)
        finally:
            # On a slow disk what was seen during this write comes with the next one.
            written.at = time.monotonic()

    def _write(self, run: RunSoFar, home: Mapping[str, Any], layers: Layers, now: float) -> None:
        written = self._written
        path = self._path or self._begin(run)
        seen: dict[str, Any] = {"rows": run.rows[written.rows :]}
        seen["words"] = [asdict(word) for word in run.words[written.words :]]
        if home != written.home:
            seen["home"] = home
        floor = written.layers
        if now - written.layers_at >= _LAYERS_EVERY:
            written.layers_at = now
            floor = layers()
            seen["layers"] = {
                name: _packed(layer)
                for name, layer in floor.items()
                if not layer.is_as(written.layers.get(name))
            }
        append_line(path, seen)
        written.layers = floor
        written.rows, written.words, written.home = len(run.rows), len(run.words), home

    def remove(self) -> None:
        """Remove the file: the run is kept, or was none.

        Raises OSError when the disk refuses; the next run gets a file of its own all the same.
        """
        try:
            if self._path is not None:
                self._path.unlink(missing_ok=True)
        finally:
            self._let_go()

    def leave(self, figures: RunFigures) -> None:
        """Leave the file of a run that ended, if there is one, to the next program.

        Raises as :meth:`keep`; the next run gets a file of its own all the same.
        """
        try:
            if self._path is not None:
                append_line(self._path, {"rows": [], "words": [], "ended": plain_of(figures)})
        finally:
            self._let_go()

    def _let_go(self) -> None:
        if self._held is not None:
            os.close(self._held)
        self._path = self._held = None
        self._written = _Written()

    def _begin(self, run: RunSoFar) -> Path:
        make_private(self._folder)
        path = self._folder / f"unfinished-{secrets.token_hex(8)}.journal"
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW
        held = os.open(path, flags, 0o600)
        try:
            fcntl.flock(held, fcntl.LOCK_EX)
            source = asdict(run.source)
            append_line(path, {"source": source, "clock": run.clock, "wall": run.wall})
        except BaseException:
            # Without its first line the rest of the file would be worth nothing.
            os.close(held)
            path.unlink(missing_ok=True)
            raise
        self._held, self._path = held, path
        return path


@contextlib.contextmanager
def interrupted_runs(
    folder: Path, tell: Callable[[str], object]
) -> Iterator[list[tuple[Path, RunSoFar]]]:
    """Return the runs of programs that are no more, the newest first, each with its file.

    The files are held meanwhile; each is to be removed once its run is kept. Those that tell of no
    run are removed here. Something else in a file's place is set aside, and told; one that the disk
    refuses is told, and left to a later start.
    """
    with contextlib.ExitStack() as held:
        found = []
        for path in sorted(folder.glob("unfinished-*.journal")):
            try:
                if not _holds(path, held):
                    continue
                run = _run_of(read_lines(path))
                if run is None:
                    path.unlink(missing_ok=True)
                else:
                    found.append((path, run))
            except FileNotFoundError:
                continue  # another program was quicker
            except OSError as error:
                done = set_aside(path) if is_no_file(error) else _LEFT
                tell(f"a run that was interrupted cannot be read: {error}; {done}")
        yield sorted(found, key=lambda each: -each[1].wall)


def _holds(path: Path, held: contextlib.ExitStack) -> bool:
    """Hold a file, if no other program does."""
    descriptor = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
    held.callback(os.close, descriptor)
    return try_to_lock(descriptor)


def _run_of(lines: Sequence[dict[str, Any]]) -> RunSoFar | None:
    """Return the run of a file, None if it tells of none; what makes no sense is left out."""
    try:
        first, *seen = lines
        run = RunSoFar(RunSource(**first["source"]), float(first["clock"]), float(first["wall"]))
        for line in seen:
            run.rows += [tuple(map(float, row)) for row in line["rows"]]
            run.words += [Word(**word) for word in line["words"]]
            run.home = line.get("home", run.home)
            run.ended = figures_from(line["ended"]) if "ended" in line else None
            run.layers |= {
                name: _unpacked(*packed)
                for name, packed in line.get("layers", {}).items()
                if name in CELL_LAYERS
            }
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, zlib.error):
        return None
    whole = all(len(row) == len(TRACE) for row in run.rows)
    return run if run.rows and whole and np.isfinite(run.trace).all() else None


def _packed(layer: CellLayer) -> list[Any]:
    cells = base64.b64encode(zlib.compress(layer.cells.tobytes(), 1)).decode("ascii")
    return [layer.resolution, layer.origin_x, layer.origin_y, *layer.cells.shape, cells]


def _unpacked(
    resolution: float, x: float, y: float, rows: int, columns: int, text: str
) -> CellLayer:
    cells = zlib.decompressobj().decompress(base64.b64decode(text), _MOST_CELLS)
    array = np.frombuffer(cells, np.uint8).reshape(rows, columns).copy()
    return CellLayer(float(resolution), float(x), float(y), array)
