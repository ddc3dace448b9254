"""Sets the parameters of a run on a master that may have those of an earlier run."""

from __future__ import annotations

from typing import Any, Final

import rosgraph
from rosgraph.names import get_ros_namespace, ns_join

from roomba_ros.runtime.graph.master import master

_CALLER: Final = "/roomba_run"
_LAUNCHED: Final = "robot_launched"
"""The parameter, in the robot's namespace, that lists the names of all that its last run set."""


def set_parameters(parameters: dict[str, Any], run_id: str) -> None:
    """Set the launch file's parameters, and remove those that only the run before set.

    ``parameters`` are by full name. Parameters that people set stay. ``run_id`` is set if the
    master has none yet.
    """
    asked = master(_CALLER)
    if not asked.hasParam("/run_id"):
        asked.setParam("/run_id", run_id)
    launched = ns_join(get_ros_namespace(), _LAUNCHED)
    _remove_last_run(asked, launched, parameters)
    # The list comes first: an interrupted start may have set any of them.
    asked.setParam(launched, sorted(parameters))
    for name, value in parameters.items():
        asked.setParam(name, value)


def _remove_last_run(asked: rosgraph.Master, launched: str, parameters: dict[str, Any]) -> None:
    names = asked.getParam(launched) if asked.hasParam(launched) else []
    for name in names if isinstance(names, list) else []:
        if name not in parameters and asked.hasParam(name):
            asked.deleteParam(name)
