"""Of which sources compiled code is made: a module and all of this package that it imports.

numba keeps what it compiled by the file of a function, and does not see that another file changed
from which a part or a number of it comes. So each module's code is kept in a folder of its own for
each state of these sources. Another state, of another branch say, has other folders, and the ones
of before are there still when one goes back.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final
from uuid import uuid4

import numba

PACKAGE: Final = Path(__file__).parent
_NUMBA: Final[Any] = numba.config
_KNOWN: Final = "sources.json"
"""File in numba's folder: what is known of sources, by their path, until they change."""
_NO_PART: Final = (Path(__file__).name,)
"""Files that have no part in what is compiled, though they are imported for it."""
_DIGITS: Final = 16
"""Of a hash in the name of a folder."""
_IMPORT: Final = re.compile(
    r"^\s*(?:from\s+(?P<of>roomba[\w.]*)\s+import\s+(?P<names>\([^)]*\)|.*)|import\s+(?P<module>roomba[\w.]*))",
    re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class SourceFile:
    """What a file is: its ``content`` hashed, and the package's files it imports from, by path.

    It is known to be so while its time of change, ns, and its size, bytes, stay.
    """

    changed: int
    size: int
    content: str
    imports: tuple[str, ...]


class Sources:
    """The sources of a package; ``known`` is a file that spares reading them at each start."""

    def __init__(self, package: Path, known: Path | None = None) -> None:
        """Read nothing but ``known``, if it can be read."""
        self._package, self._file = package, known
        self._known = {} if known is None else _read(known)
        self._found: dict[str, SourceFile] = {}

    def key(self, file: Path) -> str:
        """Return a name for the state of a file and of all that it imports, directly or not.

        The file may be one of another folder, which imports from the package.
        """
        is_own = self._package in file.parents
        first = str(file.relative_to(self._package) if is_own else file.absolute())
        reached, left = {first}, [first]
        while left:
            more = set(self._source(left.pop()).imports) - reached
            reached |= more
            left.extend(more)
        states = "".join(f"{each} {self._source(each).content}\n" for each in sorted(reached))
        return hashlib.sha256(states.encode()).hexdigest()[:_DIGITS]

    def remember(self) -> None:
        """Write ``known`` anew if something changed; one that cannot be written is left out."""
        if self._file is None or self._found.items() <= self._known.items():
            return
        self._known |= self._found
        written = self._file.with_name(f".{self._file.name}.{uuid4().hex}")
        with contextlib.suppress(OSError):
            self._file.parent.mkdir(parents=True, exist_ok=True)
            written.write_text(json.dumps({at: asdict(it) for at, it in self._known.items()}))
            written.replace(self._file)

    def _source(self, at: str) -> SourceFile:
        if at not in self._found:
            self._found[at] = self._looked_at(at)
        return self._found[at]

    def _looked_at(self, at: str) -> SourceFile:
        path = self._package / at
        status, known = path.stat(), self._known.get(at)
        if known is not None and (known.changed, known.size) == (
            status.st_mtime_ns,
            status.st_size,
        ):
            return known
        content = path.read_bytes()
        return SourceFile(
            status.st_mtime_ns,
            status.st_size,
            hashlib.sha256(content).hexdigest(),
            tuple(sorted(self._imports(content.decode("utf-8")))),
        )

    def _imports(self, text: str) -> Iterator[str]:
        """Yield the files of the package that a source imports from, in any function."""
        for found in _IMPORT.finditer(text):
            module = found["of"] or found["module"]
            names = re.findall(r"\w+", found["names"] or "")
            for name in (module, *(f"{module}.{each}" for each in names)):
                path = Path(*name.split(".")[1:])
                for file in (path.parent / f"{path.name}.py", path / "__init__.py"):
                    if str(file) not in _NO_PART and (self._package / file).is_file():
                        yield str(file)


def _read(known: Path) -> dict[str, SourceFile]:
    """Return what a file of before knows; nothing of one that is missing or damaged."""
    try:
        return {
            str(at): SourceFile(
                int(it["changed"]), int(it["size"]), str(it["content"]), tuple(it["imports"])
            )
            for at, it in json.loads(known.read_text(encoding="utf-8")).items()
        }
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return {}


@contextlib.contextmanager
def kept_by_sources(file: Path) -> Iterator[None]:
    """Let numba keep what is compiled meanwhile of a file in the folder for its sources.

    Without a folder that numba was told, and for what stands in no file, it keeps that where it
    likes. A file of another folder, such as a stage of planning of a user's own, counts with the
    parts of this package that it imports.
    """
    before = _NUMBA.CACHE_DIR
    if not before or not file.is_file():
        yield
        return
    sources = _sources(before)
    within = file.relative_to(PACKAGE) if PACKAGE in file.parents else Path("other", file.name)
    name = ".".join(within.with_suffix("").parts)
    _NUMBA.CACHE_DIR = os.path.join(before, f"{name}-{sources.key(file)}")
    sources.remember()
    try:
        yield
    finally:
        _NUMBA.CACHE_DIR = before


@functools.cache
def _sources(folder: str) -> Sources:
    return Sources(PACKAGE, Path(folder) / _KNOWN)
