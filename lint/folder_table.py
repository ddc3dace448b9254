"""The tables of folders in ``docs/design.md``: what each folder is, and what it may import.

A table stands under a heading with the path of a package and has the columns folder, what it is,
may import. Names of folders are relative to the package, or to ``src`` if they begin with the name
of a package; ``*`` at the end stands for a folder and all in it. Rows stand in layers: a row names
only rows below it, so no import runs back up and no cycle is possible.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from roomba.commands.pictures.import_graph import PACKAGES, Import

_CODE: Final = re.compile(r"`([^`]+)`")


class TableError(ValueError):
    """A page without the table of a package."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row: dotted names of folders from the package on, and what they may import, as written."""

    folders: tuple[str, ...]
    may_import: tuple[str, ...]


def rows_of(page: str) -> list[Row]:
    """Return the rows of all packages, upper layers first.

    Raises TableError for a page without the table of a package.
    """
    return [row for package in PACKAGES for row in _rows_of_package(page, package)]


def _rows_of_package(page: str, package: str) -> Iterator[Row]:
    heading = f"### `src/{package}`\n"
    if heading not in page:
        raise TableError(
            f"expected a heading {heading.strip()!r} with a table of folders, got none"
        )
    section = page.split(heading, 1)[1].split("\n#", 1)[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    for line in lines[2:]:
        cells = line.strip("|").split("|")
        yield Row(_modules(cells[0], package), _modules(cells[2], package))


def _modules(cell: str, package: str) -> tuple[str, ...]:
    names = (name.removesuffix(".py").replace("/", ".") for name in _CODE.findall(cell))
    return tuple(name if name.split(".")[0] in PACKAGES else f"{package}.{name}" for name in names)


def problems(rows: list[Row], folders: Collection[str], imports: Iterable[Import]) -> list[str]:
    """Return a sentence for each difference between tables and packages; empty if they agree."""
    listed = [folder for row in rows for folder in row.folders]
    return [
        *(f"{folder}: add a row for it" for folder in sorted(set(folders) - set(listed))),
        *(f"{name}: there is no such folder" for name in sorted(set(listed) - set(folders))),
        *(f"{name}: it has two rows" for name in sorted(set(listed)) if listed.count(name) > 1),
        *_names_above(rows),
        *_forbidden(_allowed(rows), imports),
    ]


def _names_above(rows: list[Row]) -> Iterator[str]:
    """Yield a sentence for each import that a row allows although it is no row below."""
    for index, row in enumerate(rows):
        below = {folder for lower in rows[index + 1 :] for folder in lower.folders}
        anywhere = {folder for each in rows for folder in each.folders}
        for name in row.may_import:
            meant = _meant(name, anywhere) - set(row.folders)
            if not meant:
                yield f"{row.folders[0]}: may import {name}, which is no folder"
            for folder in sorted(meant - below):
                yield f"{row.folders[0]}: may import {folder}, whose row is not below"


def _meant(name: str, folders: Collection[str]) -> set[str]:
    if not name.endswith(".*"):
        return {name} & set(folders)
    base = name.removesuffix(".*")
    return {folder for folder in folders if folder == base or folder.startswith(f"{base}.")}


def _allowed(rows: list[Row]) -> dict[str, set[str]]:
    """Return for each folder what it may import; all may import the last row, the shared words."""
    folders = [folder for row in rows for folder in row.folders]
    shared = set(rows[-1].folders)
    return {
        folder: shared.union(*(_meant(name, folders) for name in row.may_import))
        for row in rows
        for folder in row.folders
    }


def _forbidden(allowed: Mapping[str, set[str]], imports: Iterable[Import]) -> Iterator[str]:
    for each in imports:
        # A folder without a row is reported already.
        if each.to_folder not in allowed.get(each.from_folder, {each.to_folder}):
            yield (
                f"{each.importer} imports {each.imported}: "
                f"{each.from_folder} may not import {each.to_folder}"
            )
