"""Which folder imports which, read from the sources: packages by name, with dots."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from grimp import ImportGraph

PACKAGES: Final = ("roomba_ros", "roomba")
"""The packages, the upper layer first."""


@dataclass(frozen=True, slots=True)
class Import:
    """One import: the module that has it, the module that it is of, and both their folders."""

    importer: str
    imported: str
    from_folder: str
    to_folder: str


def folders_in(graph: ImportGraph) -> set[str]:
    """Return the folders of the packages: packages in them, and modules beside those."""
    found = {_folder_of(graph, module) for module in graph.modules if _is_own(module)}
    return found - set(PACKAGES)


def imports_in(graph: ImportGraph) -> list[Import]:
    """Return every import that leads from one folder to another, sorted."""
    found = [
        Import(importer, imported, _folder_of(graph, importer), _folder_of(graph, imported))
        for importer in sorted(graph.modules)
        if _is_own(importer)
        for imported in sorted(graph.find_modules_directly_imported_by(importer))
        if _is_own(imported)
    ]
    return [each for each in found if each.from_folder != each.to_folder]


def layers_of(imports: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Return the folders from the lowest layer up: each lies one above all that it imports.

    ``imports`` has what each folder imports. Raises ValueError when folders import in a circle.
    """
    level: dict[str, int] = {}
    try:
        for folder in TopologicalSorter(imports).static_order():
            level[folder] = max((level[below] + 1 for below in imports.get(folder, ())), default=0)
    except CycleError as error:
        raise ValueError(
            f"expected no circle of imports, got {' -> '.join(error.args[1])}"
        ) from None
    return [
        sorted(folder for folder in level if level[folder] == height)
        for height in range(max(level.values(), default=-1) + 1)
    ]


def reduced(imports: Mapping[str, Iterable[str]]) -> dict[str, set[str]]:
    """Return the imports between folders without those that follow from a chain of imports."""
    reached: dict[str, set[str]] = {}
    for layer in layers_of(imports):
        for folder in layer:
            direct = set(imports.get(folder, ()))
            reached[folder] = direct.union(*(reached[below] for below in direct))
    return {
        folder: set(direct) - set().union(*(reached[below] for below in direct))
        for folder, direct in imports.items()
    }


def _is_own(module: str) -> bool:
    return module.split(".")[0] in PACKAGES


def _folder_of(graph: ImportGraph, module: str) -> str:
    parent = module.rpartition(".")[0]
    is_folder = not parent or parent in PACKAGES or bool(graph.find_children(module))
    return module if is_folder else parent
