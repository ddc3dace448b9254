"""The topics of one robot at the broker."""

from __future__ import annotations

from dataclasses import dataclass

ONLINE, OFFLINE = "online", "offline"


@dataclass(frozen=True, slots=True)
class MqttTopics:
    """All topics begin with ``base``; Home Assistant's own with ``discovery``."""

    base: str
    discovery: str

    @property
    def available(self) -> str:
        """``online``, or ``offline`` when the robot does not answer, or its program ended."""
        return f"{self.base}/available"

    @property
    def state(self) -> str:
        """State, battery, area and all that sensors show, as JSON."""
        return f"{self.base}/state"

    @property
    def attributes(self) -> str:
        """What seldom changes, as JSON: names of rooms and zones."""
        return f"{self.base}/attributes"

    @property
    def map(self) -> str:
        """The map as PNG, in which Valetudo's map stands as well."""
        return f"{self.base}/map"

    @property
    def map_data(self) -> str:
        """Valetudo's map as JSON, deflated by zlib."""
        return f"{self.base}/map_data"

    @property
    def answer(self) -> str:
        """What came of the last command, as JSON."""
        return f"{self.base}/answer"

    @property
    def command(self) -> str:
        """Takes start, pause, stop, return_to_base, clean_spot, locate."""
        return f"{self.base}/command"

    @property
    def fan_speed(self) -> str:
        """Takes the fan level of the cleans that begin from now on."""
        return f"{self.base}/fan_speed"

    @property
    def send_command(self) -> str:
        """Takes a command by name, or as JSON with what belongs to it."""
        return f"{self.base}/send_command"

    @property
    def birth(self) -> str:
        """Home Assistant says ``online`` when it has started."""
        return f"{self.discovery}/status"

    @property
    def heard(self) -> tuple[str, ...]:
        """What the robot listens to."""
        return self.command, self.fan_speed, self.send_command, self.birth

    def announcement(self, component: str, name: str) -> str:
        """Return where an entity is announced."""
        return f"{self.discovery}/{component}/{name}/config"
