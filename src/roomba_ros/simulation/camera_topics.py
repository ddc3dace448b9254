"""The camera's topics and its service: pictures of what the robot sees, while subscribed."""

from __future__ import annotations

import math
import threading
import time

import rospy
from roomba_robot.srv import TurnCamera, TurnCameraRequest, TurnCameraResponse
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from roomba.configuration.sensors import CameraConfig
from roomba.errors import RoombaError
from roomba.world.camera.camera import Camera, Scene
from roomba.world.simulator import Simulator
from roomba_ros.convert.common import image_message
from roomba_ros.convert.sensors import camera_info_message, compressed_message, depth_message
from roomba_ros.runtime.node import frame_id, told_to_end


class CameraTopics:
    """Takes pictures in a thread of its own: pictures must not hold up the simulated clock.

    Publishes, 5 Hz of wall time while subscribed: ``camera/image_raw`` (rgb8),
    ``camera/image_raw/compressed`` (JPEG), ``camera/depth/image_raw`` (32FC1, m),
    ``camera/camera_info`` and ``camera/depth/camera_info``, looking straight ahead.
    Services: ``camera/capture`` (TurnCamera: a smooth picture, exactly at the angle; its frame is
    that of the camera looking ahead).
    """

    def __init__(
        self, simulator: Simulator, config: CameraConfig, period: float, lock: threading.Lock
    ) -> None:
        """Connect; a picture each ``period`` s of wall time; ``lock`` guards the simulator."""
        self._period = period
        self._simulator, self._config, self._lock = simulator, config, lock
        self._scene = Scene.of(simulator.home)
        self._camera = Camera(self._scene, config)
        self._quick: Camera | None = None
        self._camera_lock = threading.Lock()
        self._stamp = 0.0
        self._lens = frame_id("camera_optical")
        self._image = rospy.Publisher("camera/image_raw", Image, queue_size=1)
        self._compressed = rospy.Publisher(
            "camera/image_raw/compressed", CompressedImage, queue_size=1
        )
        self._depth = rospy.Publisher("camera/depth/image_raw", Image, queue_size=1)
        self._infos = [
            rospy.Publisher(name, CameraInfo, queue_size=1)
            for name in ("camera/camera_info", "camera/depth/camera_info")
        ]
        rospy.Service("camera/capture", TurnCamera, self._on_capture)
        threading.Thread(target=self._stream, name="camera", daemon=True).start()

    def set_time(self, now: float) -> None:
        """Take the time, s, that the simulation has reached."""
        self._stamp = now

    def _stream(self) -> None:
        while not told_to_end():
            time.sleep(self._period)
            pictures = self._image, self._compressed, self._depth
            if any(publisher.get_num_connections() for publisher in (*pictures, *self._infos)):
                try:
                    self._tell()
                except (RoombaError, rospy.ROSException) as error:
                    rospy.logwarn_throttle(10.0, "no picture for the stream: %s", error)

    def _tell(self) -> None:
        # Made for the first subscriber, since it needs some megabytes.
        self._quick = self._quick or Camera(self._scene, self._config, 1)
        with self._lock:
            now, pose = self._stamp, self._simulator.pose
            self._place(self._quick)
        dirt = self._simulator.dirt
        picture = self._quick.render(pose, 0.0, dirt.micrograms, dirt.frame)
        if self._image.get_num_connections():
            self._image.publish(image_message(now, picture.colour, self._lens))
        if self._compressed.get_num_connections():
            self._compressed.publish(compressed_message(now, picture.colour, self._lens))
        if self._depth.get_num_connections():
            self._depth.publish(depth_message(now, picture.depth, self._lens))
        info = camera_info_message(now, self._config, self._quick.focal, self._lens)
        for publisher in self._infos:
            publisher.publish(info)

    def _place(self, camera: Camera) -> None:
        """Move the camera's scene to where things are now."""
        camera.place_all(self._simulator.things, self._simulator.discs)

    def _on_capture(self, request: TurnCameraRequest) -> TurnCameraResponse:
        angle, most = request.turn_degrees, self._config.max_pan
        if not abs(angle) <= most:
            raise rospy.ServiceException(
                f"expected an angle from {-most:g} to {most:g} degrees, got {angle:g}"
            )
        dirt = self._simulator.dirt
        with self._camera_lock:
            with self._lock:
                now, pose = self._stamp, self._simulator.pose
                self._place(self._camera)
            picture = self._camera.picture(pose, math.radians(angle), dirt.micrograms, dirt.frame)
            return TurnCameraResponse(image_message(now, picture, self._lens))
