"""The words and limits of what can be asked of a robot, and the words for what it does.

Programs, the menu, messages and the page share them.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from typing import Final

MOST_PASSES: Final = 5
"""Most passes over the same floor; a larger number is taken for a typing mistake."""
MOST_ZONES: Final = 1000
"""Most zones of a map, remembered rooms of a map, and zones or rooms of one clean or plan."""
MOST_CORNERS: Final = 200
"""Most corners of a zone."""
LONGEST_NAME: Final = 80
"""Most characters of a room's or zone's name."""
OVERTAKEN: Final = "a newer goal took over"
"""Why a goal ended that another goal replaced."""
_JOINERS: Final = "\u200c\u200d"
"""Invisible characters between two others, which Persian words and many emoji need."""
_LISTED: Final = 20
"""Most names that a message lists."""


class CleanMode(Enum):
    """What is to be cleaned."""

    WHOLE = "whole"
    """All floor that can be reached."""
    ROOMS = "rooms"
    """Rooms, by name."""
    ZONES = "zones"
    """Rectangles."""
    SPOT = "spot"
    """A square around a point; its size is ``cleaning.spot_size`` of the configuration."""
    EDGES = "edges"
    """Along walls and furniture only."""
    DIRTIEST = "dirtiest"
    """All rooms, those first that were the dirtiest."""


class FanLevel(Enum):
    """The power of the fan; what duty that is stands in the configuration, under ``fan``."""

    QUIET = "quiet"
    STANDARD = "standard"
    STRONG = "strong"


class CarpetWay(Enum):
    """What is done on carpets."""

    BOOST = "boost"
    """The fan at its strongest, unless it was asked to be quiet."""
    SAME = "as elsewhere"
    """The fan as it was asked for."""
    AVOID = "avoid"
    """Carpets that are drawn on the map are not cleaned."""


class EdgeOrder(Enum):
    """When the strip along walls and furniture is cleaned."""

    ANY = "any"
    """At the point of the tour that makes the way shortest."""
    FIRST = "first"
    """Before the rest of the floor, room by room."""
    LAST = "last"
    """After the rest of the floor."""


class Phase(str, Enum):
    """What a robot does now.

    A phase equals its word, which is what programs hear. A robot of another program may report a
    word that is none of these.
    """

    IDLE = "idle"
    """Stands somewhere and has nothing to do."""
    DOCKED = "docked"
    """Stands on its station and has nothing to do."""
    UNDOCKING = "undocking"
    CLEANING = "cleaning"
    EXPLORING = "exploring"
    """On its way to where its map ends."""
    RETURNING = "returning"
    """On its way to a place before its station."""
    DOCKING = "docking"
    """Driving onto the station, by its beams."""
    CHARGING = "charging"
    """On its station until it is charged enough to go on with its errand."""
    BIN_FULL = "bin full"
    """Stands until its dust bin was emptied, then goes on with its errand."""
    EMPTYING = "emptying"
    """On its station, which takes the dirt out of its bin."""
    PAUSED = "paused"
    """Stands until it is told to go on."""
    ERROR = "error"
    """Stands until the operator helped and tells it to resume."""
    EMERGENCY = "emergency stop"
    """Stands until the emergency stop is released."""


AT_REST: Final = frozenset((Phase.DOCKED, Phase.IDLE))
"""Phases of a robot that has no errand; its state is called the same then."""
HELD: Final = frozenset((Phase.PAUSED, Phase.ERROR))
"""Phases, and states of the same names, in which a robot waits to be told to go on."""


@dataclass(frozen=True, slots=True)
class RoomWay:
    """How one of the rooms of a clean is cleaned: how often, and how strongly it sucks."""

    passes: int = 1
    fan: FanLevel = FanLevel.STANDARD


@dataclass(frozen=True, slots=True)
class RoomDirt:
    """How dirty a room was that a clean swept: ``share`` of its floor that was swept, 0..1.

    ``grains`` is how many the dirt sensor counted per m2 there.
    """

    room: str
    share: float
    grains: float


class Hindrance(str, Enum):
    """What keeps a robot from what it was asked, for programs to decide by.

    A hindrance equals its word, which is what programs hear.
    """

    NONE = ""
    """No hindrance, or one that programs need not know: the text beside it tells people."""
    NO_WAY = "no way"
    """It waits for a way to open."""
    BIN_FULL = "bin full"
    NOT_EMPTIED = "not emptied"
    """Its station did not empty its dust bin, which has to be emptied by hand."""
    STOP_RELEASED = "stop released"
    """The emergency stop that interrupted it was released, and it waits to be told to go on."""
    UNREACHABLE = "unreachable"
    """The connection to the robot is gone, or the robot does not answer."""
    SENSOR_SILENT = "sensor silent"
    """It stands, because it does not report its sensors."""
    DISOBEYS = "disobeys"
    """It reports its sensors, but does not do what it is told."""


@dataclass(frozen=True, slots=True)
class Reason:
    """Why a robot does not do what was asked; empty when all is well.

    ``text`` is for people and says what helps; its wording may change. Programs decide by
    ``hindrance``. ``looks_within``: the robot looks again for a way within so many s; 0 if not.
    """

    text: str = ""
    hindrance: Hindrance = Hindrance.NONE
    looks_within: float = 0.0

    def __bool__(self) -> bool:
        """Whether there is a reason."""
        return bool(self.text)


NO_REASON: Final = Reason()


class EdgeReason(str, Enum):
    """Why a map ends at an edge; a reason equals its words."""

    NOT_LOOKED_AT = "it got to no place from which to look there"
    NO_ECHO = "it looked there and the lidar met nothing: too far away, black, or of glass"


@dataclass(frozen=True, slots=True)
class OpenEdge:
    """Where a map still ends: for ``length`` m at (x, y), m, map frame, and why."""

    length: float
    x: float
    y: float
    reason: EdgeReason


@dataclass(frozen=True, slots=True)
class MissedFloor:
    """Floor that was wanted and is not clean: ``area`` m2 around (x, y), m, and why, in words.

    ``code`` is the reason for programs, as of :func:`word_of`; empty where it was not kept.
    """

    area: float
    x: float
    y: float
    room: str
    reason: str
    code: str = ""


def word_of(reason: Enum) -> str:
    """Return the word for a reason by which programs decide: its value is a sentence for people."""
    return reason.name.lower().replace("_", " ")


def fault_of_name(name: str) -> str:
    """Return why a text is no valid name: what was expected and what came; "" if it is valid."""
    if 0 < len(name) <= LONGEST_NAME and name.strip() and is_readable(name):
        return ""
    # Of a very long name, the beginning tells enough.
    return f"expected a name of 1 to {LONGEST_NAME} printable characters, got {name[:40]!r}"


def checked_name(name: str) -> str:
    """Return a valid name as it is; raises ValueError, which says what was expected, for others."""
    if fault := fault_of_name(name):
        raise ValueError(fault)
    return name


def is_readable(text: str) -> bool:
    """Whether a text is visible throughout; a joiner counts between two visible characters."""
    is_visible = [letter.isprintable() and letter != " " for letter in text]
    return all(
        0 < at < len(text) - 1 and is_visible[at - 1] and is_visible[at + 1]
        if letter in _JOINERS
        else letter.isprintable()
        for at, letter in enumerate(text)
    )


def cleaned_name(text: str) -> str:
    """Return a name made from a text of another program; "" if nothing is left of it.

    White space of any kind is one space, what cannot be seen is left out, and the end is cut off.
    """
    seen = (
        letter for letter in text if letter.isprintable() or letter.isspace() or letter in _JOINERS
    )
    name = " ".join("".join(seen).split())[:LONGEST_NAME].rstrip()
    if is_readable(name):
        return name
    return cleaned_name("".join(letter for letter in name if letter not in _JOINERS))


def places_told(count: int) -> str:
    """Return a number of places in words, such as "1 place"."""
    return f"{count} place" if count == 1 else f"{count} places"


def another_name(name: str, taken: Collection[str]) -> str:
    """Return the first of "X 2", "X 3" ... that is not ``taken``, X being ``name``.

    ``name`` is cut where the result would be longer than a name may be.
    """
    ends = (f" {number}" for number in itertools.count(2))
    names = (f"{name[: LONGEST_NAME - len(end)].rstrip()}{end}" for end in ends)
    return next(new for new in names if new not in taken)


def listed(names: Collection[str]) -> str:
    """Return names as a list to be read; of many the first ones, and how many more there are."""
    shown = ", ".join(list(names)[:_LISTED]) or "none"
    more = len(names) - _LISTED
    return f"{shown} and {more} more" if more > 0 else shown
