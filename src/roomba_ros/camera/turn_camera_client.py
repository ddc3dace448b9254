"""The picture client on a terminal."""

from __future__ import annotations

import rospy

from roomba.ui.pictures import PictureViewer
from roomba_ros.client.ros_client import RosCamera
from roomba_ros.runtime.node import leave, require_master


def main() -> None:
    """Show pictures until the user leaves."""
    require_master()
    rospy.init_node("turn_camera_client_node", disable_signals=True)
    leave(PictureViewer(RosCamera()).run())
