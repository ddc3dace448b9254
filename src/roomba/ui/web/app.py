"""The application: the page, the API, and the streams of what viewers see, for one robot."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

from fastapi import FastAPI, HTTPException, Response, WebSocket
from fastapi.exceptions import RequestValidationError
from fastapi.staticfiles import StaticFiles
from starlette.types import Scope

from roomba.client.household import Household
from roomba.client.observed import MapKeeper, ObservedRobot, Playground
from roomba.client.protocol import CameraClient
from roomba.history.recorder import HistoryKeeper
from roomba.ui.web.bounded.limits import SERVER_LIMITS
from roomba.ui.web.feed import Feed
from roomba.ui.web.guard import Guard
from roomba.ui.web.guarded_requests import GuardedRequests
from roomba.ui.web.plain_faults import Refusal, refuse_unfit
from roomba.ui.web.rosbridge_route import Bridge, add_bridge
from roomba.ui.web.routes.api import api_of
from roomba.ui.web.routes.examples import DescribedApp
from roomba.ui.web.routes.household import household_api
from roomba.ui.web.routes.past import Replays, history_api
from roomba.ui.web.routes.playing import playing_api
from roomba.ui.web.streams.listening import events_api
from roomba.ui.web.streams.metrics import metrics_api
from roomba.ui.web.viewers import Viewers

STATIC: Final = Path(__file__).parent / "static"
_ABOUT: Final = """What a robot vacuum does, and what it may be asked to do.

All lengths are in m, angles in rad counter-clockwise, times in s, in the frame of the map. Requests
that change anything need the token: `Authorization: Bearer TOKEN`. A refusal is status 409 with the
robot's sentence in `detail`, a robot that does not answer 503, and a request that does not fit 422
with what was expected."""


def create_app(
    robot: ObservedRobot,
    guard: Guard,
    keeper: HistoryKeeper | None = None,
    bridge: Bridge | None = None,
    household: Household | None = None,
) -> FastAPI:
    """Return the application for a robot; what changes anything needs the guard's token.

    With a ``keeper`` the runs are kept in the history, which the page shows. The ``bridge`` speaks
    rosbridge with programs, if the robot is one on ROS. With a ``household`` the page shows upkeep
    and plans.
    """
    feed = Feed(robot, keeper, household)
    replays = (
        None if keeper is None else Replays(keeper.history, lambda run: create_app(run, guard))
    )

    @contextlib.asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        looking = asyncio.create_task(feed.run())
        try:
            yield
        finally:
            looking.cancel()
            await asyncio.wait({looking})
            if replays is not None:
                await replays.end()

    abilities = {
        "history": keeper is not None,
        "camera": isinstance(robot, CameraClient),
        "maps": isinstance(robot, MapKeeper),
    }
    app = DescribedApp(
        title="roomba_robot",
        version="1",
        description=_ABOUT,
        lifespan=life,
        docs_url=None,
        redoc_url=None,
        responses={"4XX": {"model": Refusal, "description": "Refused, for the reason told"}},
        exception_handlers={RequestValidationError: refuse_unfit},
    )
    limits = {"server": SERVER_LIMITS, "rosbridge": None if bridge is None else bridge.limits}
    note = _forget if keeper is None else keeper.note
    app.include_router(api_of(robot, limits, note, household))
    app.include_router(events_api(feed.events))
    if household is not None:
        app.include_router(household_api(household))
    app.include_router(metrics_api(feed.metrics))
    if isinstance(robot, Playground):
        app.include_router(playing_api(robot))
    viewers = Viewers(feed, robot, guard, abilities)

    @app.websocket("/live")
    async def live(socket: WebSocket) -> None:
        await viewers.serve(socket)

    if bridge is not None:
        add_bridge(app, bridge, guard)
    if keeper is not None and replays is not None:
        app.include_router(history_api(keeper.history))
        app.mount("/replay", replays)
    app.mount("/", _PageFiles(directory=STATIC, html=True), name="page")
    app.add_middleware(GuardedRequests, guard=guard)
    return app


class _PageFiles(StaticFiles):
    """The files of the page; also gets requests of the API with a wrong path or method."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file."""
        if path.startswith("api/") and scope["method"] != "GET":
            raise HTTPException(405)
        return await super().get_response(path, scope)


def _forget(_: object) -> None:
    """Use as a callback that keeps nothing."""
