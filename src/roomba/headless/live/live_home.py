"""What surrounds a live robot besides what it knows: a simulated home, or a real one."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from roomba.client.protocol import RequestRefusedError
from roomba.client.view import GridLayer, TruthView
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

if TYPE_CHECKING:
    from roomba.headless.live.camera import LiveCamera


class LiveHome(Protocol):
    """The home of a live robot. All but its ``name`` is for the robot's thread alone."""

    @property
    def name(self) -> str:
        """The name of the home."""

    @property
    def plan(self) -> Home | None:
        """The home as its files have it, if the robot goes by their map."""

    @property
    def acts(self) -> tuple[str, ...]:
        """What a hand can do there: values of :class:`roomba.client.view.PlayAct`."""

    @property
    def camera(self) -> LiveCamera | None:
        """The robot's camera, if it has one."""

    def truth(self) -> TruthView | None:
        """Return what is really so; None if that is not known."""

    def dirt(self) -> GridLayer | None:
        """Return the dirt that really lies on the floor; None if that is not known."""

    def play(self, act: Callable[[Simulator], None]) -> None:
        """Let a hand reach into the world; raises RequestRefusedError where it is a real one."""

    def empty_bin(self) -> None:
        """Empty the dust bin, if a hand is needed for that here."""


class RealHome:
    """A home of which nothing is known but what the robot tells."""

    plan = None
    acts: tuple[str, ...] = ()
    camera = None

    def __init__(self, name: str) -> None:
        """Name it."""
        self.name = name

    def play(self, act: Callable[[Simulator], None]) -> None:
        """Refuse it: raises RequestRefusedError."""
        raise RequestRefusedError(
            "this home is a real one: what is to be done there is done by hand"
        )

    def truth(self) -> None:
        """Nothing is known."""

    def dirt(self) -> None:
        """Nothing is known."""

    def empty_bin(self) -> None:
        """Do nothing: the person who reports it has emptied the bin."""
