"""Services of the graph, called for programs."""

from __future__ import annotations

from typing import Any

import roslib.message
import rospy

from roomba.client.protocol import RequestRefusedError
from roomba_ros.convert.errors import MessageError
from roomba_ros.plain.messages import fill, plain_of, require_generated
from roomba_ros.rosbridge.graph import type_of_service
from roomba_ros.runtime.calls import call_service


def service_class(kind: str) -> Any:
    """Return the class of a service's type; raises MessageError."""
    require_generated(kind, "srv")
    return roslib.message.get_service_class(kind)


def call(name: str, arguments: Any) -> dict[str, Any]:
    """Return the answer of a service to arguments by name, or in order.

    Raises MessageError for arguments that do not fit, RequestRefusedError with the sentence of the
    service, RobotUnavailableError when it does not answer in time.
    """
    kind = type_of_service(name)
    if not kind:
        raise RequestRefusedError(f"there is no service {name}")
    found = service_class(kind)
    request = found._request_class()
    fill(request, named(arguments, request.__slots__), rospy.get_rostime())
    return plain_of(call_service(rospy.ServiceProxy(name, found), request))


def named(arguments: Any, names: list[str]) -> Any:
    """Return arguments by name; a list has them in order. Raises MessageError."""
    if not isinstance(arguments, list):
        return {} if arguments is None else arguments
    if len(arguments) > len(names):
        raise MessageError(f"expected at most {len(names)} arguments, got {len(arguments)}")
    return dict(zip(names, arguments, strict=False))
