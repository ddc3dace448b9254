"""The types of messages in bags of ROS 1 and 2, with this robot's own, which ROS does not have."""

from __future__ import annotations

from typing import Any, Final

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

TRANSFORMS: Final = "tf2_msgs/TFMessage"
OWN_STATE: Final = "roomba_robot/Localization"
_ADDED: Final = {
    TRANSFORMS: "geometry_msgs/TransformStamped[] transforms",
    "roomba_robot/WheelDrop": "std_msgs/Header header\nbool is_left_dropped\nbool is_right_dropped",
    "roomba_robot/RobotPosition": "float32 pos_x\nfloat32 pos_y",
    OWN_STATE: "std_msgs/Header header\nuint8 KNOWN = 0\nuint8 ROUGH = 1\nuint8 SEARCHING = 2\n"
    "uint8 LOST = 3\nuint8 state\nfloat32 position_deviation\nfloat32 heading_deviation\n"
    "float32 agreement\nstring message",
}
"""As in the files of the folder msg, without the comments."""


def full_name(type_: str) -> str:
    """Return the name of a type as rosbags spells it."""
    return type_.replace("/", "/msg/")


def known_types(*, is_first: bool) -> Any:
    """Return a store of rosbags with all types of messages of ROS 1, or else 2."""
    store = get_typestore(Stores.ROS1_NOETIC if is_first else Stores.ROS2_HUMBLE)
    for type_, fields in _ADDED.items():
        if full_name(type_) not in store.types:
            store.register(get_types_from_msg(fields, full_name(type_)))
    return store
