"""Announces the robot to Home Assistant by MQTT discovery: a device with entities."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from roomba.ui.smart_home.topics import OFFLINE, ONLINE, MqttTopics
from roomba.vocabulary import FanLevel

Json = dict[str, Any]

_FEATURES: Final = (
    "start", "pause", "stop", "return_home", "clean_spot", "locate", "fan_speed", "send_command",
)  # fmt: skip
_SENSORS: Final[dict[str, Json]] = {
    "battery": {"name": "Battery", "device_class": "battery", "unit_of_measurement": "%"},
    "area": {"name": "Area", "unit_of_measurement": "m²", "icon": "mdi:texture-box"},
    "time": {"name": "Time", "device_class": "duration", "unit_of_measurement": "s"},
    "to_go": {"name": "Time to go", "device_class": "duration", "unit_of_measurement": "s"},
    "bin": {"name": "Dust bin", "device_class": "weight", "unit_of_measurement": "g"},
    "bag": {"name": "Bag of its station", "unit_of_measurement": "%"},
    "phase": {"name": "State", "icon": "mdi:robot-vacuum"},
    "room": {"name": "Room", "icon": "mdi:floor-plan"},
    "error": {"name": "Error", "icon": "mdi:alert-circle-outline"},
}
"""By the key of the state that each sensor shows; those with a unit are measurements."""


def announcements(topics: MqttTopics, robot: str, name: str) -> dict[str, Json]:
    """Return retained messages by topic; ``robot`` is the word in ids, ``name`` the shown name."""
    common = {
        "availability_topic": topics.available,
        "payload_available": ONLINE,
        "payload_not_available": OFFLINE,
        "device": {
            "identifiers": [f"roomba_robot_{robot}"],
            "name": name,
            "manufacturer": "roomba_robot",
            "model": "robot vacuum",
        },
        "origin": {"name": "roomba_robot"},
    }
    return {
        topics.announcement(component, own): {
            **entity,
            **common,
            "unique_id": f"roomba_robot_{own}",
            # The id of the entity: the second key is the newer name of the first.
            "object_id": own,
            "default_entity_id": f"{component}.{own}",
        }
        for component, own, entity in _entities(topics, robot)
    }


def _entities(topics: MqttTopics, robot: str) -> Iterator[tuple[str, str, Json]]:
    yield "vacuum", robot, _vacuum(topics)
    for key, entity in _SENSORS.items():
        measured = {"state_class": "measurement"} if "unit_of_measurement" in entity else {}
        template = f"{{{{ value_json.{key} }}}}"
        shown = {"state_topic": topics.state, "value_template": template}
        yield "sensor", f"{robot}_{key}", {**entity, **measured, **shown}
    yield "sensor", f"{robot}_answer", _answer(topics)
    yield "binary_sensor", f"{robot}_bin_full", _bin_full(topics)
    yield "button", f"{robot}_empty_bin", _empty_bin(topics)
    # Valetudo's map card looks for a camera of this name.
    yield "camera", f"{robot}_map_data", {"name": "Map", "topic": topics.map}


def _vacuum(topics: MqttTopics) -> Json:
    return {
        "name": None,
        "supported_features": list(_FEATURES),
        "state_topic": topics.state,
        "json_attributes_topic": topics.attributes,
        "command_topic": topics.command,
        "set_fan_speed_topic": topics.fan_speed,
        "fan_speed_list": [level.value for level in FanLevel],
        "send_command_topic": topics.send_command,
        "payload_start": "start",
        "payload_pause": "pause",
        "payload_stop": "stop",
        "payload_return_to_base": "return_to_base",
        "payload_clean_spot": "clean_spot",
        "payload_locate": "locate",
    }


def _answer(topics: MqttTopics) -> Json:
    return {
        "name": "Answer",
        "icon": "mdi:message-reply-text-outline",
        "entity_category": "diagnostic",
        "state_topic": topics.answer,
        "value_template": "{{ value_json.message or 'ok' }}",
    }


def _bin_full(topics: MqttTopics) -> Json:
    return {
        "name": "Dust bin full",
        "device_class": "problem",
        "state_topic": topics.state,
        "value_template": "{{ 'ON' if value_json.bin_full else 'OFF' }}",
    }


def _empty_bin(topics: MqttTopics) -> Json:
    return {
        "name": "Dust bin was emptied",
        "icon": "mdi:delete-empty",
        "command_topic": topics.send_command,
        "payload_press": "empty_bin",
    }
