"""Services of the simulation, by which a person interferes with the home and the robot."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable

import rospy
from roomba_robot.srv import (
    InjectFault,
    InjectFaultRequest,
    InjectFaultResponse,
    SetDoor,
    SetDoorRequest,
    SetDoorResponse,
    SpillDirt,
    SpillDirtRequest,
    SpillDirtResponse,
)
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator

FAULTS = {
    "slip": (Fault.SLIP_LEFT, Fault.SLIP_RIGHT),
    "stall": (Fault.STALL_LEFT, Fault.STALL_RIGHT),
    **{fault.name.lower(): (fault,) for fault in Fault},
}
"""The faults of ``sim/inject_fault`` by name. It also takes names for obstacles, for the battery's
charge, and for putting the robot elsewhere."""


class SimServices:
    """Services: ``sim/spill`` (SpillDirt), ``sim/inject_fault`` (InjectFault: what goes wrong by
    name; ``charge`` sets what is in the battery, ``value`` of 0..1), ``sim/empty_bin``,
    ``sim/replace_bag`` (Trigger), ``sim/set_door`` (SetDoor).
    """

    def __init__(self, simulator: Simulator, lock: threading.Lock) -> None:
        """Connect nothing yet; ``lock`` guards the simulator."""
        self._simulator, self._lock = simulator, lock

    def start(self) -> None:
        """Connect."""
        rospy.Service("sim/spill", SpillDirt, self._on_spill)
        rospy.Service("sim/inject_fault", InjectFault, self._on_fault)
        rospy.Service("sim/empty_bin", Trigger, self._on_empty_bin)
        rospy.Service("sim/replace_bag", Trigger, self._on_replace_bag)
        rospy.Service("sim/set_door", SetDoor, self._on_set_door)

    def _on_spill(self, request: SpillDirtRequest) -> SpillDirtResponse:
        try:
            with self._lock:
                self._simulator.spill(request.x, request.y, request.radius, request.amount)
        except ValueError as error:
            return SpillDirtResponse(False, str(error))
        return SpillDirtResponse(
            True, f"{request.amount:g} g lie around ({request.x:.2f}, {request.y:.2f})"
        )

    def _on_empty_bin(self, _: TriggerRequest) -> TriggerResponse:
        with self._lock:
            taken = self._simulator.empty_bin()
        return TriggerResponse(True, f"{taken:.1f} g were in the bin")

    def _on_replace_bag(self, _: TriggerRequest) -> TriggerResponse:
        station = self._simulator.emptying
        if station is None:
            return TriggerResponse(False, "its station has no bag: it empties no bin")
        with self._lock:
            station.replace_bag()
        return TriggerResponse(True, "an empty bag is in the station")

    def _on_set_door(self, request: SetDoorRequest) -> SetDoorResponse:
        try:
            with self._lock:
                self._simulator.set_door(request.name, is_shut=request.shut)
        except ValueError as error:
            return SetDoorResponse(False, str(error))
        done = "shuts as soon as nothing stands in it" if request.shut else "is open"
        return SetDoorResponse(True, f"{request.name} {done}")

    def _on_fault(self, request: InjectFaultRequest) -> InjectFaultResponse:
        others: dict[str, Callable[[InjectFaultRequest], str]] = {
            "obstacle": self._place_obstacle,
            "moved_chair": self._place_chair,
            "no_obstacles": self._remove_obstacles,
            "charge": self._set_charge,
            "put": self._put,
        }
        try:
            with self._lock:
                if request.fault in others:
                    done = others[request.fault](request)
                else:
                    done = self._inject(request, others)
        except (ValueError, HomeError) as error:
            return InjectFaultResponse(False, str(error))
        rospy.loginfo("fault injected: %s", done)
        return InjectFaultResponse(True, done)

    def _inject(self, request: InjectFaultRequest, others: Iterable[str]) -> str:
        if request.fault not in FAULTS:
            known = ", ".join([*FAULTS, *others])
            raise ValueError(f"expected a fault of: {known}; got {request.fault!r}")
        for fault in FAULTS[request.fault]:
            self._simulator.inject(fault, request.value)
        return f"{request.fault} {request.value:g}"

    def _place_obstacle(self, request: InjectFaultRequest) -> str:
        self._simulator.place_obstacle(request.x, request.y, request.value)
        return f"a thing of {request.value:g} m stands at ({request.x:.2f}, {request.y:.2f})"

    def _place_chair(self, request: InjectFaultRequest) -> str:
        self._simulator.place_chair(Pose(request.x, request.y, request.theta))
        return f"a chair that no map shows stands at ({request.x:.2f}, {request.y:.2f})"

    def _remove_obstacles(self, request: InjectFaultRequest) -> str:
        self._simulator.remove_obstacles()
        return "all things that were put down are gone"

    def _set_charge(self, request: InjectFaultRequest) -> str:
        self._simulator.set_charge(request.value)
        return f"the battery's charge is {request.value:.1%}"

    def _put(self, request: InjectFaultRequest) -> str:
        self._simulator.put(Pose(request.x, request.y, request.theta))
        self._simulator.inject(Fault.LIFTED, 0.0)
        return f"the robot stands at ({request.x:.2f}, {request.y:.2f})"
