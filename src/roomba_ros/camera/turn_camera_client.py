"""The picture client on a terminal."""

from __future__ import annotations

from roomba.ui.pictures import PictureViewer
from roomba_ros.client.ros_client import RosCamera
from roomba_ros.runtime.joining import join_graph
from roomba_ros.runtime.node import leave, require_master


def main() -> None:
    """Show pictures until the user leaves."""
    require_master()
    join_graph("turn_camera_client_node")
    leave(PictureViewer(RosCamera()).run())
