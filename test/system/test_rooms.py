"""The rooms of the running robot's map: told, edited, kept."""

import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point
from roomba_robot.msg import RoomArray
from roomba_robot.srv import JoinRooms, RenameRoom, SplitRoom
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

NODE = "position_pub_node"


def names(probe: Probe) -> list[str]:
    return [room.name for room in probe.newest["/rooms"].rooms]


def texts(probe: Probe) -> str:
    told = probe.newest.get("/rooms/markers", MarkerArray())
    return " ".join(marker.text for marker in told.markers)


def test_rooms_are_told_edited_and_kept(robot: RosGraph) -> None:
    probe = Probe(robot)
    probe.hear("/rooms", RoomArray)
    probe.hear("/rooms/markers", MarkerArray)
    wait_until(lambda: "/rooms" in probe.newest, 30.0, "rooms")
    rooms = probe.newest["/rooms"].rooms
    assert [room.name for room in rooms] == [f"Room {number}" for number in range(1, 6)]
    assert all(room.area > 4.0 and len(room.outline.points) >= 4 for room in rooms)

    rename = rospy.ServiceProxy("/rooms/rename", RenameRoom)
    assert rename("Room 1", "living room").success
    refused = rename("Room 7", "cellar")
    assert not refused.success
    assert "'living room'" in refused.message
    wait_until(lambda: "living room" in names(probe), 30.0, "the name is told")
    wait_until(lambda: "living room" in texts(probe), 30.0, "the marker's text")
    assert probe.newest["/rooms/markers"].markers[0].action == Marker.DELETEALL

    anchor = rooms[0].anchor
    ends = Point(anchor.x - 8.0, anchor.y, 0.0), Point(anchor.x + 8.0, anchor.y, 0.0)
    assert rospy.ServiceProxy("/rooms/split", SplitRoom)("living room", *ends).success
    wait_until(lambda: "living room 2" in names(probe), 30.0, "the cut is told")
    undo = rospy.ServiceProxy("/rooms/undo", Trigger)
    assert undo().success
    wait_until(lambda: len(names(probe)) == 5, 30.0, "the room as it was")
    refused = undo()
    assert not refused.success
    assert "there was none" in refused.message
    assert rospy.ServiceProxy("/rooms/split", SplitRoom)("living room", *ends).success
    wait_until(lambda: "living room 2" in names(probe), 30.0, "the cut again")
    # Kept on disk: a node that comes back after it was killed tells the edited rooms.
    probe.newest.pop("/rooms")
    robot.run("rosnode", "kill", f"/{NODE}")
    wait_until(lambda: "/rooms" in probe.newest, 30.0, "rooms of the new node")
    assert {"living room", "living room 2"} <= set(names(probe))

    assert rospy.ServiceProxy("/rooms/join", JoinRooms)(["living room", "living room 2"]).success
    wait_until(lambda: len(names(probe)) == 5, 30.0, "one room again")
    assert rospy.ServiceProxy("/rooms/segment", Trigger)().success
    wait_until(lambda: "Room 1" in names(probe), 30.0, "the first names")
