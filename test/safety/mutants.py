"""Changes the safety layer in every way that mutmut knows; each change must fail a test.

``./roomba test mutants`` runs it: some five minutes on two cores. ``survivors.yaml`` must list
exactly the changes that fail no test, each with the reason why no test can or need notice it.
"""

from __future__ import annotations

import difflib
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

import yaml
from safety.layer import ROOT, layer

FOLDER: Final = ROOT / ".cache" / "mutation"
REASONS: Final = Path(__file__).with_name("survivors.yaml")
_LINKED: Final = ("src", "test", "pyproject.toml")
_RESULT: Final = re.compile(r"^\s*(\S+): (.+)$")
_KILLED: Final = ("killed", "timeout", "caught by type check")


class Mutant(NamedTuple):
    """A change of a line; ``module`` is the file within src."""

    module: str
    old: str
    new: str


def reasons() -> dict[Mutant, str]:
    """Return the mutants that may survive, each with its reason."""
    found = yaml.safe_load(REASONS.read_text(encoding="utf-8"))
    return {
        Mutant(module, each["old"], each["new"]): reason
        for reason, modules in found.items()
        for module, changes in modules.items()
        for each in changes
    }


def survivors() -> Iterator[Mutant]:
    """Make all mutants, run the tests of each, and return those that no test noticed."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    for name in _LINKED:
        (FOLDER / name).symlink_to(ROOT / name)
    modules, tests = layer()
    settings = {
        "source_paths": ["src"],
        "only_mutate": modules,
        "pytest_add_cli_args_test_selection": tests,
    }
    lines = [f"{key} =\n" + "".join(f"    {each}\n" for each in settings[key]) for key in settings]
    (FOLDER / "setup.cfg").write_text("[mutmut]\n" + "".join(lines), encoding="utf-8")
    _mutmut("run", "--max-children", str(os.cpu_count() or 1))
    results = subprocess.run(
        [sys.executable, "-m", "mutmut", "results", "--all", "true"],
        cwd=FOLDER,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    found = [match.groups() for line in results.splitlines() if (match := _RESULT.match(line))]
    if not found:
        raise SystemExit(f"expected mutants of the safety layer, got none: {results[:400]!r}")
    alive = [name for name, status in found if status not in _KILLED]
    print(f"{len(found)} mutants, {len(alive)} survived")
    for name in alive:
        yield _change(name)


def _mutmut(*arguments: str) -> None:
    subprocess.run([sys.executable, "-m", "mutmut", *arguments], cwd=FOLDER, check=True)


def _change(name: str) -> Mutant:
    """Return the change that a mutant made."""
    shown = subprocess.run(
        [sys.executable, "-m", "mutmut", "show", name],
        cwd=FOLDER,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    lines = shown.splitlines()
    module = next(line.split()[1] for line in lines if line.startswith("--- "))
    sides = {
        sign: " ".join(
            line[1:].strip() for line in lines if line.startswith(sign) and line[:3] != 3 * sign
        )
        for sign in "-+"
    }
    return Mutant(module.removeprefix("src/"), sides["-"], sides["+"])


def find_mutants() -> int:
    """Return the exit status: 0 if each survivor has a reason, and each reason a survivor."""
    may, alive = reasons(), set(survivors())
    for mutant in sorted(alive - set(may)):
        print(f"no test notices: {mutant.module}\n  - {mutant.old}\n  + {mutant.new}")
    for mutant in sorted(set(may) - alive):
        near = difflib.get_close_matches(mutant.old, [each.old for each in alive], 1)
        print(f"remove from {REASONS.name}, it did not survive: {mutant}; near: {near}")
    return int(alive != set(may))
