"""The commands of a smart home, obeyed by the robot."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ValidationError

from roomba.clean_request import CleanRequest
from roomba.client.observed import ObservedRobot
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.client.under_way import goes_on
from roomba.files.plain_json import load_json
from roomba.ui.smart_home.told_state import shortened
from roomba.ui.web.routes.wishes import CleanWish, PlaceWish, request_of
from roomba.vocabulary import HELD, CleanMode, FanLevel

_Model = TypeVar("_Model", bound=BaseModel)
_FANS: Final = tuple(level.value for level in FanLevel)


class SmartCommands:
    """Commands by name; ``fan`` is the fan level of the cleans that begin from now on."""

    def __init__(self, robot: ObservedRobot) -> None:
        """Command this robot."""
        self._robot = robot
        self.fan = FanLevel.STANDARD
        self._plain: dict[str, Callable[[], None]] = {
            "start": self._start,
            "pause": robot.pause,
            "stop": robot.stop,
            "return_to_base": robot.dock,
            "clean_spot": lambda: robot.clean(CleanRequest(CleanMode.SPOT, fan=self.fan)),
            "locate": robot.locate,
            "resume": robot.resume,
            "explore": robot.explore,
            "empty_bin": robot.empty_bin,
            "empty_at_station": robot.empty_at_station,
        }
        self._with_values: dict[str, Callable[[Any], None]] = {
            "clean": self._clean,
            "go_to": self._go_to,
        }

    @property
    def names(self) -> tuple[str, ...]:
        """The names that :meth:`send` takes."""
        return *self._plain, *self._with_values

    def command(self, payload: str) -> dict[str, Any]:
        """Obey a command that is only a name; return the answer."""
        return self._answered(payload, self._plain.get(payload))

    def set_fan(self, payload: str) -> dict[str, Any]:
        """Let the cleans from now on begin with a fan level."""

        def change() -> None:
            if payload not in _FANS:
                raise RequestRefusedError(f"expected one of {', '.join(_FANS)}, got {payload!a}")
            self.fan = FanLevel(payload)

        return self._answered("fan_speed", change)

    def send(self, payload: str) -> dict[str, Any]:
        """Obey a name, or JSON with ``command`` and what belongs to it."""
        if payload in self._plain:
            return self.command(payload)
        try:
            values = load_json(payload) if payload.lstrip().startswith("{") else payload
        except ValueError:
            values = None
        if isinstance(values, str):
            values = {"command": values}
        if not isinstance(values, dict) or not isinstance(values.get("command"), str):
            return self._answered(payload, None)
        name = values.pop("command")
        if name in self._with_values:
            return self._answered(name, lambda: self._with_values[name](values))
        return self._answered(name, None if values else self._plain.get(name))

    def _answered(self, name: str, command: Callable[[], None] | None) -> dict[str, Any]:
        """Return a command's result as an answer; an unknown command is refused."""
        refusal = ""
        if command is None:
            refusal = f"expected one of {', '.join(self.names)}, got {name[:60]!a}"
        else:
            try:
                command()
            except (RequestRefusedError, RobotUnavailableError) as reason:
                refusal = str(reason)
        return {"command": name[:60], "ok": not refusal, "message": shortened(refusal)}

    def _start(self) -> None:
        """Resume a paused robot, else clean all; leave a robot alone that goes on by itself."""
        vacuum = self._robot.robot().vacuum
        if vacuum.phase in HELD:
            self._robot.resume()
        elif not goes_on(vacuum):
            self._robot.clean(CleanRequest(fan=self.fan))

    def _clean(self, values: Any) -> None:
        wish = _valid(CleanWish, {"fan": self.fan.value, **values})
        self._robot.clean(request_of(wish))

    def _go_to(self, values: Any) -> None:
        place = _valid(PlaceWish, values)
        self._robot.go_to(place.x, place.y)


def _valid(model: type[_Model], values: Any) -> _Model:
    try:
        return model.model_validate_json(json.dumps(values))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise RequestRefusedError(
            f"{where}: {first['msg']}, got {str(first['input'])[:60]!a}"
        ) from error
