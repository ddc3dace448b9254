"""Tells a robot wishes, one after another, in a thread of its own."""

from __future__ import annotations

import concurrent.futures
import threading
from collections.abc import Callable
from typing import Final

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.errors import RoombaError
from roomba.robot.remote import RemoteWish, WishRefusedError

_DEADLINE: Final = 5.0
"""s that a wish may take, its wait for earlier wishes included."""
_ENDING: Final = 10.0
"""s that :meth:`Teller.end` waits for stops: for a request under way, and for their own."""
_OVER: Final = "the robot is not told anything any more: the program ends; start it again"


class Teller:
    """Tells wishes in the order in which they came; its methods may be called from any thread."""

    def __init__(self) -> None:
        """Tell nothing yet."""
        self._line = concurrent.futures.ThreadPoolExecutor(1, "remote wishes")
        self._lock = threading.Lock()
        self._waiting: dict[concurrent.futures.Future[None], RemoteWish] = {}
        self._is_over = False

    def put(self, wish: RemoteWish, tell: Callable[[], None]) -> concurrent.futures.Future[None]:
        """Let ``tell`` tell a wish after those that wait; returns at once.

        Raises RobotUnavailableError after :meth:`end`.
        """
        with self._lock:
            self.require_open()
            telling = self._line.submit(tell)
            self._waiting[telling] = wish
        telling.add_done_callback(self._forget)
        return telling

    def require_open(self) -> None:
        """Raise RobotUnavailableError after :meth:`end`."""
        if self._is_over:
            raise RobotUnavailableError(_OVER)

    def carry_out(self, wish: RemoteWish, tell: Callable[[], None]) -> None:
        """Let ``tell`` tell a wish, and wait until it is told.

        Raises RequestRefusedError if the robot refuses the wish, RobotUnavailableError if the robot
        is not reached in time: a wish that still waits then is left undone.
        """
        telling = self.put(wish, tell)
        try:
            telling.result(_DEADLINE)
        except concurrent.futures.TimeoutError as error:
            left = "it is left undone" if telling.cancel() else "it may still do so"
            raise RobotUnavailableError(
                f"expected the robot to {wish.value} within {_DEADLINE:g} s, got no answer: {left}"
            ) from error
        except concurrent.futures.CancelledError as error:
            raise RobotUnavailableError(_OVER) from error
        except WishRefusedError as error:
            raise RequestRefusedError(str(error)) from error
        except (RequestRefusedError, RobotUnavailableError):
            raise
        except RoombaError as error:
            raise RobotUnavailableError(str(error)) from error

    def end(self) -> None:
        """Tell nothing more but the stops that wait already; wait for these, with a deadline."""
        with self._lock:
            self._is_over = True
            waiting = dict(self._waiting)
        for telling, wish in waiting.items():
            if wish is not RemoteWish.STOP:
                telling.cancel()
        self._line.shutdown(wait=False)
        stops = [telling for telling, wish in waiting.items() if wish is RemoteWish.STOP]
        for late in concurrent.futures.wait(stops, _ENDING).not_done:
            late.cancel()

    def _forget(self, telling: concurrent.futures.Future[None]) -> None:
        with self._lock:
            self._waiting.pop(telling, None)
