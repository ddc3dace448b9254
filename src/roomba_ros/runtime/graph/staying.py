"""Keeps a program in the graph when the robot restarts: the new master does not know its nodes.

rospy registers publishers, subscribers and services once. A program that outlives the robot would
hear nothing from then on, without noticing.
"""

from __future__ import annotations

import contextlib
import threading
import time
from typing import Any, Final

import rospy
from rospy.impl import paramserver, registration

from roomba_ros.runtime.graph.master import UNANSWERED, master

_LOOK: Final = 1.0
"""s of wall time between two looks whether the master knows this node."""
_LOG: Final = "/rosout"
"""A topic that every node publishes."""


def stay_in_graph() -> None:
    """From now on, check whether the master knows this node, and register it anew if not."""
    threading.Thread(target=_stay, daemon=True).start()


def _stay() -> None:
    while not rospy.is_shutdown():
        time.sleep(_LOOK)
        # A master that is gone, or hangs, is asked again.
        with contextlib.suppress(*UNANSWERED):
            if not _is_known():
                _register_anew()


def _is_known() -> bool:
    publishers = master(rospy.get_name()).getSystemState()[0]
    return any(rospy.get_name() in nodes for topic, nodes in publishers if topic == _LOG)


def _register_anew() -> None:
    """Register all of this node with the master again, and forget cached parameters."""
    topics: Any = registration.get_topic_manager()
    services: Any = registration.get_service_manager()
    kinds = registration.Registration
    for kind, registered in (
        (kinds.SUB, topics.get_subscriptions()),
        (kinds.SRV, services.get_services()),
        (kinds.PUB, topics.get_publications()),
    ):
        for name, told in registered:
            registration.get_registration_listeners().notify_added(name, told, kind)
    # Parameters are asked for again, and the master then reports their changes again.
    paramserver.get_param_server_cache().set("/", {})
