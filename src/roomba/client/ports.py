"""The ports of this machine at which a robot's page and API are looked for."""

from __future__ import annotations

from typing import Final

DEFAULT_PORT: Final = 8400
PORTS: Final = range(DEFAULT_PORT, DEFAULT_PORT + 20)
"""A page takes the first of these that is free, if no other port is wanted."""
