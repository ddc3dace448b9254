"""Packages of the distribution and of PyPI that the running robot needs, with versions."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import Distribution, distributions
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

_QUERY: Final = "\t".join(
    ("${db:Status-Status}", "${Package}", "${Version}", "${Pre-Depends}, ${Depends}", "${Provides}")
)
_WORD: Final = re.compile(r"[a-z0-9][a-z0-9+.-]*")


@dataclass(frozen=True, slots=True)
class Material:
    """One package: ``source`` is ``deb`` or ``pypi``; ``needs`` are names of the same source."""

    source: str
    name: str
    version: str
    license: str = ""
    needs: tuple[str, ...] = ()


def python_materials(site_packages: Path, requirements: Path) -> list[Material]:
    """Return the packages of a folder that a file of requirements needs, directly or indirectly.

    Requirements that are not in the folder come from the distribution, and are left out here.
    """
    installed: dict[str, Material] = {
        canonicalize_name(found.metadata["Name"]): _of_distribution(found)
        for found in distributions(path=[str(site_packages)])
    }
    lines = (
        line.partition("#")[0].strip() for line in requirements.read_text("utf-8").splitlines()
    )
    wanted = [canonicalize_name(Requirement(line).name) for line in lines if line]
    return _closure(wanted, installed)


def _of_distribution(found: Distribution) -> Material:
    needed = (Requirement(text) for text in found.requires or ())
    names = sorted(
        {
            canonicalize_name(each.name)
            for each in needed
            if each.marker is None or each.marker.evaluate({"extra": ""})
        }
    )
    told = found.metadata.json.get("license_expression", "")
    return Material(
        "pypi",
        canonicalize_name(found.metadata["Name"]),
        found.version,
        str(told),
        tuple(names),
    )


def system_materials(
    names: Iterable[str], query: Callable[[], str] | None = None
) -> list[Material]:
    """Return the installed packages of the distribution among ``names``, and all that they need.

    ``query`` returns what dpkg knows of all packages, in lines of five columns.
    """
    lines = (query or _ask_dpkg)().splitlines()
    rows = [line.split("\t") for line in lines if line.startswith("installed\t")]
    provided = {
        virtual: row[1] for row in rows for virtual in _WORD.findall(row[4].replace("(", " ("))
    }
    there = {row[1] for row in rows}
    installed = {
        row[1]: Material("deb", row[1], row[2], needs=_needed(row[3], there, provided))
        for row in rows
    }
    return _closure(names, installed)


def _ask_dpkg() -> str:
    command = ["dpkg-query", "--show", "--showformat", f"{_QUERY}\n"]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60.0).stdout


def _needed(field: str, there: set[str], provided: Mapping[str, str]) -> tuple[str, ...]:
    """Return for each dependency of a field the installed package that satisfies it."""
    names: dict[str, None] = {}
    for alternatives in field.split(","):
        for told in alternatives.split("|"):
            found = _WORD.match(told.strip())
            name = found[0] if found else ""
            name = name if name in there else provided.get(name, "")
            if name:
                names[name] = None
                break
    return tuple(names)


def _closure(wanted: Iterable[str], installed: Mapping[str, Material]) -> list[Material]:
    """Return the packages of these names that are installed, and all that they need, by name."""
    found: dict[str, Material] = {}
    ahead = [name for name in wanted if name in installed]
    while ahead:
        name = ahead.pop()
        if name in found:
            continue
        material = installed[name]
        needs = tuple(need for need in material.needs if need in installed and need != name)
        found[name] = replace(material, needs=needs)
        ahead += needs
    return [found[name] for name in sorted(found)]
