"""The sources of a module's compiled code: the module and all that it imports of this package.

numba caches compiled code by the file of the function, and does not notice a change in another file
from which the function takes a part or a number. So each module's code is cached in a folder of its
own for each state of these sources (`roomba.compilation`). Another state, such as that of another
branch, has other folders, and the earlier folders are still there when the user switches back.

``python3 -m roomba.compiled_sources`` prints a name for the state of all sources of compiled code.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final
from uuid import uuid4

PACKAGE: Final = Path(__file__).parent
_NO_PART: Final = (Path(__file__).name,)
"""Files that are imported to compile, but do not influence what is compiled."""
_DIGITS: Final = 16
"""Hexadecimal digits of the hash in a folder's name."""
_COMPILES: Final = re.compile(r"^from roomba[\w.]*\.compilation import", re.MULTILINE)
_IMPORT: Final = re.compile(
    r"^\s*(?:from\s+(?P<of>roomba[\w.]*)\s+import\s+(?P<names>\([^)]*\)|.*)|import\s+(?P<module>roomba[\w.]*))",
    re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class SourceFile:
    """The state of a file: the hash of its ``content``, and the package's files that it imports.

    This state is trusted while the file's modification time, ns, and size, bytes, stay the same.
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

    def key(self, *files: Path) -> str:
        """Return a name for the state of files and of all that they import, directly or not.

        A file may lie outside the package and import from it.
        """
        left = [self._named(file) for file in files]
        reached = set(left)
        while left:
            more = set(self._source(left.pop()).imports) - reached
            reached |= more
            left.extend(more)
        states = "".join(f"{each} {self._source(each).content}\n" for each in sorted(reached))
        return hashlib.sha256(states.encode()).hexdigest()[:_DIGITS]

    def remember(self) -> None:
        """Write ``known`` again if something changed; a failure to write it is ignored."""
        if self._file is None or self._found.items() <= self._known.items():
            return
        self._known |= self._found
        written = self._file.with_name(f".{self._file.name}.{uuid4().hex}")
        with contextlib.suppress(OSError):
            self._file.parent.mkdir(parents=True, exist_ok=True)
            written.write_text(json.dumps({at: asdict(it) for at, it in self._known.items()}))
            written.replace(self._file)

    def _named(self, file: Path) -> str:
        is_own = self._package in file.parents
        return str(file.relative_to(self._package) if is_own else file.absolute())

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
        """Yield the package's files that a source imports, inside its functions as well."""
        for found in _IMPORT.finditer(text):
            module = found["of"] or found["module"]
            names = re.findall(r"\w+", found["names"] or "")
            for name in (module, *(f"{module}.{each}" for each in names)):
                path = Path(*name.split(".")[1:])
                for file in (path.parent / f"{path.name}.py", path / "__init__.py"):
                    if str(file) not in _NO_PART and (self._package / file).is_file():
                        yield str(file)


def _read(known: Path) -> dict[str, SourceFile]:
    """Return what an earlier process wrote; nothing if the file is missing or damaged."""
    try:
        return {
            str(at): SourceFile(
                int(it["changed"]), int(it["size"]), str(it["content"]), tuple(it["imports"])
            )
            for at, it in json.loads(known.read_text(encoding="utf-8")).items()
        }
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return {}


def files_with_compiled_functions(package: Path) -> list[Path]:
    """Return the files of a package that compile functions, in their order."""
    files = sorted(package.rglob("*.py"))
    return [path for path in files if _COMPILES.search(path.read_text(encoding="utf-8"))]


if __name__ == "__main__":
    print(Sources(PACKAGE).key(*files_with_compiled_functions(PACKAGE)))
