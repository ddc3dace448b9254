"""XML-RPC that gives up: Python's own waits for an answer without end."""

from __future__ import annotations

from http.client import HTTPConnection
from typing import Any
from xmlrpc.client import Transport


class ImpatientTransport(Transport):
    """A transport that raises TimeoutError when an answer takes too long."""

    def __init__(self, within: float) -> None:
        """Wait for each answer for ``within`` s of wall time."""
        super().__init__()
        self._within = within

    def make_connection(self, host: Any) -> HTTPConnection:
        """Return a connection that gives up."""
        connection = super().make_connection(host)
        connection.timeout = self._within
        return connection
