"""Every reference of a docstring to a module, a class or a function leads to one."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "src"
REFERENCE = re.compile(r":(?:mod|class|func|meth|data|attr):`[~!]?(\.?roomba[\w.]*|\.\w[\w.]*)`")


def file_of(parts: list[str]) -> Path | None:
    path = SOURCES.joinpath(*parts)
    for file in (path.with_suffix(".py"), path / "__init__.py"):
        if file.is_file():
            return file
    return None


@cache
def names_in(file: Path) -> set[str]:
    """Return the names that a module defines, and those in its classes as ``Class.name``."""
    found = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        found |= names_of(node)
        if isinstance(node, ast.ClassDef):
            for inner in node.body:
                found |= {f"{node.name}.{name}" for name in names_of(inner)}
    return found


def names_of(node: ast.stmt) -> set[str]:
    if isinstance(node, ast.ClassDef | ast.FunctionDef):
        return {node.name}
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    names = {
        name.id
        for target in targets
        if target
        for name in ast.walk(target)
        if isinstance(name, ast.Name)
    }
    if isinstance(node, ast.ImportFrom | ast.Import):
        names |= {alias.asname or alias.name for alias in node.names}
    return names


def leads_somewhere(reference: str, file: Path) -> bool:
    """Whether there is a module of this name, or one that defines the rest of it."""
    package = list(file.parent.relative_to(SOURCES).parts) if reference.startswith(".") else []
    parts = package + reference.lstrip(".").split(".")
    for count in range(len(parts), 0, -1):
        module = file_of(parts[:count])
        if module is not None:
            rest = ".".join(parts[count:])
            return not rest or rest in names_in(module)
    return False


def test_every_reference_leads_somewhere() -> None:
    references = [
        (str(file.relative_to(ROOT)), reference)
        for file in sorted(SOURCES.rglob("*.py"))
        for reference in REFERENCE.findall(file.read_text(encoding="utf-8"))
        if not leads_somewhere(reference, file)
    ]
    assert references == []
