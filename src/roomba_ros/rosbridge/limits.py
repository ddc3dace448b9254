"""The bridge's limits: the most that it gives to programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

MOST_PROGRAMS: Final = 100
"""Programs that are connected at the same time."""
MOST_SUBSCRIPTIONS: Final = 100
"""Topics that one program hears."""
MOST_ADVERTISED: Final = 50
"""Topics that one program publishes."""
MOST_CALLS: Final = 8
"""Calls of services that one program waits for at the same time; all programs: four times that."""
MOST_WAITING: Final = 20
"""Messages of a topic that wait for a program; beyond that the oldest are dropped."""
MOST_WAITING_BYTES: Final = 1 << 20
"""Bytes of the messages that wait; the newest one waits even if it is larger."""
LONGEST_ID: Final = 500
"""Characters of the id of an operation."""
CALL_WITHIN: Final = 16.0
"""s of wall time within which a call ends, with or without an answer."""
HEARD_WITHIN: Final = 1.0
"""s of wall time that the first message waits for the topic's subscribers to connect."""
BRIDGE_LIMITS: Final[Mapping[str, int]] = {
    "programs": MOST_PROGRAMS,
    "subscriptions": MOST_SUBSCRIPTIONS,
    "advertised": MOST_ADVERTISED,
    "calls_at_a_time": MOST_CALLS,
    "queue_length": MOST_WAITING,
}
"""The limits by the names that the API uses."""
