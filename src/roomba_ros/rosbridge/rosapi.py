"""The services ``/rosapi/…`` by which roslib and roslibpy look about the graph.

They are answered by the bridge itself; there is no such node.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Final

import rosgraph
import rospy

from roomba.client.protocol import RequestRefusedError
from roomba_ros.convert.errors import MessageError
from roomba_ros.plain import details
from roomba_ros.plain.messages import class_of
from roomba_ros.rosbridge.calling import named, service_class
from roomba_ros.rosbridge.graph import (
    master,
    system_state,
    topic_types,
    type_of_service,
    type_of_topic,
)

Plain = dict[str, Any]
PREFIX: Final = "/rosapi/"
_ACTION: Final = "/status"


def is_rosapi(service: str) -> bool:
    """Whether a service is one of these; roslib names them without a slash, too."""
    return _full(service).startswith(PREFIX)


def changes(service: str) -> bool:
    """Whether such a service changes anything."""
    return _full(service) in ("/rosapi/set_param", "/rosapi/delete_param")


def answer(service: str, arguments: Any) -> Plain:
    """Return the answer; raises MessageError, RequestRefusedError or RobotUnavailableError."""
    name = _full(service).removeprefix(PREFIX)
    if name not in SERVICES:
        raise RequestRefusedError(
            f"there is no service {PREFIX}{name}; there are {', '.join(sorted(SERVICES))}"
        )
    ask, expected = SERVICES[name]
    given = named(arguments, list(expected))
    if not isinstance(given, dict):
        raise MessageError(f"expected arguments as an object, got {type(given).__name__}")
    values = [given.get(argument, "") for argument in expected]
    for argument, value in zip(expected, values, strict=True):
        if not isinstance(value, str):
            raise MessageError(f"{argument}: expected a text, got {type(value).__name__}")
    return ask(*values)


def _full(service: str) -> str:
    return f"/{service.lstrip('/')}"


def _topics() -> Plain:
    found = sorted(topic_types().items())
    return {"topics": [name for name, _ in found], "types": [kind for _, kind in found]}


def _topics_and_raw_types() -> Plain:
    told = _topics()
    texts = ["" if kind == "*" else details.full_text(class_of(kind)) for kind in told["types"]]
    return {**told, "typedefs_full_text": texts}


def _topics_for_type(kind: str) -> Plain:
    return {"topics": sorted(name for name, its in topic_types().items() if its == kind)}


def _topic_type(topic: str) -> Plain:
    return {"type": type_of_topic(rospy.resolve_name(topic))}


def _publishers(topic: str) -> Plain:
    return {"publishers": system_state()[0].get(rospy.resolve_name(topic), [])}


def _subscribers(topic: str) -> Plain:
    return {"subscribers": system_state()[1].get(rospy.resolve_name(topic), [])}


def _message_details(kind: str) -> Plain:
    return {"typedefs": details.details_of(class_of(kind))}


def _action_servers() -> Plain:
    """Return the names of actions: those with a status topic."""
    of_goals = (
        name
        for name, kind in topic_types().items()
        if kind == "actionlib_msgs/GoalStatusArray" and name.endswith(_ACTION)
    )
    return {"action_servers": sorted(name.removesuffix(_ACTION) for name in of_goals)}


def _services() -> Plain:
    return {"services": sorted(system_state()[2])}


def _services_for_type(kind: str) -> Plain:
    return {"services": [name for name in _services()["services"] if type_of_service(name) == kind]}


def _service_type(service: str) -> Plain:
    return {"type": type_of_service(rospy.resolve_name(service))}


def _service_node(service: str) -> Plain:
    nodes = system_state()[2].get(rospy.resolve_name(service), [])
    return {"node": nodes[0] if nodes else ""}


def _request_details(kind: str) -> Plain:
    return {"typedefs": details.details_of(service_class(kind)._request_class)}


def _response_details(kind: str) -> Plain:
    return {"typedefs": details.details_of(service_class(kind)._response_class)}


def _nodes() -> Plain:
    parts = system_state()
    return {"nodes": sorted({node for part in parts for nodes in part.values() for node in nodes})}


def _node_details(node: str) -> Plain:
    names = [
        sorted(name for name, nodes in part.items() if node in nodes) for part in system_state()
    ]
    return dict(zip(("publishing", "subscribing", "services"), names, strict=True))


def _get_param(name: str, default: str) -> Plain:
    try:
        value = master().getParam(rospy.resolve_name(name))
    except rosgraph.MasterError:
        return {"value": default or "null"}
    return {"value": json.dumps(value)}


def _has_param(name: str) -> Plain:
    return {"exists": bool(master().hasParam(rospy.resolve_name(name)))}


def _get_param_names() -> Plain:
    return {"names": sorted(master().getParamNames())}


def _set_param(name: str, value: str) -> Plain:
    try:
        parsed = json.loads(value)
    except ValueError as error:
        raise MessageError(f"value: expected JSON, got {value[:80]!r}") from error
    if parsed is None:
        raise MessageError("value: expected a value, got null; delete the parameter instead")
    master().setParam(rospy.resolve_name(name), parsed)
    return {}


def _delete_param(name: str) -> Plain:
    try:
        master().deleteParam(rospy.resolve_name(name))
    except rosgraph.MasterError as error:
        raise RequestRefusedError(f"there is no parameter {name}") from error
    return {}


def _get_time() -> Plain:
    return details.time_now(rospy.get_rostime())


SERVICES: Final[dict[str, tuple[Callable[..., Plain], tuple[str, ...]]]] = {
    "topics": (_topics, ()),
    "topics_and_raw_types": (_topics_and_raw_types, ()),
    "topics_for_type": (_topics_for_type, ("type",)),
    "topic_type": (_topic_type, ("topic",)),
    "publishers": (_publishers, ("topic",)),
    "subscribers": (_subscribers, ("topic",)),
    "message_details": (_message_details, ("type",)),
    "action_servers": (_action_servers, ()),
    "services": (_services, ()),
    "services_for_type": (_services_for_type, ("type",)),
    "service_type": (_service_type, ("service",)),
    "service_node": (_service_node, ("service",)),
    "service_request_details": (_request_details, ("type",)),
    "service_response_details": (_response_details, ("type",)),
    "nodes": (_nodes, ()),
    "node_details": (_node_details, ("node",)),
    "get_param": (_get_param, ("name", "default")),
    "has_param": (_has_param, ("name",)),
    "get_param_names": (_get_param_names, ()),
    "set_param": (_set_param, ("name", "value")),
    "delete_param": (_delete_param, ("name",)),
    "get_time": (_get_time, ()),
}
