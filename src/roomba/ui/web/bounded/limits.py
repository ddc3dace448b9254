"""What the page's server takes at most, so that nothing which reaches it can exhaust it."""

from __future__ import annotations

from typing import Final

MOST_BODY: Final = 65536
"""Bytes of a request's body, and of what comes over a WebSocket at once."""
BODY_WITHIN: Final = 10.0
"""s of wall time within which a whole request must come."""
MOST_CONNECTIONS: Final = 1200
"""Connections at the same time; more are closed at once. Where the system allows fewer open files,
fewer connections are allowed."""
OWN_FILES: Final = 300
"""Files and connections that a process needs for all its other work, such as for other nodes."""
BACKLOG: Final = 256
"""Connections that may wait to be taken, or to be closed because there are too many."""
MOST_LISTENERS: Final = 50
"""Programs that listen to events at the same time."""
SENT_AHEAD: Final = 65536
"""Bytes that the system queues for a slow reader; more would be outdated when they are read."""
UNSENT: Final = 1 << 20
"""Bytes queued for a reader that does not read its answers; beyond that its connection is
closed."""
MOST_FRAGMENTS: Final = 1024
"""Parts of one message over a WebSocket."""
PING: Final = 10.0
"""s of wall time between two pings on a WebSocket, and for the answer to each."""
MOST_GARBAGE: Final = 100
"""Senseless messages in a row after which a WebSocket is closed."""
SERVER_LIMITS: Final = {
    "body_bytes": MOST_BODY,
    "body_seconds": BODY_WITHIN,
    "connections": MOST_CONNECTIONS,
    "event_listeners": MOST_LISTENERS,
    "socket_message_bytes": MOST_BODY,
    "socket_garbage": MOST_GARBAGE,
}
"""The limits by the names that the API uses."""
