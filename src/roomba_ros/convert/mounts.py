"""Static transforms as values, from which the mounts of sensors follow."""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from roomba.perception.matching.mounts import FrameTransform, Mount, Mounts
from roomba_ros.convert.errors import MessageError

__all__ = [
    "FrameTransform",
    "Mount",
    "Mounts",
    "transform_of",
    "transforms_of",
]


def transforms_of(message: TFMessage) -> list[FrameTransform]:
    """Return the transforms of a message; raises MessageError if there is none, or a broken one."""
    if not message.transforms:
        raise MessageError("expected transforms, got none")
    return [transform_of(transform) for transform in message.transforms]


def transform_of(message: TransformStamped) -> FrameTransform:
    """Return a transform.

    Raises MessageError for numbers that are not finite, or a rotation of zeros.
    """
    shift, turn = message.transform.translation, message.transform.rotation
    try:
        return FrameTransform.of(
            message.header.frame_id,
            message.child_frame_id,
            (shift.x, shift.y, shift.z),
            (turn.x, turn.y, turn.z, turn.w),
        )
    except ValueError as error:
        raise MessageError(str(error)) from None
