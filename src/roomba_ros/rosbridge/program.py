"""One program that speaks rosbridge: what it says becomes calls, topics and answers."""

from __future__ import annotations

import asyncio
import json
import xmlrpc.client
from collections.abc import Awaitable, Callable
from typing import Any, Final
from xml.parsers.expat import ExpatError

import genpy
import rosgraph.names
import rospy
from fastapi import WebSocket

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.ui.web.bounded.limits import MOST_GARBAGE
from roomba.ui.web.guard import Guard
from roomba.ui.web.viewers import SENSELESS
from roomba_ros.convert.errors import MessageError
from roomba_ros.plain.messages import class_of
from roomba_ros.rosbridge import rosapi
from roomba_ros.rosbridge.calling import call
from roomba_ros.rosbridge.graph import type_of_topic
from roomba_ros.rosbridge.limits import (
    CALL_WITHIN,
    LONGEST_ID,
    MOST_ADVERTISED,
    MOST_CALLS,
    MOST_SUBSCRIPTIONS,
)
from roomba_ros.rosbridge.outbox import HearingWish, Listening, Outbox, status_text
from roomba_ros.rosbridge.shared import Shared

_LEVELS: Final = ("none", "error", "warning", "info")
_PRIVATE: Final = ("sensor_msgs/Image", "sensor_msgs/CompressedImage")
"""Types that show a home from inside: they need the token."""
_FAULTS: Final = (
    RequestRefusedError,
    RobotUnavailableError,
    ValueError,  # MessageError is one
    TypeError,
    OverflowError,
    rospy.ROSException,
    genpy.MessageException,
    xmlrpc.client.Error,
    ExpatError,
)
"""Errors by which an operation may fail; the program is told, and the connection goes on."""
_NEEDS_TOKEN: Final = (
    "expected the token of the printed address: ws://…/rosbridge?token=TOKEN, or the operation auth"
)


class SenselessError(MessageError):
    """What the program sent is no operation at all."""


class Program:
    """Speaks with one program."""

    def __init__(
        self, socket: WebSocket, shared: Shared, guard: Guard, *, may_change: bool
    ) -> None:
        """Speak with none yet."""
        self._socket, self._shared, self._guard = socket, shared, guard
        self._may_change = may_change
        self._level = "error"
        self._outbox = Outbox()
        self._names: dict[str, str] = {}
        """Resolved names of topics by those that the program uses."""
        self._advertised: set[str] = set()
        self._calls: set[asyncio.Task[None]] = set()
        self._operations: dict[str, Callable[[dict[str, Any]], Awaitable[None]]] = {
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "publish": self._publish,
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "call_service": self._call_service,
            "auth": self._authenticate,
            "set_level": self._set_level,
        }

    async def tell(self) -> None:
        """Send for ever what the program subscribed to; a slow one gets only the newest."""
        while True:
            for text in await self._outbox.next():
                await self._socket.send_text(text)

    async def listen(self) -> None:
        """Obey the program's operations, until too many messages in a row are none."""
        garbage = 0
        while garbage < MOST_GARBAGE:
            said = await self._socket.receive()
            if said["type"] == "websocket.disconnect":
                return
            try:
                operation = _operation_of(said.get("text"))
                garbage = 0
                await self._do(operation)
            except SenselessError as error:
                garbage += 1
                await self._tell_status("error", str(error))
            # Received messages come here without waiting: give the other programs their turn.
            await asyncio.sleep(0)
        await self._socket.close(SENSELESS, "expected operations of rosbridge as JSON")

    def close(self) -> None:
        """Undo the program's subscriptions, advertisements and calls."""
        for task in self._calls:
            task.cancel()
        for name, listening in self._outbox.topics.items():
            self._shared.topics.leave(self._names[name], listening.offer)
        for name in self._advertised:
            self._shared.publishers.unadvertise(name)
        self._outbox.topics.clear()
        self._advertised.clear()

    async def _do(self, operation: dict[str, Any]) -> None:
        name, identity = operation["op"], operation.get("id")
        does = self._operations.get(name)
        try:
            if does is None:
                raise MessageError(
                    f"expected an operation of {', '.join(self._operations)}, got {name[:80]!r}"
                )
            await does(operation)
        except _FAULTS as error:
            await self._tell_status("error", f"{name[:80]}: {error}", identity)

    async def _tell_status(self, level: str, reason: str, identity: str | None = None) -> None:
        if _LEVELS.index(level) <= _LEVELS.index(self._level):
            await self._socket.send_text(status_text(level, reason, identity))

    async def _authenticate(self, operation: dict[str, Any]) -> None:
        if not self._guard.is_token(_text(operation, "mac")):
            raise RequestRefusedError("expected the token of the printed address as mac")
        self._may_change = True

    async def _set_level(self, operation: dict[str, Any]) -> None:
        level = _text(operation, "level")
        if level not in _LEVELS:
            raise MessageError(f"expected a level of {', '.join(_LEVELS)}, got {level[:80]!r}")
        self._level = level

    def _require_token(self) -> None:
        if not self._may_change:
            raise RequestRefusedError(_NEEDS_TOKEN)

    async def _subscribe(self, operation: dict[str, Any]) -> None:
        name, wish = _text(operation, "topic"), _wish_of(operation)
        kind = await self._kind_of(name, operation)
        if kind in _PRIVATE:
            self._require_token()
        if operation.get("compression", "none") not in (None, "", "none"):
            await self._tell_status(
                "warning",
                f"expected compression none, got {str(operation['compression'])[:80]!r}; "
                "messages come as JSON",
                operation.get("id"),
            )
        listening = self._outbox.topics.get(name)
        if listening is not None:
            listening.wishes[operation.get("id")] = wish
            return
        if len(self._outbox.topics) >= MOST_SUBSCRIPTIONS:
            raise RequestRefusedError(f"expected at most {MOST_SUBSCRIPTIONS} topics")
        listening = Listening(name, self._outbox.wake)
        listening.wishes[operation.get("id")] = wish
        resolved = _resolved(name)
        self._shared.topics.listen(resolved, class_of(kind), listening.offer)
        self._outbox.topics[name], self._names[name] = listening, resolved

    async def _kind_of(self, name: str, operation: dict[str, Any]) -> str:
        """Return the type of a topic, by the graph, else by the program's operation."""
        said = operation.get("type") or ""
        if not isinstance(said, str):
            raise MessageError("type: expected a text")
        there = await self._shared.wait(type_of_topic, _resolved(name))
        if said and there and said != there:
            raise MessageError(f"{name}: expected its type {there}, got {said[:80]}")
        if not (there or said):
            raise MessageError(f"{name}: expected a type, for no node publishes or hears it")
        return there or said

    async def _unsubscribe(self, operation: dict[str, Any]) -> None:
        name = _text(operation, "topic")
        listening = self._outbox.topics.get(name)
        if listening is None:
            return
        if "id" in operation:
            listening.wishes.pop(operation["id"], None)
        if "id" not in operation or not listening.wishes:
            del self._outbox.topics[name]
            self._shared.topics.leave(self._names.pop(name), listening.offer)

    async def _advertise(self, operation: dict[str, Any]) -> None:
        self._require_token()
        name = _resolved(_text(operation, "topic"))
        if name in self._advertised:
            return
        if len(self._advertised) >= MOST_ADVERTISED:
            raise RequestRefusedError(f"expected at most {MOST_ADVERTISED} topics")
        kind = operation.get("type") or ""
        if not isinstance(kind, str):
            raise MessageError("type: expected a text")
        await self._shared.publishers.advertise(
            name, kind, is_latched=operation.get("latch") is True
        )
        self._advertised.add(name)

    async def _publish(self, operation: dict[str, Any]) -> None:
        self._require_token()
        name = _resolved(_text(operation, "topic"))
        if name not in self._advertised:
            await self._advertise({**operation, "latch": False})
        await self._shared.publishers.publish(name, operation.get("msg", {}))

    async def _unadvertise(self, operation: dict[str, Any]) -> None:
        name = _resolved(_text(operation, "topic"))
        if name in self._advertised:
            self._advertised.discard(name)
            self._shared.publishers.unadvertise(name)

    async def _call_service(self, operation: dict[str, Any]) -> None:
        """Begin a call of a service; other operations go on meanwhile."""
        name = _text(operation, "service")
        if len(self._calls) >= MOST_CALLS:
            await self._answer(operation, None, f"expected at most {MOST_CALLS} calls at a time")
            return
        task = asyncio.create_task(self._call(name, operation))
        self._calls.add(task)
        task.add_done_callback(self._calls.discard)

    async def _call(self, name: str, operation: dict[str, Any]) -> None:
        try:
            if rosapi.is_rosapi(name):
                if rosapi.changes(name):
                    self._require_token()
                asked = self._shared.wait(rosapi.answer, name, operation.get("args"))
            else:
                self._require_token()
                asked = self._shared.wait(call, _resolved(name), operation.get("args"))
            values = await asyncio.wait_for(asked, CALL_WITHIN)
        except _FAULTS as error:
            await self._answer(operation, None, str(error))
        except asyncio.TimeoutError:
            await self._answer(operation, None, f"no answer within {CALL_WITHIN:g} s")
        else:
            await self._answer(operation, values, "")

    async def _answer(self, operation: dict[str, Any], values: Any, reason: str) -> None:
        told = {
            "op": "service_response",
            "service": operation["service"],
            "values": reason if values is None else values,
            "result": values is not None,
        }
        if "id" in operation:
            told["id"] = operation["id"]
        await self._socket.send_text(json.dumps(told))


def _operation_of(text: str | None) -> dict[str, Any]:
    """Return what was said; raises SenselessError unless it is an operation."""
    try:
        said = json.loads(text or "")
    except (ValueError, RecursionError):
        said = None
    if not isinstance(said, dict) or not isinstance(said.get("op"), str):
        raise SenselessError('expected a JSON object with "op" in a message of text')
    identity = said.get("id", "")
    if not isinstance(identity, str) or len(identity) > LONGEST_ID:
        raise SenselessError(f"id: expected a text of at most {LONGEST_ID} characters")
    return said


def _text(operation: dict[str, Any], name: str) -> str:
    value = operation.get(name)
    if not isinstance(value, str) or not 0 < len(value) <= LONGEST_ID:
        raise MessageError(f"{name}: expected a text of at most {LONGEST_ID} characters")
    return value


def _resolved(name: str) -> str:
    """Return the whole name of a topic or service; raises MessageError."""
    if not rosgraph.names.is_legal_name(name):
        raise MessageError(f"expected a name of letters, digits, _ and /, got {name[:80]!r}")
    return str(rospy.resolve_name(name))


def _wish_of(operation: dict[str, Any]) -> HearingWish:
    numbers = []
    for name in ("throttle_rate", "queue_length"):
        value = operation.get(name) or 0
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < 1e9:
            raise MessageError(f"{name}: expected a number of 0 or more")
        numbers.append(float(value))
    return HearingWish(1e-3 * numbers[0], int(numbers[1]))
