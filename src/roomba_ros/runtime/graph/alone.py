"""Making sure that a node that must be alone is."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from http.client import HTTPException
from xmlrpc.client import Error as XmlRpcError

import rosgraph
import rospy
from rosgraph.names import ns_join

from roomba_ros.runtime.graph.master import master, node_at


def refuse_second(node_name: str, topic: str) -> None:
    """End the process, exit 1, when a living node has this name or publishes ``topic``.

    Call before ``rospy.init_node``: registering a name that is taken ends the node that has it.
    A node that died without saying so does not count.
    """
    namespace = rosgraph.names.get_ros_namespace()
    own = _full_name(node_name)
    watched = rosgraph.names.resolve_name(topic, ns_join(namespace, "node"))
    for rival in living(sorted({own, *_publishers_of(watched)})):
        print(
            f"refused: {rival} already serves {watched} on {rosgraph.get_master_uri()}; two of "
            f"them would drive one robot. End that one first (`rosnode kill {rival}`), or "
            "start this one in a namespace of its own (ROS_NAMESPACE)",
            file=sys.stderr,
        )
        sys.exit(1)


def other_publishers(topic: str) -> list[str]:
    """Return the living nodes besides this one that publish a topic, all by full name."""
    return living(sorted(_publishers_of(topic) - {rospy.get_name()}))


def is_taken(node_name: str) -> bool:
    """Whether a living node has this name: it would end if this process took it too."""
    return bool(living([_full_name(node_name)]))


def living(nodes: Iterable[str]) -> list[str]:
    """Return those of these nodes, by full name, that answer."""
    asked = master()
    return [node for node in nodes if _is_alive(asked, node)]


def _publishers_of(topic: str) -> set[str]:
    publishers = master().getSystemState()[0]
    return {node for name, nodes in publishers if name == topic for node in nodes}


def _full_name(node_name: str) -> str:
    name = rospy.names.get_mappings().get("__name", node_name)
    return str(ns_join(rosgraph.names.get_ros_namespace(), name))


def _is_alive(asked: rosgraph.Master, node: str) -> bool:
    try:
        node_at(asked.lookupNode(node)).getPid(asked.caller_id)
    except (OSError, HTTPException, XmlRpcError, rosgraph.MasterError):
        # Nothing listens there, or another program on a port that was used again.
        return False
    return True
