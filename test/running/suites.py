"""The suites of ``./roomba test``, and what a line of that command asks for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum, auto
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[2]


class Kind(Enum):
    """How the tests of a suite use the machine."""

    CHECKS = auto()
    """Programs that read the sources."""
    COMPUTING = auto()
    """They compute all the time."""
    COVERAGE = auto()
    """They compute, and must run every line of the code that they test."""
    GRAPHS = auto()
    """They start robots, and wait for them most of the time."""
    PAGES = auto()
    """They start browsers."""


@dataclass(frozen=True)
class Suite:
    """A folder of tests, or the checks of the sources."""

    kind: Kind
    by_name_only: bool = False
    """Whether it runs only when it is named: it takes long, or needs an environment of its own."""


SUITES: Final = {
    "lint": Suite(Kind.CHECKS),
    "unit": Suite(Kind.COMPUTING),
    "conformance": Suite(Kind.COMPUTING),
    "safety": Suite(Kind.COVERAGE),
    "web": Suite(Kind.PAGES),
    "contract": Suite(Kind.GRAPHS),
    "ros": Suite(Kind.GRAPHS),
    "system": Suite(Kind.GRAPHS),
    "campaigns": Suite(Kind.COMPUTING, by_name_only=True),
    "docs": Suite(Kind.COMPUTING, by_name_only=True),
    "ha": Suite(Kind.COMPUTING, by_name_only=True),
    "install": Suite(Kind.GRAPHS, by_name_only=True),
    "missions": Suite(Kind.GRAPHS, by_name_only=True),
    "realtime": Suite(Kind.GRAPHS, by_name_only=True),
    "teaching": Suite(Kind.GRAPHS, by_name_only=True),
}
TIMED: Final = (
    "ros/speed/test_speed_pub_node.py",
    "system/faults/test_faults.py",
    "system/faults/test_refused_messages.py",
    "system/faults/test_standstill.py",
    "system/faults/test_supervision.py",
    "system/test_conformance.py",
    "system/test_foreign_robot.py",
)
"""Folders and files that assert promises of a tenth to a few seconds of wall time, play a bag
faster than it was recorded, or compare drives of a robot at several times real time: only commands
of idle priority compute beside them."""
WAITING: Final = (
    "ros/runtime",
    "ros/supervision",
    "system/owned",
    "system/test_create2_line.py",
)
"""Further ones, which mostly wait for lines and deadlines: they run beside those of TIMED."""
FIRST: Final = ("conformance", "unit/planning", "unit/world")
"""Computing tests that begin beside those of TIMED: one core is idle then for a while."""
BY_DEFAULT: Final = tuple(name for name, suite in SUITES.items() if not suite.by_name_only)


@dataclass(frozen=True)
class Asked:
    """What one line of ``./roomba test`` asks for."""

    suites: tuple[str, ...]
    """Names of suites; empty if the arguments name files."""
    arguments: tuple[str, ...] = field(default=())
    """Arguments for pytest."""
    thorough: bool = False
    """Whether tests marked ``thorough`` run as well, and all generated examples."""

    def has(self, kind: Kind) -> bool:
        """Whether a suite of that kind is asked for."""
        return bool(self.folders(kind))

    def folders(self, kind: Kind) -> tuple[str, ...]:
        """Return the folders of the suites of that kind."""
        return tuple(str(ROOT / "test" / name) for name in self.suites if SUITES[name].kind is kind)

    def of(self, paths: Sequence[str]) -> tuple[str, ...]:
        """Return those of these folders and files, relative to ``test``, that are asked for."""
        chosen = (path for path in paths if path.partition("/")[0] in self.suites)
        return tuple(str(ROOT / "test" / path) for path in chosen)


def asked_for(words: list[str]) -> Asked:
    """Read the words after ``./roomba test``.

    >>> asked_for(["unit", "-k", "dock"]).suites
    ('unit',)
    """
    if words[:1] == ["quick"]:
        return Asked(("lint", "unit"), ("-m", "not slow", *words[1:]))
    thorough = words[:1] == ["thorough"]
    rest = words[1:] if thorough else words
    suites: list[str] = []
    while rest and rest[0] in SUITES:
        suites.append(rest[0])
        rest = rest[1:]
    if suites:
        return Asked(tuple(suites), tuple(rest), thorough)
    if any(_is_path(word) for word in rest):
        return Asked((), tuple(rest), thorough=True)
    return Asked(BY_DEFAULT, tuple(rest), thorough)


def usage() -> str:
    """Return how the command is called, and which suites there are."""
    named = " ".join(name for name, suite in SUITES.items() if suite.by_name_only)
    return (
        "usage: ./roomba test [quick|thorough] [SUITE ...] [ARGUMENT ...]\n\n"
        f"suites: {' '.join(BY_DEFAULT)} (all of these if none is named)\n"
        f"only when named: {named}\n"
        "quick: lint, and the unit tests that are not slow; thorough: all cases and examples\n"
        "arguments, and files of tests, go to pytest: ./roomba test unit -k dock"
    )


def _is_path(word: str) -> bool:
    return not word.startswith("-") and Path(word.partition("::")[0]).exists()
