"""Times, poses, twists, paths, maps and images, as messages and as values."""

from __future__ import annotations

import math
from typing import NamedTuple

import genpy
import numpy as np
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped
from geometry_msgs.msg import Twist as TwistMessage
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from roomba.geometry import Pose, Twist, heading_of
from roomba.grid import COARSEST_CELL, FINEST_CELL, MOST_CELLS, GridFrame, OccupancyMap
from roomba_ros.convert.errors import MessageError, require_finite


def header(now: float, frame_id: str) -> Header:
    """Return a header for a time, s, in a frame."""
    return Header(stamp=stamp_of(now), frame_id=frame_id)


def stamp_of(now: float) -> genpy.Time:
    """Return a time, s, as a stamp, rounded to nanoseconds: ``from_sec`` cuts the rest off.

    A stamp that was read is written as it was.
    """
    seconds, nanoseconds = divmod(round(1e9 * now), 1_000_000_000)
    return genpy.Time(seconds, nanoseconds)


def quaternion_of(theta: float) -> Quaternion:
    """Return the rotation about the vertical by ``theta`` rad."""
    return Quaternion(0.0, 0.0, math.sin(theta / 2.0), math.cos(theta / 2.0))


def theta_of(rotation: Quaternion) -> float:
    """Return the heading, rad, of a rotation of any length; what tilts it is left out."""
    return heading_of(rotation.x, rotation.y, rotation.z, rotation.w)


def pose_of_message(pose: PoseMessage) -> Pose:
    """Return the planar part of a pose; raises MessageError for numbers that are not finite."""
    place, turn = pose.position, pose.orientation
    # The rotation itself, too: of infinite ones some have a heading that is finite.
    theta = theta_of(turn)
    require_finite("a pose", place.x, place.y, turn.x, turn.y, turn.z, turn.w, theta)
    return Pose(place.x, place.y, theta)


def twist_of(message: TwistMessage) -> Twist:
    """Return the planar part of a twist; raises MessageError for numbers that are not finite."""
    require_finite("velocities", message.linear.x, message.angular.z)
    return Twist(message.linear.x, message.angular.z)


def twist_message(twist: Twist) -> TwistMessage:
    """Return a planar twist as a message."""
    message = TwistMessage()
    message.linear.x = twist.linear
    message.angular.z = twist.angular
    return message


def pose_of_odometry(message: Odometry) -> Pose:
    """Return the planar pose of odometry, in its header's frame; raises MessageError."""
    return pose_of_message(message.pose.pose)


def odometry_message(
    now: float, pose: Pose, twist: Twist, frame_id: str, child_frame_id: str
) -> Odometry:
    """Return odometry: ``pose`` in ``frame_id``, ``twist`` in the body's frame."""
    message = Odometry(header=header(now, frame_id), child_frame_id=child_frame_id)
    message.pose.pose = planar_pose_message(pose)
    message.twist.twist = twist_message(twist)
    return message


def pose_of(message: PoseStamped) -> Pose:
    """Return the planar pose of a stamped pose, in its header's frame; raises MessageError."""
    return pose_of_message(message.pose)


def pose_in_map(message: PoseStamped) -> Pose:
    """Return a pose of the map frame; an empty frame means that one, too. Raises MessageError."""
    if message.header.frame_id not in ("", "map"):
        raise MessageError(
            f"expected a pose in the frame 'map', got one in {message.header.frame_id!r}; "
            "transform it first"
        )
    return pose_of(message)


def planar_pose_message(pose: Pose) -> PoseMessage:
    """Return a planar pose as a message without time and frame."""
    message = PoseMessage(orientation=quaternion_of(pose.theta))
    message.position.x, message.position.y = pose.x, pose.y
    return message


def pose_message(now: float, pose: Pose, frame_id: str) -> PoseStamped:
    """Return a planar pose as a message."""
    return PoseStamped(header(now, frame_id), planar_pose_message(pose))


def transform_message(
    now: float, pose: Pose, frame_id: str, child_frame_id: str
) -> TransformStamped:
    """Return where ``child_frame_id`` is in ``frame_id``."""
    message = TransformStamped(header=header(now, frame_id), child_frame_id=child_frame_id)
    message.transform.translation.x = pose.x
    message.transform.translation.y = pose.y
    message.transform.rotation = quaternion_of(pose.theta)
    return message


def mount_message(
    frame_id: str,
    child_frame_id: str,
    place: tuple[float, float, float],
    turns: tuple[float, float, float] = (0.0, 0.0, 0.0),
    now: float = 0.0,
) -> TransformStamped:
    """Return where a part is mounted: ``place`` x, y, z, m; ``turns`` as in a URDF.

    These are about the fixed axes x, y, z, rad, one after the other. ``now`` is for what moves.
    """
    message = TransformStamped(header=header(now, frame_id), child_frame_id=child_frame_id)
    translation = message.transform.translation
    translation.x, translation.y, translation.z = place
    (sx, cx), (sy, cy), (sz, cz) = ((math.sin(a / 2.0), math.cos(a / 2.0)) for a in turns)
    message.transform.rotation = Quaternion(
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
        cx * cy * cz + sx * sy * sz,
    )
    return message


def path_message(now: float, points: NDArray[np.float64], frame_id: str) -> Path:
    """Return a path through ``points``, float64 [n, 2], each pose looking to the next point."""
    message = Path(header=header(now, frame_id))
    ahead = np.diff(points, axis=0, append=points[-1:])
    headings = np.arctan2(ahead[:, 1], ahead[:, 0])
    headings[-1] = headings[-2] if len(headings) > 1 else 0.0
    for (x, y), theta in zip(points.tolist(), headings.tolist(), strict=True):
        message.poses.append(pose_message(now, Pose(x, y, theta), frame_id))
    return message


def path_of(message: Path) -> NDArray[np.float64]:
    """Return the points of a path, float64 [n, 2], in its header's frame.

    Raises MessageError for numbers that are not finite.
    """
    numbers = [at for each in message.poses for at in (each.pose.position.x, each.pose.position.y)]
    require_finite("a path", *numbers)
    return np.array(numbers, np.float64).reshape(-1, 2)


def map_message(
    now: float, known: OccupancyMap, frame_id: str, *, is_growing: bool = False
) -> OccupancyGrid:
    """Return an occupancy map as a message; one that ``is_growing`` has load time 0."""
    message = OccupancyGrid(header=header(now, frame_id))
    if not is_growing:
        message.info.map_load_time = max(message.header.stamp, genpy.Time(0, 1))
    message.info.resolution = known.frame.resolution
    message.info.width = known.frame.columns
    message.info.height = known.frame.rows
    message.info.origin.position.x = known.frame.origin_x
    message.info.origin.position.y = known.frame.origin_y
    message.info.origin.orientation.w = 1.0
    # A list, not the array: genpy serializes arrays twenty times slower.
    message.data = known.values.ravel().tolist()
    return message


def map_of(message: OccupancyGrid) -> OccupancyMap:
    """Return the occupancy map of a message.

    Raises MessageError for a map that is turned, misshapen, empty, or larger than MOST_CELLS.
    """
    info = message.info
    place = (info.resolution, info.origin.position.x, info.origin.position.y)
    if not all(map(math.isfinite, place)) or not FINEST_CELL <= info.resolution <= COARSEST_CELL:
        raise MessageError(
            f"expected a resolution from {FINEST_CELL:g} to {COARSEST_CELL:g} m and a finite "
            f"origin, got {place}"
        )
    if not 0 < info.width * info.height <= MOST_CELLS:
        raise MessageError(
            f"expected a map of 1 to {MOST_CELLS} cells, got {info.width} x {info.height}; "
            "make its cells larger"
        )
    turn = theta_of(info.origin.orientation)
    if not abs(turn) <= 1e-6:
        raise MessageError(f"expected a map without rotation, got one turned by {turn:.4f} rad")
    if len(message.data) != info.width * info.height:
        raise MessageError(
            f"expected {info.width} x {info.height} map values, got {len(message.data)}"
        )
    frame = GridFrame(
        # float32 in the message: 0.05 comes as 0.05000000074.
        round(float(info.resolution), 6),
        info.origin.position.x,
        info.origin.position.y,
        info.height,
        info.width,
    )
    values = np.array(message.data, np.int8).reshape(frame.shape)
    return OccupancyMap(frame, values)


class ToldMap(NamedTuple):
    """A map, and whether it ``was_loaded``: one that is being made never was."""

    occupancy: OccupancyMap
    was_loaded: bool


def told_map_of(message: OccupancyGrid) -> ToldMap:
    """Return the map of a message, and whether it was loaded; raises MessageError as map_of."""
    return ToldMap(map_of(message), not message.info.map_load_time.is_zero())


def image_message(now: float, picture: NDArray[np.uint8], frame_id: str) -> Image:
    """Return a colour picture, uint8 [height, width, 3] RGB, as an rgb8 image."""
    height, width, _ = picture.shape
    return Image(
        header=header(now, frame_id),
        height=height,
        width=width,
        encoding="rgb8",
        is_bigendian=0,
        step=3 * width,
        data=np.ascontiguousarray(picture).tobytes(),
    )


def picture_of(message: Image) -> NDArray[np.uint8]:
    """Return the picture of an rgb8 or bgr8 image, uint8 [height, width, 3] RGB.

    Raises MessageError for another encoding or a size that does not fit.
    """
    if message.encoding not in ("rgb8", "bgr8"):
        raise MessageError(f"expected an rgb8 or bgr8 image, got {message.encoding!r}")
    if len(message.data) != message.step * message.height or message.step < 3 * message.width:
        raise MessageError(
            f"expected {message.height} rows of {message.step} bytes, got {len(message.data)} bytes"
        )
    rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    picture = rows[:, : 3 * message.width].reshape(message.height, message.width, 3)
    return picture[:, :, ::-1].copy() if message.encoding == "bgr8" else picture.copy()
