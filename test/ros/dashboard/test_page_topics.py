"""The page shows the same values of the body as the nodes use."""

from __future__ import annotations

from dataclasses import replace

from actionlib_msgs.msg import GoalStatus
from fixtures.nodes.lockstep import Lockstep
from geometry_msgs.msg import Point
from roomba_robot.msg import (
    Carpet,
    CarpetArray,
    EmptyingStation,
    ExploreActionResult,
    ExploreResult,
    LineTrouble,
    Localization,
    LowThing,
    LowThingArray,
    VacuumState,
)
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Float32

from roomba.client.protocol import ErrandOutcome, VacuumSnapshot
from roomba.configuration.robot import RobotConfig
from roomba.vocabulary import EdgeReason, Hindrance, OpenEdge
from roomba_ros.dashboard.page_topics import PageTopics


def test_of_two_nodes_that_tell_of_the_body_the_page_shows_the_first() -> None:
    with Lockstep().installed() as ros:
        shown = PageTopics(RobotConfig())
        shown.start()
        ros.publish("/localization", Localization(state=Localization.LOST, message="up"), "/own")
        ros.publish("/battery_state", BatteryState(current=1.5), "/own")
        ros.publish("/bin_level", Float32(0.5), "/own")
        ros.publish("/emptying_station", EmptyingStation(bag=0.25), "/own")
        doubt, in_bin = shown.doubt, shown.in_bin
        assert doubt
        assert in_bin > 0.0
        assert shown.charges
        for topic, message in (
            ("/localization", Localization()),
            ("/battery_state", BatteryState()),
            ("/bin_level", Float32(0.0)),
            ("/emptying_station", EmptyingStation(bag=0.75)),
        ):
            ros.publish(topic, message, "/other")
        assert shown.bag == 0.25
        assert (shown.doubt, shown.in_bin, shown.charges) == (doubt, in_bin, True)


def test_a_robot_that_cannot_be_reached_says_so_whatever_its_mission_says() -> None:
    told = VacuumSnapshot("cleaning", "cleaning", "no way", "hall", 1.0, 4.0, 0.25, 60.0, 0.5)
    with Lockstep().installed() as ros:
        shown = PageTopics(RobotConfig())
        shown.start()
        assert shown.reached(told) == told
        ros.publish("/line_trouble", LineTrouble(VacuumState.DISOBEYS, "it drives on"))
        assert shown.reached(told) == replace(
            told, message="it drives on", hindrance=Hindrance.DISOBEYS
        )
        ros.publish("/line_trouble", LineTrouble())
        assert shown.reached(told) == told


def test_the_page_shows_the_zones_that_are_offered_as_they_are_told_last() -> None:
    corners = [Point(0.0, 0.0, 0.0), Point(1.0, 0.0, 0.0), Point(1.0, 2.0, 0.0)]
    with Lockstep().installed() as ros:
        shown = PageTopics(RobotConfig())
        shown.start()
        before = shown.home().version
        ros.publish("/low_things", LowThingArray(things=[LowThing(3, corners)]))
        (thing,) = shown.home().low_things
        assert (thing.times, thing.corners) == (3, ((0.0, 0.0), (1.0, 0.0), (1.0, 2.0)))
        assert shown.home().version > before
        ros.publish("/carpets", CarpetArray(carpets=[Carpet(corners)]))
        assert shown.home().felt_carpets == (thing.corners,)
        ros.publish("/low_things", LowThingArray())
        assert shown.home().low_things == ()


def test_the_end_of_an_exploration_is_shown_with_what_was_mapped_and_where_that_ends() -> None:
    with Lockstep().installed() as ros:
        shown = PageTopics(RobotConfig())
        shown.start()
        assert shown.last is None
        ros.publish("/explore/result", explored(GoalStatus.REJECTED))
        assert shown.last is None
        ros.publish("/explore/result", explored(GoalStatus.SUCCEEDED))
        last = shown.last
        assert last is not None
        assert (last.outcome, last.mapped) == (ErrandOutcome.COMPLETED, 34.5)
        assert last.open_edges == (OpenEdge(2.0, 1.0, 3.0, EdgeReason.NO_ECHO),)


def explored(status: int) -> ExploreActionResult:
    """Return the end of an exploration that left the map open in one place."""
    edge = OpenEdgeMessage(2.0, Point(1.0, 3.0, 0.0), OpenEdgeMessage.NO_ECHO, "")
    return ExploreActionResult(
        status=GoalStatus(status=status),
        result=ExploreResult(known=34.5, distance=20.0, duration=60.0, open_edges=[edge]),
    )
