"""What the page's server takes at most, so that nothing which reaches it can exhaust it."""

from __future__ import annotations

from typing import Final

MOST_BODY: Final = 65536
"""Bytes of a request's body, and of what comes over a WebSocket at once."""
BODY_WITHIN: Final = 10.0
"""s of wall time until a request must have come whole."""
MOST_CONNECTIONS: Final = 1200
"""At the same time; more are closed at once, and fewer stay where the system allows fewer files."""
OWN_FILES: Final = 300
"""Files and connections that a process needs for all else, such as those to other nodes."""
BACKLOG: Final = 256
"""Connections that may wait to be taken, or to be closed because there are too many."""
MOST_LISTENERS: Final = 50
"""Programs that listen to events at the same time."""
SENT_AHEAD: Final = 65536
"""Bytes that wait in the system for a slow reader: more would be a queue of what is out of date."""
UNSENT: Final = 1 << 20
"""Bytes that wait for a reader which lets the server answer and does not read: it is closed."""
MOST_FRAGMENTS: Final = 1024
"""Parts of one message over a WebSocket."""
PING: Final = 10.0
"""s of wall time between two signs of life that a WebSocket is asked for, and for its answer."""
MOST_GARBAGE: Final = 100
"""Messages in a row that mean nothing; then a WebSocket is closed."""
SERVER_LIMITS: Final = {
    "body_bytes": MOST_BODY,
    "body_seconds": BODY_WITHIN,
    "connections": MOST_CONNECTIONS,
    "event_listeners": MOST_LISTENERS,
    "socket_message_bytes": MOST_BODY,
    "socket_garbage": MOST_GARBAGE,
}
"""The same by the names under which the API publishes them."""
