"""Where OpenNeato's bridge is, and what it answers to one request."""

from __future__ import annotations

import http.client
import time
from dataclasses import dataclass
from typing import Any, Final
from urllib.parse import urlsplit

from roomba.drivers.line import LineError
from roomba.drivers.neato.timed_socket import connected
from roomba.files.plain_json import load_json

MOST_BYTES: Final = 65_536
"""Bytes of an answer; a scan has some 6,000, and as JSON some 20,000."""
_DEADLINE: Final = 4.5
"""s of a whole request; the bridge itself gives the robot 3 s for each command."""
_NO_SUCH_ADDRESS: Final = (http.client.NOT_FOUND, http.client.METHOD_NOT_ALLOWED)
"""What a bridge answers that has no such address."""


@dataclass(frozen=True, slots=True)
class BridgeAddress:
    """A name or a number of the home network, and a port."""

    host: str
    port: int

    @staticmethod
    def of(text: str) -> BridgeAddress:
        """Return the address that is written as a name or a number, with a port where it is not 80.

        Raises LineError for another text.
        """
        try:
            parts = urlsplit(f"//{text}")
            host, port = parts.hostname, parts.port
            (host or "").encode("idna")  # as the system will look for it
        except ValueError:  # and UnicodeError, which is one
            host, port = None, None
        if not host or parts.path or parts.query or "@" in text:
            raise LineError(
                f"expected the address of OpenNeato's bridge, such as neato.local, got {text!r}"
            )
        return BridgeAddress(host, port or http.client.HTTP_PORT)

    def __str__(self) -> str:
        """Return it as people write it."""
        return self.host if self.port == http.client.HTTP_PORT else f"{self.host}:{self.port}"


class MissingError(LineError):
    """The bridge is there, and has no such address."""


class RefusedError(LineError):
    """The bridge is there, and cannot do it now: its robot is silent, or too much waits."""


def gone(address: BridgeAddress, error: Exception) -> LineError:
    """Return the error that says that a bridge is not reached, and what helps."""
    return LineError(
        f"expected OpenNeato's bridge at {address}, got: {error}. Is the robot switched on, and in "
        "this network?"
    )


def request(address: BridgeAddress, method: str, path: str) -> bytes:
    """Send a request to a bridge, and return what it answers, within one deadline for both.

    Raises MissingError where it has no such address, RefusedError with the reason that it tells,
    LineError where it is not reached.
    """
    connection = http.client.HTTPConnection(address.host, address.port)
    try:
        connection.sock = connected(address.host, address.port, time.monotonic() + _DEADLINE)
        connection.request(method, path, headers={"Connection": "close"})
        response = connection.getresponse()
        body = response.read(MOST_BYTES)
    except (OSError, http.client.HTTPException) as error:
        raise gone(address, error) from error
    finally:
        connection.close()
    if response.status in _NO_SUCH_ADDRESS:
        raise MissingError(f"OpenNeato's bridge at {address} has no {path.partition('?')[0]}")
    if response.status != http.client.OK:
        raise RefusedError(
            f"OpenNeato's bridge at {address} answers {path} with status {response.status}: "
            f"{_reason(body)}"
        )
    return body


def json_at(address: BridgeAddress, path: str) -> dict[str, Any]:
    """Request the JSON object at a path.

    Raises as :func:`request`, and LineError for another text.
    """
    try:
        values = load_json(request(address, "GET", path).decode())
    except ValueError:
        values = None
    if not isinstance(values, dict):
        raise LineError(f"expected an object of JSON at {path} of {address}; is that a bridge?")
    return values


def _reason(body: bytes) -> str:
    try:
        return str(load_json(body.decode())["error"])
    except (ValueError, TypeError, KeyError):
        return "no reason is told"
