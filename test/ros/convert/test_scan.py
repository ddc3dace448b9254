"""Scans become ranges and the lidar that they are of, or are refused."""

import math
from typing import Any

import numpy as np
import pytest
from fixtures.nodes.malformed import filled, scan
from geometry_msgs.msg import Quaternion, TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from rospy import Time
from tf2_msgs.msg import TFMessage

from roomba.geometry import Pose
from roomba_ros.convert.common import mount_message
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.mounts import Mount, Mounts, transform_of, transforms_of
from roomba_ros.convert.scan import ScanDecoder

BAD = (math.nan, math.inf, -math.inf)


def decoder(*transforms: TransformStamped) -> ScanDecoder:
    mounts = Mounts()
    mounts.add(map(transform_of, transforms))
    return ScanDecoder.on_robot(mounts, "base_link")


def ends(decoder: ScanDecoder, message: Any) -> NDArray[np.float64]:
    """Return where the beams of a scan end, robot's frame, float64 [n, 2], m."""
    decoded = decoder.decode(message)
    return decoded.lidar.view(decoded.ranges).ends[:, :2]


def quarter(ranges: int = 3) -> Any:
    """Return a scan of beams ahead, to the left, behind …, each 2 m long."""
    message = scan(ranges)
    message.angle_increment, message.ranges = 0.5 * math.pi, [2.0] * ranges
    message.header.frame_id, message.header.stamp = "laser", Time(7, 250_000_000)
    return message


def test_a_scan_is_ranges_at_a_time_and_where_its_beams_go() -> None:
    decoded = decoder().decode(quarter())
    assert decoded.stamp == 7.25
    assert decoded.ranges.dtype == np.float32
    assert decoded.ranges.tolist() == [2.0, 2.0, 2.0]
    assert ends(decoder(), quarter()) == pytest.approx(
        np.array([[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0]]), abs=1e-6
    )


def test_the_mount_is_that_of_the_chain_of_frames() -> None:
    plate = mount_message("base_link", "plate", (0.1, 0.0, 0.2))
    laser = mount_message("plate", "laser", (0.0, 0.3, 0.0))
    eighth = 0.25 * math.pi
    laser.transform.rotation = Quaternion(0.0, 0.0, math.sin(eighth), math.cos(eighth))
    assert ends(decoder(plate, laser), quarter(1)) == pytest.approx(
        np.array([[0.1, 2.3]]), abs=1e-6
    )


def test_beams_of_a_lidar_upside_down_go_clockwise() -> None:
    laser = mount_message("base_link", "laser", (0.0, 0.0, 0.1))
    laser.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    assert ends(decoder(laser), quarter(2)) == pytest.approx(
        np.array([[2.0, 0.0], [0.0, -2.0]]), abs=1e-6
    )


def test_the_model_is_made_anew_only_when_the_geometry_changes() -> None:
    mounts = Mounts()
    own = ScanDecoder.on_robot(mounts, "base_link")
    first = own.decode(quarter()).lidar
    again = quarter()
    again.ranges = [1.0, math.inf, 3.0]
    assert own.decode(again).lidar is first
    others = [quarter(4), quarter(), quarter(), quarter(), quarter()]
    others[1].angle_min = 0.1
    others[2].angle_increment = 0.2
    others[3].range_max = 5.0
    others[4].range_min = 0.2
    for message in others:
        lidar = own.decode(message).lidar
        assert lidar is not first
        assert own.decode(message).lidar is lidar
    before = own.decode(quarter()).lidar
    mounts.add([transform_of(mount_message("base_link", "laser", (0.2, 0.0, 0.0)))])
    assert own.decode(quarter()).lidar is not before


@given(
    st.lists(st.one_of(st.floats(width=32), st.floats(0.25, 7.0, width=32)), min_size=1, max_size=9)
)
def test_a_range_that_is_no_number_met_nothing(ranges: list[float]) -> None:
    message = scan(len(ranges))
    message.ranges = ranges
    decoded = decoder().decode(message)
    view = decoded.lidar.view(decoded.ranges)
    assert len(view) == sum(bool(0.1 <= np.float32(at) < 8.0) for at in ranges)
    assert np.isfinite(view.ends).all()


@pytest.mark.parametrize("number", BAD)
def test_angles_and_limits_that_are_no_numbers_are_refused(number: float) -> None:
    with pytest.raises(MessageError, match="expected finite angles"):
        decoder().decode(filled("sensor_msgs/LaserScan", number))
    for field in ("angle_min", "angle_increment"):
        message = scan(4)
        setattr(message, field, number)
        with pytest.raises(MessageError, match="expected finite angles"):
            decoder().decode(message)
    message = scan(4)
    message.range_min = number
    with pytest.raises(MessageError, match="expected ranges from 0 m"):
        decoder().decode(message)


@pytest.mark.parametrize(("nearest", "farthest"), [(0.1, math.nan), (-0.1, 8.0), (8.0, 0.1)])
def test_limits_that_leave_no_range_are_refused(nearest: float, farthest: float) -> None:
    message = scan(4)
    message.range_min, message.range_max = nearest, farthest
    with pytest.raises(MessageError, match="up to a larger one"):
        decoder().decode(message)


def test_scans_of_the_wrong_size_are_refused() -> None:
    with pytest.raises(MessageError, match=r"expected a scan with beams, .* got 0"):
        decoder().decode(scan(0))
    with pytest.raises(MessageError, match="expected 4 intensities, as there are ranges, got 3"):
        decoder().decode(scan(4, 3))
    assert len(decoder().decode(scan(4, 4)).ranges) == 4
    message = scan(4)
    message.angle_increment = 0.0
    with pytest.raises(MessageError, match="each at another angle"):
        decoder().decode(message)


def test_scans_in_other_units_are_refused() -> None:
    degrees = scan(180)
    degrees.angle_min, degrees.angle_increment = -90.0, 1.0
    with pytest.raises(MessageError, match="are the angles in degrees"):
        decoder().decode(degrees)
    millimetres = scan(40)
    millimetres.ranges, millimetres.range_max = np.linspace(1500.0, 2500.0, 40).tolist(), 8000.0
    with pytest.raises(MessageError, match="are they in mm"):
        decoder().decode(millimetres)


@pytest.mark.parametrize("number", BAD)
@pytest.mark.parametrize("field", ["translation.x", "translation.z", "rotation.y", "rotation.w"])
def test_transforms_with_numbers_that_are_not_finite_are_refused(field: str, number: float) -> None:
    good, bad = (mount_message("base_link", name, (0.0, 0.0, 0.1)) for name in ("laser", "imu"))
    part, name = field.split(".")
    setattr(getattr(bad.transform, part), name, number)
    with pytest.raises(MessageError, match="a transform of 'imu' of finite numbers"):
        transforms_of(TFMessage([good, bad]))


def test_transforms_without_rotation_and_no_transforms_are_refused() -> None:
    none = mount_message("base_link", "laser", (0.0, 0.0, 0.1))
    none.transform.rotation = Quaternion()
    with pytest.raises(MessageError, match="a rotation of 'laser', got a quaternion of zeros"):
        transform_of(none)
    with pytest.raises(MessageError, match="expected transforms, got none"):
        transforms_of(TFMessage())


def test_a_frame_of_another_tree_is_not_on_the_robot() -> None:
    mounts = Mounts()
    mounts.add([transform_of(mount_message("/base_link", "/laser", (0.2, 0.1, 0.3)))])
    assert mounts.mount("base_link", "laser") == Mount(Pose(0.2, 0.1, 0.0))
    assert mounts.mount("base_link", "camera") is None
    mounts.add([transform_of(mount_message("base_link", "camera", (0.1, 0.0, 0.2)))])
    assert mounts.mount("base_link", "camera") == Mount(Pose(0.1, 0.0, 0.0))
    mounts.add([transform_of(mount_message("base_link", "camera", (0.3, 0.0, 0.2)))])
    assert mounts.mount("base_link", "camera") == Mount(Pose(0.3, 0.0, 0.0))
