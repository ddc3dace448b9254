"""A thread that keeps looks at a robot, so that the program need not wait for the disk."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from queue import SimpleQueue
from typing import Final

from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.history.recorder import HistoryKeeper

_AHEAD: Final = 600
"""Looks that may wait for the disk: at ten in a second a minute of them."""
_ENDS_WITHIN: Final = 5.0
"""s that the disk gets for what waits at the end."""

_Layers = Mapping[LayerName, GridLayer]


class KeepingThread:
    """Shows a keeper each look, in their order, from :meth:`start` to :meth:`stop`."""

    def __init__(self, keeper: HistoryKeeper) -> None:
        """Begin with nothing to keep."""
        self._keeper = keeper
        self._looks: SimpleQueue[tuple[RobotView, HomeView, _Layers] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin."""
        self._thread = threading.Thread(target=self._keep, name="history", daemon=True)
        self._thread.start()

    def look(self, view: RobotView, home: HomeView, layers: _Layers) -> None:
        """Have a look kept, with the layers as they were then; returns at once."""
        if self._looks.qsize() < _AHEAD:
            self._looks.put((view, home, layers))
        else:
            self._keeper.tell("the disk is too slow for the history: some of a run is not kept")

    def stop(self) -> None:
        """End once all is kept, within some seconds; what is not kept by then is told."""
        self._looks.put(None)
        if self._thread is not None:
            self._thread.join(_ENDS_WITHIN)
            if self._thread.is_alive():
                self._keeper.tell("the disk is too slow for the history: its end is not kept")

    def _keep(self) -> None:
        while (seen := self._looks.get()) is not None:
            view, home, layers = seen
            self._keeper.look(view, home, layers.get)
