"""What the bridge gives to programs at most."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

MOST_PROGRAMS: Final = 100
"""At the same time."""
MOST_SUBSCRIPTIONS: Final = 100
"""Topics that one program hears."""
MOST_ADVERTISED: Final = 50
"""Topics that one program publishes."""
MOST_CALLS: Final = 8
"""Services that one program waits for at the same time; all together four times that."""
MOST_WAITING: Final = 20
"""Messages of a topic that wait for a program; of more the oldest are left out."""
MOST_WAITING_BYTES: Final = 1 << 20
"""Bytes of them; the newest waits however long it is."""
LONGEST_ID: Final = 500
"""Characters of the id of an operation."""
CALL_WITHIN: Final = 16.0
"""s of wall time within which a call has an answer, or none."""
HEARD_WITHIN: Final = 1.0
"""s of wall time that a first message waits until those are connected who subscribe."""
BRIDGE_LIMITS: Final[Mapping[str, int]] = {
    "programs": MOST_PROGRAMS,
    "subscriptions": MOST_SUBSCRIPTIONS,
    "advertised": MOST_ADVERTISED,
    "calls_at_a_time": MOST_CALLS,
    "queue_length": MOST_WAITING,
}
"""The same by the names under which the API publishes them."""
