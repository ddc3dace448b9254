"""The ports of this machine at which a robot's page and API are looked for."""

from __future__ import annotations

from typing import Final

DEFAULT_PORT: Final = 8400
PORTS: Final = range(DEFAULT_PORT, DEFAULT_PORT + 20)
"""A page takes the first of these that is free, if no other port is wanted."""
LAST_PORT: Final = 65535
PAGE_SOCKET: Final = "ROOMBA_PAGE_SOCKET"
"""The variable of the environment with the descriptor of a socket that a page is to be served at:
one of another network, or one that a service was given."""
OUTSIDE_ADDRESS: Final = "ROOMBA_OUTSIDE_ADDRESS"
"""The variable with this machine's address in its network, for a page that cannot see it."""
