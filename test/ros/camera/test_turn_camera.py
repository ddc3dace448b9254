import math
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cv2
import numpy as np
import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import promised, wait_until
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from roomba_robot.srv import TurnCamera, TurnCameraRequest, TurnCameraResponse
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image

ANGLES = (-30, -15, 0, 15, 30)


def picture(value: int) -> NDArray[np.uint8]:
    return np.full((768, 1024, 3), value, np.uint8)


def start(graph: RosGraph, folder: Path) -> rospy.ServiceProxy:
    graph.rosrun("turn_camera_service.py", f"_picture_folder:={folder}")
    service = rospy.ServiceProxy("/turn_camera", TurnCamera)
    service.wait_for_service(60.0)
    return service


def offer_camera() -> list[float]:
    """Be the robot's camera; return the list of angles that it is asked for."""
    asked: list[float] = []

    def capture(request: TurnCameraRequest) -> TurnCameraResponse:
        asked.append(request.turn_degrees)
        shade = picture(100 + int(request.turn_degrees))
        return TurnCameraResponse(
            Image(height=768, width=1024, encoding="rgb8", step=3072, data=shade.tobytes())
        )

    rospy.Service("/camera/capture", TurnCamera, capture)
    return asked


def test_it_takes_a_picture_when_there_is_none_and_keeps_it(
    graph: RosGraph, tmp_path: Path
) -> None:
    Probe(graph)
    asked = offer_camera()
    service = start(graph, tmp_path / "Images")
    for wish, angle in ((0.0, 0), (-90.0, -30), (8.0, 15), (22.4, 15), (22.6, 30)):
        image = service(wish).image
        assert (image.width, image.height, image.encoding) == (1024, 768, "rgb8")
        assert set(image.data) == {100 + angle}
        assert cv2.imread(str(tmp_path / "Images" / f"{angle}.png")).shape == (768, 1024, 3)
    assert asked == [0.0, -30.0, 15.0, 30.0]


class Journey:
    """A robot whose clock is 30 times as fast as real time."""

    def __init__(self, graph: RosGraph) -> None:
        graph.set_param("/use_sim_time", True)
        self._probe = Probe(graph)
        self._now, self._pose = 2.0, PoseStamped()
        self._pose.pose.orientation.w = 1.0
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1, latch=True)
        self._clock.publish(rospy.Time(self._now))

    def goes_on(self, metres: float) -> None:
        """Drive so far in 3 s of its clock, which is when the node looks again."""
        self._now += 3.0
        self._pose.pose.position.x += metres
        self._probe.send("/pose", self._pose)
        self._clock.publish(rospy.Time(self._now))


def test_while_it_travels_it_keeps_the_newest_picture_of_each_angle(
    graph: RosGraph, tmp_path: Path
) -> None:
    """It travels in single leaps: each outdates all pictures once, whenever the node hears it."""
    graph.configure_nodes(pictures={"rest": 0.05})
    journey = Journey(graph)
    asked = offer_camera()
    start(graph, tmp_path / "Images")

    def stands_until(pictures: int) -> None:
        def are_asked_for() -> bool:
            journey.goes_on(0.0)
            return len(asked) >= pictures

        wait_until(are_asked_for, 20.0, lambda: f"{pictures} pictures, not {asked}", pause=0.1)

    journey.goes_on(1.0)
    stands_until(5)
    journey.goes_on(1.0)
    stands_until(10)
    assert {path.name for path in (tmp_path / "Images").glob("*.png")} == {
        f"{angle}.png" for angle in ANGLES
    }
    for _ in range(20):
        journey.goes_on(0.0)
        time.sleep(0.05)  # a minute of its clock, at a pace at which the node looks each time
    # A picture that was taken meanwhile comes before those of a third leap.
    journey.goes_on(1.0)
    stands_until(15)
    assert asked == [float(angle) for angle in 3 * ANGLES]


def test_on_a_fast_clock_it_takes_no_more_than_one_a_second(
    graph: RosGraph, tmp_path: Path
) -> None:
    journey = Journey(graph)
    asked = offer_camera()
    start(graph, tmp_path / "Images")
    began = time.monotonic()

    def has_travelled() -> bool:
        journey.goes_on(1.0)
        return len(asked) > 6

    wait_until(has_travelled, 30.0, "two pictures more than the first of each angle", pause=0.1)
    assert len(asked) <= 5 + (time.monotonic() - began)


def test_what_is_no_angle_is_an_error_of_the_service(graph: RosGraph, tmp_path: Path) -> None:
    """An angle that is not finite, or far too large, is refused with what was expected."""
    Probe(graph)
    offer_camera()
    service = start(graph, tmp_path)
    for wrong in (math.nan, math.inf, -math.inf, 1e30):
        with pytest.raises(rospy.ServiceException, match="expected an angle"):
            service(wrong)


def test_without_a_camera_the_last_good_picture_counts_and_what_is_missing_is_named(
    graph: RosGraph, tmp_path: Path
) -> None:
    """The good one outlived a crash; there is nothing to replace a bad one by."""
    Probe(graph)
    (tmp_path / "15.png").write_bytes(b"not a picture")
    cv2.imwrite(str(tmp_path / "30.png"), picture(77))
    (tmp_path / ".30.png.unfinished-0").write_bytes(b"half a pic")
    start(graph, tmp_path)
    # At once: for each the camera is waited for.
    with ThreadPoolExecutor() as calls:
        answers = {
            angle: calls.submit(rospy.ServiceProxy("/turn_camera", TurnCamera), angle)
            for angle in (0.0, 15.0, 30.0)
        }
    assert set(answers[30.0].result().image.data) == {77}
    for angle, words in ((0.0, r"/0\.png: no picture yet"), (15.0, "/15.png: expected a PNG")):
        with pytest.raises(rospy.ServiceException, match=words):
            answers[angle].result()


def test_a_corrupt_picture_is_taken_again(graph: RosGraph, tmp_path: Path) -> None:
    Probe(graph)
    asked = offer_camera()
    service = start(graph, tmp_path)
    service(-15.0)
    (tmp_path / "-15.png").write_bytes(b"")
    assert set(service(-15.0).image.data) == {85}
    assert asked == [-15.0, -15.0]


def test_the_client_without_a_service_says_so_in_time(graph: RosGraph) -> None:
    """Within 5 s the client ends with an error."""
    client = graph.rosrun("turn_camera_client.py")
    client.says("Enter the angle: ", 30.0)
    client.type("0")
    promised(lambda: client.status is not None, 5.0, "it has ended")
    assert client.status != 0
    assert "no service /turn_camera answers within 4 s" in client.output


def test_the_client_asks_again_for_what_is_no_number_and_ends(
    graph: RosGraph, tmp_path: Path
) -> None:
    """A wrong entry ends neither the client nor in an endless loop; q ends it."""
    Probe(graph)
    offer_camera()
    start(graph, tmp_path / "Images")
    no_screen = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    client = graph.rosrun("turn_camera_client.py", environment=no_screen, inside=tmp_path)
    client.says("Enter the angle: ", 30.0)
    client.type("abc")
    client.type("12")
    wait_until(lambda: client.output.count("Enter the angle: ") >= 3, 30.0)
    client.type("q")
    assert client.ends(30.0) == 0
    assert client.output.count("\n") < 20
    assert len(list(tmp_path.glob("roomba_camera_*.png"))) == 1


def test_the_client_ends_with_its_input(graph: RosGraph) -> None:
    client = graph.rosrun("turn_camera_client.py")
    client.says("Enter the angle: ", 30.0)
    client.end_of_input()
    assert client.ends(30.0) == 0
