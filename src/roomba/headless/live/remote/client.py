"""A page's view and commands of a robot that cleans by its own brain."""

from __future__ import annotations

import concurrent.futures
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client import view
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.headless.live.held_stop import HeldStop
from roomba.headless.live.remote.view import BY_ITSELF, TAKEN, remote_home, remote_view
from roomba.robot.remote import RemoteRobot, RemoteState, RemoteWish
from roomba.vocabulary import CleanMode, Phase, RoomWay

_PERIOD: Final = 2.0
"""s between two looks; OpenNeato's bridge keeps a state for so long."""
_SCAN_EACH: Final = 2
"""Looks for one scan, which takes the robot's line for most of a second."""
_DEADLINE: Final = 5.0
"""s that a command may take."""
_ENDING: Final = 10.0
"""s for a look that is under way to end."""
_MOVES: Final = (Phase.CLEANING, Phase.RETURNING)
_KINDS: Final = {
    CleanMode.WHOLE.value: RemoteWish.CLEAN_HOUSE,
    CleanMode.SPOT.value: RemoteWish.CLEAN_SPOT,
}


class RemoteClient:
    """Watches and tells one robot; its methods may be called from any thread.

    The emergency stop is one more request: it tells the robot to stop, and again at each look at
    which it moves, until it is released. A robot that is not reached is not stopped by it.
    """

    def __init__(
        self,
        name: str,
        remote: RemoteRobot,
        config: RobotConfig,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """Ask nothing yet; ``name`` is the robot's, ``config`` has the numbers of its body."""
        self._remote, self._now, self._config = remote, now, config
        self._began = now()
        self._home = remote_home(name, config)
        self._name = name
        self._limits = view.PageLimits(
            config.body.max_speed,
            config.body.max_angular_speed,
            most_passes=1,
            most_zones=0,
            each_room=False,
            modes=tuple(_KINDS),
        )
        self._state: RemoteState | None = None
        self._scan: NDArray[np.float32] = view.NO_POINTS
        self._lost = ""
        self._looks = 0
        self._has_to_stop = False
        self._stop = HeldStop(lambda command: command(self), _hold, _release)
        self._due, self._is_over = threading.Event(), threading.Event()
        self._teller = concurrent.futures.ThreadPoolExecutor(1, "remote wishes")
        self._thread = threading.Thread(target=self._watch, name="remote robot", daemon=True)

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in ``folder``, and hold the robot if it was held before.

        To be called before :meth:`start`.
        """
        self._stop.keep_in(folder, self._name, self)

    def start(self) -> None:
        """Look at the robot from now on."""
        self._thread.start()

    def end(self) -> None:
        """Look no more. The robot goes on with what it does."""
        self._is_over.set()
        self._due.set()
        if self._thread.is_alive():
            self._thread.join(_ENDING)
        self._teller.shutdown(wait=False, cancel_futures=True)

    @property
    def bin_capacity(self) -> float:
        """What its dust bin takes, g."""
        return self._config.brush.bin_capacity

    @property
    def ending(self) -> str:
        """Empty: it is looked at until :meth:`end`."""
        return ""

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""
        return self._limits

    def robot(self) -> view.RobotView:
        """Return what it told last."""
        if self._state is None:
            raise RobotUnavailableError(self._lost or "the robot was not asked yet")
        spent = self._now() - self._began
        return remote_view(spent, self._state, self._scan, self._stop.reason, self._lost)

    def home(self) -> view.HomeView:
        """Return what seldom changes."""
        return self._home

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return None: it tells no map."""

    def clean(self, order: view.CleanOrder) -> None:
        """Let it clean all, or where it stands."""
        wish = _KINDS.get(order.mode)
        if wish is None or order.spot is not None:
            raise RequestRefusedError(BY_ITSELF)
        self._ask(wish)

    def dock(self) -> None:
        """Let it go to its station."""
        self._ask(RemoteWish.DOCK)

    def pause(self) -> None:
        """Let it stand until it is told to go on."""
        self._ask(RemoteWish.PAUSE)

    def resume(self) -> None:
        """Let it go on."""
        self._ask(RemoteWish.RESUME)

    def stop(self) -> None:
        """End what it does; that is never refused here."""
        self._tell(RemoteWish.STOP)

    def locate(self) -> None:
        """Let it beep."""
        self._tell(RemoteWish.BEEP)

    def empty_bin(self) -> None:
        """Do nothing: it does not know how full its bin is, and the household counts."""

    def emergency_stop(self, reason: str) -> None:
        """Tell it to stop, at once and until :meth:`release` wherever it moves, and nothing else.

        A disk that does not keep it is told as part of why it is held.
        """
        self._stop.engage(reason)

    def release(self) -> None:
        """Release the emergency stop; raises RequestRefusedError too where it holds again later."""
        self._stop.release()

    def drive(self, linear: float, angular: float) -> None:
        """Refuse it: it is not driven from here."""
        raise RequestRefusedError(
            "it cannot be driven by hand: its bridge tells nothing of where the floor ends"
        )

    def set_top_speed(self, speed: float) -> None:
        """Refuse it: its own brain says how fast it drives."""
        raise RequestRefusedError(BY_ITSELF)

    def change_rooms(self, rooms: tuple[str, ...], each: tuple[RoomWay, ...] = ()) -> None:
        """Refuse it: there are no rooms."""
        raise RequestRefusedError(BY_ITSELF)

    def explore(self) -> None:
        """Refuse it: it makes no map that is told."""
        raise RequestRefusedError(BY_ITSELF)

    def go_to(self, x: float, y: float) -> None:
        """Refuse it: it does not tell its place."""
        raise RequestRefusedError(BY_ITSELF)

    def empty_at_station(self) -> None:
        """Refuse it: its station does not."""
        raise RequestRefusedError("its station empties no bin: empty it by hand")

    def replace_bag(self) -> None:
        """Refuse it: there is none."""
        raise RequestRefusedError("its station has no bag")

    def put_zone(self, zone: view.ZoneView) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def remove_zone(self, name: str) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def rename_room(self, name: str, new_name: str) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def join_rooms(self, names: tuple[str, ...]) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def split_room(self, name: str, start: view.Point, end: view.Point) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def undo_rooms(self) -> None:
        """Refuse it."""
        raise RequestRefusedError(BY_ITSELF)

    def hold(self) -> None:
        """Tell it to stop as soon as it can be told, and again at the next look."""
        self._has_to_stop = True
        self._teller.submit(self._remote.tell, RemoteWish.STOP)
        self._due.set()

    def let_go(self) -> None:
        """Tell it to stop no more."""
        self._has_to_stop = False

    def _ask(self, wish: RemoteWish) -> None:
        """Tell it, unless it is held or another program has it."""
        if self._stop.reason:
            raise RequestRefusedError(
                f"the emergency stop holds it ({self._stop.reason}); release it first"
            )
        if self._state is not None and self._state.is_taken:
            raise RequestRefusedError(TAKEN)
        self._tell(wish)

    def _tell(self, wish: RemoteWish) -> None:
        telling = self._teller.submit(self._remote.tell, wish)
        try:
            telling.result(_DEADLINE)
        except concurrent.futures.TimeoutError as error:
            raise RobotUnavailableError(
                f"expected the robot to {wish.value} within {_DEADLINE:g} s, got no answer"
            ) from error
        except RoombaError as error:
            raise RequestRefusedError(str(error)) from error
        self._due.set()

    def _watch(self) -> None:
        while not self._is_over.is_set():
            self._due.clear()
            try:
                self._stop_where_held()
                self._look()
                self._lost = ""
            except RoombaError as error:
                self._lost = str(error)
            self._due.wait(_PERIOD)

    def _look(self) -> None:
        self._state = state = self._remote.look()
        self._looks += 1
        if state.phase not in _MOVES:
            self._scan = view.NO_POINTS
        elif self._looks % _SCAN_EACH == 0:
            self._scan = self._remote.scan()

    def _stop_where_held(self) -> None:
        moves = self._state is not None and self._state.phase in _MOVES
        if self._has_to_stop or (self._stop.reason and moves):
            self._remote.tell(RemoteWish.STOP)
            self._has_to_stop = False


def _hold(client: RemoteClient, _reason: str) -> None:
    client.hold()


def _release(client: RemoteClient) -> None:
    client.let_go()
