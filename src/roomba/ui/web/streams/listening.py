"""The stream of events for programs: server-sent events over HTTP."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Annotated, Final

from fastapi import APIRouter, Header, HTTPException, Query
from fastapi.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from roomba.ui.web.bounded.limits import MOST_LISTENERS
from roomba.ui.web.streams.events import Events

_EXAMPLE: Final = """id: 7
event: state
data: {"type":"state","at":1760000000.1,"time":63.2,"state":"cleaning","phase":"cleaning",\
"room":"Kitchen","battery":0.93}

id: 8
event: trouble
data: {"type":"trouble","at":1760000009.3,"time":72.4,"message":"the dust bin is full"}

"""
_ABOUT: Final = """Each event has a number (`id`), a name (`event`) and JSON (`data`), in which `at`
is the time of day and `time` that of the robot's clock, s:

- `state`: what it does changed: `state`, `phase`, `room`, `battery`
- `begun`: a run began
- `ended`: a run ended: `outcome`, `message`, `covered`, `wanted`, `missed` …
- `trouble`: what is wrong, in words; empty when all is well again
- `missed`: that many older events (`count`) are not kept any more; `null`: those of a server that
  was started anew since, so that it is not known how many

The stream begins with what comes next, or after the number in `Last-Event-ID` (or `after`); 200
events are kept. Every 15 s of silence an empty line comes."""


class _Listening(StreamingResponse):
    """One listener's stream; it is counted from before its begin until its end."""

    def __init__(self, stream: AsyncIterator[str], listeners: set[object]) -> None:
        super().__init__(stream, media_type="text/event-stream")
        self._listeners = listeners

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if len(self._listeners) >= MOST_LISTENERS:
            raise HTTPException(503, f"expected at most {MOST_LISTENERS} listeners at a time")
        self._listeners.add(self)
        try:
            await super().__call__(scope, receive, send)
        finally:
            self._listeners.discard(self)


def events_api(events: Events) -> APIRouter:
    """Return the route of a robot's events."""
    api = APIRouter(prefix="/api/v1")
    listeners: set[object] = set()

    async def stream(after: int) -> AsyncIterator[str]:
        # Sent at once, so that the program knows that it is listening.
        yield ":\n\n"
        async for text in events.after(after):
            yield text

    @api.get(
        "/events",
        summary="What happens, as it happens",
        description=_ABOUT,
        response_class=StreamingResponse,
        responses={200: {"content": {"text/event-stream": {"example": _EXAMPLE}}}},
    )
    async def listen(
        after: Annotated[int | None, Query(ge=0, le=2**53)] = None,
        last_event_id: Annotated[int | None, Header(ge=0, le=2**53)] = None,
    ) -> StreamingResponse:
        wanted = after if last_event_id is None else last_event_id
        return _Listening(stream(events.newest if wanted is None else wanted), listeners)

    return api
