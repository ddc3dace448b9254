"""A page's view and commands of a robot that cleans by its own brain."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Final

from roomba.clean_request import CleanRequest
from roomba.client import view
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.configuration.robot import RobotConfig
from roomba.headless.live.held_stop import HeldStop
from roomba.headless.live.remote.teller import Teller
from roomba.headless.live.remote.view import BY_ITSELF, TAKEN, Failures, remote_home, remote_view
from roomba.headless.live.remote.watch import RemoteWatch
from roomba.headless.live.without_map import WithoutMap
from roomba.robot.remote import RemoteRobot, RemoteWish
from roomba.vocabulary import CleanMode

_KINDS: Final = {
    CleanMode.WHOLE: RemoteWish.CLEAN_HOUSE,
    CleanMode.SPOT: RemoteWish.CLEAN_SPOT,
}


class RemoteClient(WithoutMap):
    """Watches and tells one robot; its methods may be called from any thread.

    The emergency stop is only a request: the robot is told to stop, and told again at each look at
    which it moves, until the stop is released. A robot that is out of reach is not stopped.
    """

    no_map = BY_ITSELF

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
            explores=False,
            drives=False,
            modes=tuple(mode.value for mode in _KINDS),
        )
        self._held, self._not_stopped = "", ""
        self._has_to_stop = False
        self._holding = threading.Lock()
        self._stop = HeldStop(self._put, _hold, _release)
        self._teller = Teller()
        self._watch = RemoteWatch(remote, now, self._stop_where_held)

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in ``folder``, and hold the robot if it was held before.

        To be called before :meth:`start`.
        """
        self._stop.keep_in(folder, self._name, self)

    def start(self) -> None:
        """Look at the robot from now on."""
        self._watch.start()

    def end(self) -> None:
        """Stop looking, and tell nothing but a stop that still waits.

        Without such a stop the robot goes on with what it does.
        """
        self._teller.end()
        self._watch.end()

    @property
    def bin_capacity(self) -> float:
        """What its dust bin takes, g."""
        return self._config.brush.bin_capacity

    @property
    def ending(self) -> str:
        """Why the robot is not looked at any more; empty while it is, and before :meth:`start`."""
        return self._watch.ending

    def limits(self) -> view.PageLimits:
        """Return what may be asked for."""
        return self._limits

    def robot(self) -> view.RobotView:
        """Return what the robot told last."""
        if self.ending:
            raise RobotUnavailableError(f"{self.ending}; start it again")
        watch, state = self._watch, self._watch.state
        lost = watch.lost
        if state is None:
            raise RobotUnavailableError(lost)
        spent = self._now() - self._began
        failures = Failures(lost, self._not_stopped, watch.scan_trouble)
        return remote_view(spent, state, watch.scan, self._held, failures, watch.last)

    def home(self) -> view.HomeView:
        """Return what seldom changes."""
        return self._home

    def layer(self, name: view.LayerName) -> view.GridLayer | None:
        """Return None: the robot tells no map."""

    def clean(self, request: CleanRequest) -> None:
        """Let the robot clean all floor, or a spot where it stands."""
        wish = _KINDS.get(request.mode)
        if wish is None or request.spot is not None:
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
        """End what the robot does, also while another program controls it.

        Raises RequestRefusedError if the robot refuses, RobotUnavailableError if it is not reached:
        then it goes on.
        """
        self._tell(RemoteWish.STOP)

    def locate(self) -> None:
        """Let the robot beep, also while another program controls it."""
        self._tell(RemoteWish.BEEP)

    def empty_bin(self) -> None:
        """Do nothing: the robot does not know how full its bin is; the household keeps count."""

    def emergency_stop(self, reason: str) -> None:
        """Tell the robot to stop now, and again whenever it moves, until :meth:`release`.

        If the disk cannot keep the stop, the reason of the hold says so.
        """
        self._stop.engage(reason)

    def release(self) -> None:
        """Release the emergency stop; raises RequestRefusedError also if the next start holds."""
        self._stop.release()

    def drive(self, linear: float, angular: float) -> None:
        """Refuse it: the robot cannot be driven from here."""
        raise RequestRefusedError(
            "it cannot be driven by hand: its bridge tells nothing of where the floor ends"
        )

    def set_top_speed(self, speed: float) -> None:
        """Refuse it: the robot's own brain decides its speed."""
        raise RequestRefusedError(BY_ITSELF)

    def go_to(self, x: float, y: float) -> None:
        """Refuse it: the robot does not tell its pose."""
        raise RequestRefusedError(BY_ITSELF)

    def hold(self, reason: str) -> None:
        """Tell the robot to stop as soon as possible, and again until it has heard that."""
        with self._holding:
            self._held, self._has_to_stop = reason, True
        self._teller.put(RemoteWish.STOP, self._tell_held_stop)
        self._watch.hurry()

    def let_go(self) -> None:
        """Do not tell the robot to stop any more."""
        with self._holding:
            self._held, self._has_to_stop = "", False
            self._not_stopped = ""

    def _put(self, command: Callable[[RemoteClient], None]) -> Future[None]:
        """Carry out a command at once, in the caller's thread."""
        answer: Future[None] = Future()
        try:
            command(self)
        except RobotUnavailableError as over:
            answer.set_exception(over)
        else:
            answer.set_result(None)
        return answer

    def _require_free(self) -> None:
        """Raise RequestRefusedError if the robot is held or another program controls it."""
        if held := self._held:
            raise RequestRefusedError(f"the emergency stop holds it ({held}); release it first")
        state = self._watch.state
        if state is not None and state.is_taken:
            raise RequestRefusedError(TAKEN)

    def _ask(self, wish: RemoteWish) -> None:
        """Tell a wish, unless the robot is held or taken, now or when the wish's turn comes."""
        self._teller.require_open()
        self._require_free()
        self._tell(wish, self._require_free)

    def _tell(self, wish: RemoteWish, require: Callable[[], None] = lambda: None) -> None:
        def tell() -> None:
            require()
            self._remote.tell(wish)

        self._teller.carry_out(wish, tell)
        self._watch.hurry()

    def _tell_held_stop(self) -> None:
        # Before telling: a hold that comes meanwhile needs one more stop.
        with self._holding:
            self._has_to_stop = False
        try:
            self._remote.tell(RemoteWish.STOP)
        except Exception as error:
            with self._holding:
                if self._held:
                    self._has_to_stop, self._not_stopped = True, str(error)
            raise
        self._not_stopped = ""

    def _stop_where_held(self) -> None:
        if self._has_to_stop or (self._held and self._watch.moves):
            self._teller.carry_out(RemoteWish.STOP, self._tell_held_stop)


def _hold(client: RemoteClient, reason: str) -> None:
    client.hold(reason)


def _release(client: RemoteClient) -> None:
    client.let_go()
