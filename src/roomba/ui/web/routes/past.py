"""The history on the page: its runs as JSON, reports as documents, and each run again."""

from __future__ import annotations

import asyncio
import contextlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from fastapi import APIRouter, FastAPI, HTTPException, Query
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from roomba.client.observed import ObservedRobot
from roomba.client.plain import known
from roomba.errors import RoombaError
from roomba.history.database import History
from roomba.history.replay import RecordedRobot
from roomba.history.report.document import comparison_of, report_of
from roomba.history.run import RunRecording
from roomba.history.run_rows import Choice, KeptRun

REPORT_POLICY: Final = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
"""What a report may do: it has its style inside, pictures as data, and no scripts."""
_MOST_RUNS: Final = 500
_LONGEST: Final = 200
"""Characters of a name that is asked for."""
_PROGRAM: Final = "of this program: play, run, sim or campaign; else of all but campaigns"
_BEFORE: Final = "older than the run of this number, which the list before ended with"
_MOST_OPEN: Final = 4
"""Runs that are played at the same time."""
_NUMBERED: Final = re.compile(r"/([0-9]{1,19})(/|$)")
_Value = TypeVar("_Value")


def history_api(history: History) -> APIRouter:
    """Return the routes of a history."""
    api = APIRouter(prefix="/api/v1/history")

    def asked(ask: Callable[[], _Value]) -> _Value:
        """Return the history's answer; its error is 404 with the error's sentence."""
        try:
            return ask()
        except RoombaError as refusal:
            raise HTTPException(404, _sentence(refusal, history)) from refusal

    @api.get("", summary="The runs, the newest first, and totals by week")
    def runs(
        limit: int = Query(default=_MOST_RUNS, ge=1, le=_MOST_RUNS),
        program: str | None = Query(default=None, description=_PROGRAM, max_length=_LONGEST),
        home: str | None = Query(default=None, description="of this home", max_length=_LONGEST),
        before: int | None = Query(default=None, description=_BEFORE, ge=1, le=2**53),
    ) -> dict[str, Any]:
        choice = Choice(home, program, campaigns=program is not None)
        found = asked(lambda: history.chosen(choice, limit + 1, before))
        weeks = asked(lambda: history.weeks(choice))
        return {
            "runs": [_run_values(run) for run in found[:limit]],
            "has_older": len(found) > limit,
            "weeks": [{name: getattr(week, name) for name in week.__slots__} for week in weeks],
        }

    @api.get("/compare.html", summary="Two runs in one report", response_class=HTMLResponse)
    def compare(one: int, other: int) -> HTMLResponse:
        first, second = asked(lambda: (_whole(history, one), _whole(history, other)))
        return _document(comparison_of(first, second))

    @api.get("/{number}/report.html", summary="The report of a run", response_class=HTMLResponse)
    def report(number: int) -> HTMLResponse:
        run, recording = asked(lambda: _whole(history, number))
        others = asked(lambda: history.runs(home=run.figures.source.home))
        return _document(report_of(run, recording, others))

    return api


def _run_values(run: KeptRun) -> dict[str, Any]:
    figures = run.figures
    numbers = ("covered", "wanted", "fraction", "duration", "distance", "dirt", "energy")
    return {
        "number": run.number,
        "began": figures.began,
        "program": figures.source.program,
        "home": figures.source.home,
        "kind": figures.kind,
        "outcome": figures.outcome,
        "message": figures.message,
        **{name: known(getattr(figures, name)) for name in numbers},
        "rate": figures.rate,
        "missed": len(figures.missed),
        "is_recorded": bool(run.is_recorded),
    }


def _whole(history: History, number: int) -> tuple[KeptRun, RunRecording | None]:
    run = history.run(number)
    return run, history.recording(number) if run.is_recorded else None


def _document(text: str) -> HTMLResponse:
    return HTMLResponse(text, headers={"content-security-policy": REPORT_POLICY})


def _sentence(refusal: RoombaError, history: History) -> str:
    """Return the history's sentence without its folder: pages need not know that."""
    told = str(refusal).removeprefix(f"{history.path}: ")
    return told.replace(str(history.path.parent), "the history's folder")


class _AllWatchedError(RoombaError):
    """No further run can be opened: all places are taken by runs in use."""


@dataclass(slots=True)
class _OpenRun:
    """A run that is played, with the number of its requests and viewers now."""

    app: ASGIApp
    life: contextlib.AsyncExitStack
    users: int = 0


class Replays:
    """Serves ``/NUMBER/…``: each opened run has its page as an application of its own."""

    def __init__(self, history: History, app_of: Callable[[ObservedRobot], FastAPI]) -> None:
        """Open nothing yet; ``app_of`` makes the application for a recorded robot."""
        self._history, self._app_of = history, app_of
        self._open: dict[int, _OpenRun] = {}
        # Runs are opened one at a time: none twice, and other work keeps its threads.
        self._opening = asyncio.Lock()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on to the run that it names."""
        root = scope.get("root_path", "")
        named = _NUMBERED.match(scope["path"].removeprefix(root))
        if named is None:
            await JSONResponse({"detail": "expected /replay/NUMBER/"}, 404)(scope, receive, send)
        elif not named[2]:
            await RedirectResponse(f"{scope['path']}/")(scope, receive, send)
        else:
            try:
                run = await self._opened(int(named[1]))
            except RoombaError as refusal:
                await self._refusal(refusal)(scope, receive, send)
                return
            run.users += 1
            try:
                await run.app({**scope, "root_path": f"{root}/{named[1]}"}, receive, send)
            finally:
                run.users -= 1

    def _refusal(self, refusal: RoombaError) -> JSONResponse:
        status = 503 if isinstance(refusal, _AllWatchedError) else 404
        return JSONResponse({"detail": _sentence(refusal, self._history)}, status)

    async def _opened(self, number: int) -> _OpenRun:
        if number not in self._open:
            async with self._opening:
                if number not in self._open:
                    # In a thread: the history may wait for a disk, or for another program.
                    app = await asyncio.to_thread(self._app, number)
                    await self._make_room()
                    life = contextlib.AsyncExitStack()
                    await life.enter_async_context(app.router.lifespan_context(app))
                    self._open[number] = _OpenRun(app, life)
        return self._open[number]

    def _app(self, number: int) -> FastAPI:
        """Return the application of a run; raises RoombaError for one that cannot be played."""
        run = self._history.run(number)
        return self._app_of(RecordedRobot(run.figures, self._history.recording(number)))

    async def _make_room(self) -> None:
        """Close the oldest run that is not in use, unless there is room."""
        if len(self._open) < _MOST_OPEN:
            return
        unused = next((number for number, run in self._open.items() if not run.users), None)
        if unused is None:
            raise _AllWatchedError(
                f"expected at most {_MOST_OPEN} recorded runs that are watched at a time; close "
                "the page of one of them, and try again"
            )
        await self._open.pop(unused).life.aclose()

    async def end(self) -> None:
        """Close all."""
        for run in self._open.values():
            await run.life.aclose()
        self._open.clear()
