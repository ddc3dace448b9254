"""What a program may ask of a robot, by HTTP: the bodies of requests, with their limits."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from roomba.clean_request import CleanRequest
from roomba.vocabulary import (
    LONGEST_NAME,
    MOST_CORNERS,
    MOST_PASSES,
    MOST_ZONES,
    CarpetWay,
    CleanMode,
    EdgeOrder,
    FanLevel,
    RoomWay,
    checked_name,
)

Coordinate = Annotated[float, Field(ge=-1000.0, le=1000.0, allow_inf_nan=False)]
Name = Annotated[
    str,
    AfterValidator(checked_name),
    Field(json_schema_extra={"minLength": 1, "maxLength": LONGEST_NAME}),
]


class Wish(BaseModel):
    """A body of a request; unknown fields are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class RoomWish(Wish):
    """How one room is cleaned."""

    passes: int = Field(default=1, ge=1, le=MOST_PASSES)
    fan: FanLevel = FanLevel.STANDARD


class CleanWish(Wish):
    """What is to be cleaned; zones are lowest x and y, highest x and y, m, map frame.

    ``each`` is how each of the rooms is cleaned, in their order; without it ``passes`` and ``fan``
    hold for all.
    """

    mode: CleanMode = CleanMode.WHOLE
    rooms: list[Name] = Field(default=[], max_length=MOST_ZONES, examples=[["Kitchen", "Hall"]])
    in_order: bool = True
    zones: list[tuple[Coordinate, Coordinate, Coordinate, Coordinate]] = Field(
        default=[], max_length=MOST_ZONES
    )
    spot: tuple[Coordinate, Coordinate] | None = None
    passes: int = Field(default=1, ge=1, le=MOST_PASSES)
    fan: FanLevel = FanLevel.STANDARD
    each: list[RoomWish] = Field(default=[], max_length=MOST_ZONES)
    carpets: CarpetWay = CarpetWay.BOOST
    edges: EdgeOrder = EdgeOrder.ANY


def request_of(wish: CleanWish) -> CleanRequest:
    """Return what the robot is asked to clean; raises CleanRefusedError."""
    return CleanRequest(
        wish.mode,
        rooms=tuple(wish.rooms),
        in_order=wish.in_order,
        zones=tuple(wish.zones),
        spot=wish.spot,
        passes=wish.passes,
        fan=wish.fan,
        each=ways_of(wish.each),
        carpets=wish.carpets,
        edges=wish.edges,
    )


def ways_of(wishes: list[RoomWish]) -> tuple[RoomWay, ...]:
    """Return how each of the rooms is cleaned, in their order."""
    return tuple(RoomWay(way.passes, way.fan) for way in wishes)


class QueueWish(Wish):
    """All rooms that the clean under way has still to do, in their order.

    ``each`` is how each of them is cleaned; without it those of before stay as they were, and new
    ones are cleaned as all are.
    """

    rooms: list[Name] = Field(min_length=1, max_length=MOST_ZONES, examples=[["Hall", "Kitchen"]])
    each: list[RoomWish] = Field(default=[], max_length=MOST_ZONES)


class DriveWish(Wish):
    """A twist, m/s and rad/s; without another one for 0.5 s the robot stands."""

    linear: float = Field(ge=-2.0, le=2.0, allow_inf_nan=False)
    angular: float = Field(ge=-math.tau, le=math.tau, allow_inf_nan=False)


class SeenWish(Wish):
    """When the newest look at the robot was taken that a viewer has, s since 1970."""

    looked: float = Field(ge=0.0, allow_inf_nan=False)


class StopWish(Wish):
    """Why the drive is held."""

    reason: str = Field(default="the button on the page", max_length=200)


class ZoneWish(Wish):
    """A zone that the robot must not enter, or a carpet."""

    name: Name
    kind: Literal["no-go", "wall", "carpet"]
    points: list[tuple[Coordinate, Coordinate]] = Field(min_length=2, max_length=MOST_CORNERS)


class RoomName(Wish):
    """Another name for a room."""

    name: Name
    new_name: Name


class RoomNames(Wish):
    """Rooms that become one."""

    names: list[Name] = Field(min_length=2, max_length=20)


class RoomCut(Wish):
    """A line through a room."""

    name: Name
    start: tuple[Coordinate, Coordinate]
    end: tuple[Coordinate, Coordinate]


class PlaceWish(Wish):
    """A place on the floor, m."""

    x: Coordinate
    y: Coordinate


class MapName(Wish):
    """A saved map."""

    name: Name


class ChangeWish(Wish):
    """Whether the map shall be changed as it is offered."""

    accept: bool


class SpeedWish(Wish):
    """How fast the robot may drive, m/s."""

    speed: float = Field(gt=0.0, le=2.0, allow_inf_nan=False)


class CameraWish(Wish):
    """An angle of the camera, degrees, positive to the left."""

    angle: float = Field(default=0.0, ge=-180.0, le=180.0, allow_inf_nan=False)


class ReplayWish(Wish):
    """A time of a recording, s, whether it goes on, and its seconds per second."""

    at: float | None = Field(default=None, ge=0.0, le=1e6, allow_inf_nan=False)
    playing: bool | None = None
    speed: float | None = Field(default=None, ge=0.25, le=100.0, allow_inf_nan=False)


class Answer(BaseModel):
    """The robot obeys."""

    ok: Literal[True] = True
