"""The HTTP API: what a program may read of a robot, and ask of it. OpenAPI describes it itself."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

from fastapi import APIRouter, HTTPException, Response
from PIL import Image

from roomba.client.household import Household, told_of
from roomba.client.observed import FeelsLowThings, MapKeeper, ObservedRobot, Timeline
from roomba.client.plain import home_of, replay_of, state_of
from roomba.client.protocol import CameraClient, RequestRefusedError, RobotUnavailableError
from roomba.client.view import ZoneView
from roomba.ui.web.routes.wishes import (
    Answer,
    CameraWish,
    ChangeWish,
    CleanWish,
    DriveWish,
    MapName,
    PlaceWish,
    QueueWish,
    ReplayWish,
    RoomCut,
    RoomName,
    RoomNames,
    SpeedWish,
    StopWish,
    ZoneWish,
    request_of,
    ways_of,
)
from roomba.vocabulary import Phase

_Value = TypeVar("_Value")
Note = Callable[[dict[str, Any] | None], None]
_QUALITY: Final = 85
"""Percent, of JPEG."""


def api_of(
    robot: ObservedRobot,
    limits: Mapping[str, Any],
    note: Note,
    household: Household | None = None,
) -> APIRouter:
    """Return the routes for one robot; ``limits`` are those of its server.

    ``note`` is called with the body of each request to clean, and with None when the robot refuses
    it. The state includes the household, if there is one.
    """
    api = APIRouter(prefix="/api/v1")
    _add_views(api, robot, limits, household)
    _add_errands(api, robot, note)
    _add_edits(api, robot)
    _add_replay(api, robot)
    _add_camera(api, robot)
    _add_low_things(api, robot)
    _add_maps(api, robot)
    return api


def _add_views(
    api: APIRouter,
    robot: ObservedRobot,
    of_server: Mapping[str, Any],
    household: Household | None,
) -> None:
    @api.get("/state", summary="The robot now")
    def state() -> dict[str, Any]:
        return _asked(lambda: {**state_of(robot.robot()), **told_of(household)})

    @api.get("/home", summary="Rooms, zones, station")
    def home() -> dict[str, Any]:
        return _asked(lambda: home_of(robot.home()))

    @api.get("/limits", summary="What may be asked for")
    def limits() -> dict[str, Any]:
        found = _asked(robot.limits)
        of_robot = {name: getattr(found, name) for name in found.__slots__}
        return {**of_robot, **of_server}


def _add_errands(api: APIRouter, robot: ObservedRobot, note: Note) -> None:
    @api.post("/clean", summary="Begin a clean")
    def clean(wish: CleanWish) -> Answer:
        # Noted before the robot's answer, as the run may have begun when that comes.
        note(wish.model_dump(mode="json"))
        try:
            return obeyed(lambda: robot.clean(request_of(wish)))
        except HTTPException:
            note(None)
            raise

    @api.put("/queue", summary="Let the clean of rooms under way go on with other rooms")
    def queue(wish: QueueWish) -> Answer:
        return obeyed(lambda: robot.change_rooms(tuple(wish.rooms), ways_of(wish.each)))

    plain: tuple[tuple[str, str, Callable[[], None]], ...] = (
        ("explore", "Look at what the map does not show yet", robot.explore),
        ("dock", "Go to the charging station", robot.dock),
        ("pause", "Stand until told to go on", lambda: _pause(robot)),
        ("resume", "Go on", robot.resume),
        ("stop", "End the errand, and stay", robot.stop),
        ("locate", "Beep", robot.locate),
        ("empty_bin", "The dust bin was emptied", robot.empty_bin),
        ("empty_at_station", "Let its station empty its bin", robot.empty_at_station),
        ("replace_bag", "Put an empty bag into its simulated station", robot.replace_bag),
        ("release", "Release the emergency stop", robot.release),
    )
    for name, summary, command in plain:
        api.add_api_route(
            f"/{name}", obeying(command), methods=["POST"], summary=summary, name=name
        )

    @api.post("/go", summary="Walk to a point")
    def go_to(wish: PlaceWish) -> Answer:
        return obeyed(lambda: robot.go_to(wish.x, wish.y))

    @api.post("/emergency_stop", summary="Hold the drive until it is released")
    def emergency_stop(wish: StopWish) -> Answer:
        return obeyed(lambda: robot.emergency_stop(wish.reason))

    @api.post("/speed", summary="Set how fast the robot may drive")
    def top_speed(wish: SpeedWish) -> Answer:
        return obeyed(lambda: robot.set_top_speed(wish.speed))

    @api.post("/drive", summary="Drive by hand")
    def drive(wish: DriveWish) -> Answer:
        return obeyed(lambda: robot.drive(wish.linear, wish.angular))


def _pause(robot: ObservedRobot) -> None:
    """Pause the robot; one that is paused already is as wished."""
    try:
        robot.pause()
    except RequestRefusedError:
        if robot.robot().vacuum.phase != Phase.PAUSED:
            raise


def _add_edits(api: APIRouter, robot: ObservedRobot) -> None:
    @api.put("/zones", summary="Add a zone, or replace the one of the same name")
    def put_zone(wish: ZoneWish) -> Answer:
        zone = ZoneView(wish.name, wish.kind, tuple(wish.points))
        return obeyed(lambda: robot.put_zone(zone))

    @api.delete("/zones/{name:path}", summary="Remove a zone")
    def remove_zone(name: str) -> Answer:
        return obeyed(lambda: robot.remove_zone(name))

    @api.post("/rooms/rename", summary="Give a room another name")
    def rename_room(wish: RoomName) -> Answer:
        return obeyed(lambda: robot.rename_room(wish.name, wish.new_name))

    @api.post("/rooms/join", summary="Make rooms that touch one")
    def join_rooms(wish: RoomNames) -> Answer:
        return obeyed(lambda: robot.join_rooms(tuple(wish.names)))

    @api.post("/rooms/split", summary="Cut a room along a line")
    def split_room(wish: RoomCut) -> Answer:
        return obeyed(lambda: robot.split_room(wish.name, wish.start, wish.end))

    undo = "Take back the newest edit of the rooms"
    api.add_api_route("/rooms/undo", obeying(robot.undo_rooms), methods=["POST"], summary=undo)


def _add_low_things(api: APIRouter, robot: ObservedRobot) -> None:
    """Add the routes for zones that the robot offers."""
    if not isinstance(robot, FeelsLowThings):
        return

    @api.post("/low_things/ignore", summary="Offer no zone any more of what was felt there")
    def ignore_low_thing(wish: PlaceWish) -> Answer:
        return obeyed(lambda: robot.ignore_low_thing(wish.x, wish.y))


def _add_maps(api: APIRouter, robot: ObservedRobot) -> None:
    """Add the maps of a robot that keeps maps of its own."""
    if not isinstance(robot, MapKeeper):
        return

    @api.get("/maps", summary="The saved maps")
    def maps() -> dict[str, Any]:
        found = _asked(robot.maps)
        return {"names": found.names, "selected": found.selected}

    @api.post("/maps/save", summary="Save the map by a name")
    def save(wish: MapName) -> Answer:
        return obeyed(lambda: robot.save_map(wish.name))

    @api.post("/maps/load", summary="Go by a saved map")
    def load(wish: MapName) -> Answer:
        return obeyed(lambda: robot.load_map(wish.name))

    @api.delete("/maps/{name:path}", summary="Forget a saved map")
    def remove(name: str) -> Answer:
        return obeyed(lambda: robot.remove_map(name))

    @api.post("/maps/change", summary="Change the map as it is offered, or leave it")
    def change(wish: ChangeWish) -> Answer:
        return obeyed(lambda: robot.change_map(is_accepted=wish.accept))

    undo = "Take back the change that was accepted last"
    api.add_api_route("/maps/undo", obeying(robot.undo_change), methods=["POST"], summary=undo)


def _add_camera(api: APIRouter, robot: ObservedRobot) -> None:
    """Add the camera, if there is one; its pictures show the home's inside and need the token."""
    if not isinstance(robot, CameraClient):
        return

    @api.post("/camera", summary="What the camera sees, as JPEG", response_class=Response)
    def picture(wish: CameraWish) -> Response:
        pixels = _asked(lambda: robot.picture(wish.angle))
        packed = io.BytesIO()
        Image.fromarray(pixels, "RGB").save(packed, "JPEG", quality=_QUALITY)
        return Response(packed.getvalue(), media_type="image/jpeg")


def _add_replay(api: APIRouter, robot: ObservedRobot) -> None:
    """Add the routes that control a recording, if the robot is one."""
    if not isinstance(robot, Timeline):
        return

    @api.post("/replay", summary="Show another time of the recording, let it go on, or stand")
    def replay(wish: ReplayWish) -> dict[str, Any]:
        if wish.speed is not None:
            robot.set_speed(wish.speed)
        if wish.at is not None:
            robot.seek(wish.at)
        if wish.playing is not None:
            robot.play(is_playing=wish.playing)
        return replay_of(robot.timeline())


def obeying(command: Callable[[], None]) -> Callable[[], Answer]:
    """Return a route's function that obeys a request by a command."""

    def obey() -> Answer:
        return obeyed(command)

    return obey


def obeyed(command: Callable[[], None]) -> Answer:
    """Let the robot obey; a refusal becomes 409 with its sentence, silence 503."""
    _asked(command)
    return Answer()


def _asked(ask: Callable[[], _Value]) -> _Value:
    """Return the robot's answer; a refusal becomes 409 with its sentence, silence 503."""
    try:
        return ask()
    except RequestRefusedError as refusal:
        raise HTTPException(409, str(refusal)) from refusal
    except RobotUnavailableError as reason:
        raise HTTPException(503, str(reason)) from reason
