"""A program of roslibpy as its documents show it: ``with_roslibpy.py ADDRESS``; prints JSON."""

from __future__ import annotations

import json
import queue
import sys
import threading
from collections.abc import Mapping
from typing import Any

import roslibpy
from roslibpy.ros1 import actionlib

WITHIN = 30.0


def main(address: str) -> None:
    """Use all that there is, and print what was told."""
    ros = roslibpy.Ros(address)
    ros.run(timeout=WITHIN)
    told: dict[str, Any] = {
        "topics": ros.get_topics(),
        "type": ros.get_topic_type("/battery"),
        "services": ros.get_services(),
        "service_type": ros.get_service_type("/ask"),
        "nodes": ros.get_nodes(),
        "details": ros.get_message_details("sensor_msgs/BatteryState")["typedefs"][0]["fieldnames"],
        "time": dict(ros.get_time()),
    }
    came: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    battery = roslibpy.Topic(ros, "/battery", "sensor_msgs/BatteryState", throttle_rate=100)
    battery.subscribe(lambda message: came.put(dict(message)))
    told["battery"] = came.get(timeout=WITHIN)
    battery.unsubscribe()
    roslibpy.Topic(ros, "/answer", "std_msgs/String").publish(roslibpy.Message({"data": "hello"}))
    ask = roslibpy.Service(ros, "/ask", "std_srvs/SetBool")
    told["asked"] = dict(ask.call(roslibpy.ServiceRequest({"data": True}), timeout=WITHIN))
    refusals: queue.SimpleQueue[str] = queue.SimpleQueue()
    nowhere = roslibpy.Service(ros, "/nowhere", "std_srvs/Trigger")
    nowhere.call(roslibpy.ServiceRequest(), callback=print, errback=refusals.put)
    told["refused"] = refusals.get(timeout=WITHIN)
    told["parameter"] = ros.get_param("/beside/depth")
    ros.set_param("/beside/told", [1, "two"])
    client = actionlib.ActionClient(ros, "/walk", "roomba_robot/WalkToPointAction")
    goal = actionlib.Goal(client, roslibpy.Message({"destin": {"dest_x": 1.25}}))
    has_come = threading.Event()

    def hear(feedback: Mapping[str, Any]) -> None:
        told["feedback"] = feedback["distance"]
        has_come.set()

    goal.on("feedback", hear)
    goal.send()
    told["result"] = dict(goal.wait(timeout=WITHIN))
    # Two topics: the result may come before the feedback that was published first.
    has_come.wait(WITHIN)
    print(json.dumps(told), flush=True)
    ros.terminate()


if __name__ == "__main__":
    main(sys.argv[1])
