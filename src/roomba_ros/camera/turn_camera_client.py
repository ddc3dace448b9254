"""The picture client on a terminal."""

from __future__ import annotations

from roomba.ui.pictures import PictureViewer
from roomba_ros.client.ros_client import RosCamera
from roomba_ros.runtime.graph.alone import is_taken
from roomba_ros.runtime.graph.joining import join_graph
from roomba_ros.runtime.node import leave, require_master


def main() -> None:
    """Show pictures until the user leaves."""
    require_master()
    name = "turn_camera_client_node"
    join_graph(name, is_anonymous=is_taken(name))
    leave(PictureViewer(RosCamera()).run())
