"""Staying in the graph of a robot that is started anew: its new master knows no node from before.

rospy registers what it hears, tells and serves once. A program that goes on over the robot's end
would be deaf from then on, and not say so.
"""

from __future__ import annotations

import contextlib
import threading
import time
from http.client import HTTPException
from typing import Any, Final
from xmlrpc.client import Error as XmlRpcError

import rosgraph
import rospy
from rospy.impl import paramserver, registration

from roomba_ros.runtime.graph.master import master

_LOOK: Final = 1.0
"""s of wall time between two looks whether the master knows this node."""
_LOG: Final = "/rosout"
"""The topic that each node tells."""


def stay_in_graph() -> None:
    """Look from now on whether the master knows this node, and register it anew if not."""
    threading.Thread(target=_stay, daemon=True).start()


def _stay() -> None:
    while not rospy.is_shutdown():
        time.sleep(_LOOK)
        # A master that is gone, or hangs, is asked again.
        with contextlib.suppress(OSError, HTTPException, XmlRpcError, rosgraph.MasterException):
            if not _is_known():
                _register_anew()


def _is_known() -> bool:
    publishers = master(rospy.get_name()).getSystemState()[0]
    return any(rospy.get_name() in nodes for topic, nodes in publishers if topic == _LOG)


def _register_anew() -> None:
    """Tell the master all that this node hears, tells and serves, and ask it for parameters."""
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
    # What is not kept is asked for again, and told when it changes.
    paramserver.get_param_server_cache().set("/", {})
