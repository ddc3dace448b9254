"""The time zone of this computer, by its name."""

from __future__ import annotations

import os
import zoneinfo
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.files.bounded import read_bytes
from roomba.plans.plan import is_zone

_ETC: Final = Path("/etc")
_ZONES: Final = Path("/usr/share/zoneinfo")
_FOLDER: Final = "zoneinfo/"
_USUAL: Final = "zone1970.tab"
"""The system's list of zones that differed since 1970: one name of each, in column 3."""
_MOST_BYTES: Final = 100_000
"""Of a file of these; the largest zone has some thousands."""
_OTHERWISE: Final = "UTC"


@dataclass(frozen=True, slots=True)
class LocalZone:
    """A zone by its name; ``doubt`` is why it is a guess, empty if this computer tells it."""

    name: str
    doubt: str = ""


def local_zone(
    environment: Mapping[str, str] | None = None, etc: Path = _ETC, zones: Path = _ZONES
) -> LocalZone:
    """Return the zone of ``$TZ``, else of ``localtime`` or ``timezone`` in ``etc``, else UTC.

    ``$TZ`` may name a zone or a file, or be a rule such as CET-1CEST,M3.5.0,M10.5.0/3. A file that
    is a copy, and no link, tells its rule but not its name. Any of this system's ``zones`` with
    that rule has the right hours; what the copy or the other files tell decides between them.
    """
    given = (os.environ if environment is None else environment).get("TZ", "").removeprefix(":")
    if _is_known(given):
        return LocalZone(given)
    is_rule = given != "" and not given.startswith("/")
    file = Path(given) if given.startswith("/") else etc / "localtime"
    linked, written = _linked(file), _read(etc / "timezone").decode("ascii", "replace").strip()
    if _is_known(linked) and not is_rule:
        return LocalZone(linked)
    copy = _read(file)
    alike = _zones_of(os.fsencode(given) if is_rule else _rule_of(copy), zones)
    if alike:
        return LocalZone(_meant(alike, copy, {linked, written}, _usual(zones)))
    name = next(filter(_is_known, (linked, written)), "")
    if name and not is_rule:
        return LocalZone(name)
    shown = os.fsencode(file).decode("utf-8", "backslashreplace")
    tz = f"$TZ ({given[:80]!r}) is none, and " if given else ""
    return LocalZone(
        name or _OTHERWISE,
        f"expected the time zone of this computer, but {tz}{shown} and {etc / 'timezone'} name "
        f"{name or 'none'}",
    )


def _meant(
    alike: Mapping[str, bytes], copy: bytes, told: Collection[str], usual: Collection[str]
) -> str:
    """Return which of zones of one rule is meant; of several the one with the shortest name."""
    return min(
        alike,
        key=lambda name: (
            name not in told,
            alike[name] != copy,
            name not in usual,
            len(name),
            name,
        ),
    )


def _is_known(name: str) -> bool:
    return name != "" and is_zone(name)


def _linked(file: Path) -> str:
    try:
        return os.readlink(file).partition(_FOLDER)[2]
    except OSError:  # no link, or another kind of file: it does not tell its name
        return ""


def _zones_of(rule: bytes, zones: Path) -> dict[str, bytes]:
    """Return the zones of a rule by their names, each with its file; none for no rule."""
    if not rule:
        return {}
    files = {name: _read(zones / name) for name in zoneinfo.available_timezones()}
    return {name: file for name, file in files.items() if _rule_of(file) == rule}


def _rule_of(file: bytes) -> bytes:
    """Return how a zone goes on in all years to come: the last line of its file (RFC 9636)."""
    return file.removesuffix(b"\n").rpartition(b"\n")[2] if file.startswith(b"TZif") else b""


def _usual(zones: Path) -> set[str]:
    """Return the zones' usual names; many other names are older ones, or a neighbour's."""
    lines = _read(zones / _USUAL).decode("utf-8", "replace").splitlines()
    rows = [line.split("\t") for line in lines if not line.startswith("#")]
    return {_OTHERWISE, *(row[2] for row in rows if len(row) > 2)}


def _read(file: Path) -> bytes:
    """Return what a file holds; nothing of one that cannot be read."""
    try:
        return read_bytes(file, _MOST_BYTES)
    except OSError:
        return b""
