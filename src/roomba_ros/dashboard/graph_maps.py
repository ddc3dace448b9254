"""The saved maps of the running graph's robot, and what it offers to change: for the page."""

from __future__ import annotations

from typing import Any

import rospy
from roomba_robot.srv import ListMaps, NameMap
from std_srvs.srv import Trigger

from roomba.client.observed import MapsView
from roomba.client.protocol import RequestRefusedError
from roomba_ros.runtime.calls import call_service


class GraphMaps:
    """The half of a :class:`roomba.client.observed.MapKeeper` that handles maps, over ROS."""

    def start(self) -> None:
        """Connect."""
        kinds = {
            "map/list": ListMaps,
            "map/save": NameMap,
            "map/load": NameMap,
            "map/remove": NameMap,
            "map/update/accept": Trigger,
            "map/update/refuse": Trigger,
            "map/update/undo": Trigger,
        }
        self._maps = {name: rospy.ServiceProxy(name, kind) for name, kind in kinds.items()}

    def maps(self) -> MapsView:
        """Return the saved maps."""
        answer = call_service(self._maps["map/list"])
        return MapsView(tuple(answer.names), answer.selected)

    def save_map(self, name: str) -> None:
        """Save the map by a name."""
        self._do("map/save", name)

    def load_map(self, name: str) -> None:
        """Go by a saved map."""
        self._do("map/load", name)

    def remove_map(self, name: str) -> None:
        """Forget a saved map."""
        self._do("map/remove", name)

    def change_map(self, *, is_accepted: bool) -> None:
        """Change the map as it is offered, or leave it."""
        self._do("map/update/accept" if is_accepted else "map/update/refuse")

    def undo_change(self) -> None:
        """Take back the change of the map that was accepted last."""
        self._do("map/update/undo")

    def _do(self, name: str, *arguments: Any) -> None:
        answer = call_service(self._maps[name], *arguments)
        if not answer.success:
            raise RequestRefusedError(answer.message)
