"""What can be done to a simulated home on the page, for teaching."""

from __future__ import annotations

import math

from fastapi import APIRouter
from pydantic import Field

from roomba.client.observed import Playground
from roomba.ui.web.routes.api import obeyed, obeying
from roomba.ui.web.routes.wishes import Answer, Name, PlaceWish, Wish


class DoorWish(Wish):
    """A door, and whether it shall be shut."""

    name: Name
    is_shut: bool


class PutWish(PlaceWish):
    """Where the robot is put, m, and its heading, rad."""

    theta: float = Field(default=0.0, ge=-math.tau, le=math.tau, allow_inf_nan=False)


def playing_api(robot: Playground) -> APIRouter:
    """Return the routes; which of them the robot obeys is in its limits, as ``play``."""
    api = APIRouter(prefix="/api/v1/play")

    @api.post("/spill", summary="Spill a heap of dirt")
    def spill(wish: PlaceWish) -> Answer:
        return obeyed(lambda: robot.spill_dirt(wish.x, wish.y))

    @api.post("/chair", summary="Put a chair in the way")
    def chair(wish: PlaceWish) -> Answer:
        return obeyed(lambda: robot.place_chair(wish.x, wish.y))

    @api.post("/door", summary="Shut or open a door")
    def door(wish: DoorWish) -> Answer:
        return obeyed(lambda: robot.set_door(wish.name, is_shut=wish.is_shut))

    @api.post("/put", summary="Put the robot down elsewhere")
    def put(wish: PutWish) -> Answer:
        return obeyed(lambda: robot.put_down(wish.x, wish.y, wish.theta))

    for name, summary, act in (
        ("block", "Put a box before the station", robot.block_station),
        ("clear", "Take away all that was put down", robot.clear_away),
        ("lift", "Lift the robot", robot.lift),
    ):
        api.add_api_route(f"/{name}", obeying(act), methods=["POST"], summary=summary, name=name)
    return api
