"""The line of a Neato that OpenNeato's bridge has: commands and answers go by HTTP.

The bridge hands a command on as it is (``POST /api/serial?cmd=…``) and answers with what the robot
said, without its end. It does one at a time and rests for 50 ms after each. Its other addresses
tell what was so up to a second before, and nothing of where the floor ends: they are not asked.
Source: OpenNeato's user guide and firmware.
"""

from __future__ import annotations

import http.client
import time
from typing import Final
from urllib.parse import quote, urlsplit

from roomba.drivers.line import LineError
from roomba.drivers.neato.conversation import END

_CONNECT: Final = 1.0
"""s; in a home network a connection is there at once."""
_MOST: Final = 65_536
"""Bytes of an answer; a scan has some 6,000."""
_BUSY: Final = 503
_SOONEST: Final = 0.001
"""s; a wait of 0 would be none for connections."""
PATIENCE: Final = 0.5
"""s that an answer may take longer than on a wire: the bridge's rest, what it asks by itself, and
the radio."""
PER_BYTE: Final = 10.0 / 115_200
"""s that each byte of an answer took on the robot's own line before the bridge sent any."""


class BridgeLine:
    """A :class:`roomba.drivers.line.Line` to the robot behind the bridge at an address.

    Each command is a request of its own; what comes after its time is never taken for the answer to
    another one.
    """

    def __init__(self, address: str) -> None:
        """Connect nothing; ``address`` is a name or a number, with a port where it is not 80.

        Raises LineError for one that is none.
        """
        try:
            parts = urlsplit(f"//{address}")
            host, port = parts.hostname, parts.port
        except ValueError:
            host, port = None, None
        if not host or parts.path or parts.query or "@" in address:
            raise LineError(
                f"expected the address of OpenNeato's bridge, such as neato.local, got {address!r}"
            )
        self._address, self._place = address, (host, port or http.client.HTTP_PORT)
        self._asked: http.client.HTTPConnection | None = None

    def write(self, data: bytes) -> None:
        """Send a command; raises LineError when the bridge is not reached."""
        self.discard()
        command = quote(data.decode("ascii", "replace").strip())
        asked = http.client.HTTPConnection(*self._place, timeout=_CONNECT)
        self._asked = asked
        try:
            asked.request("POST", f"/api/serial?cmd={command}")
        except (OSError, http.client.HTTPException) as error:
            raise self._gone(error) from error

    def read(self, seconds: float) -> bytes:
        """Return the answer within ``seconds``, with its end; b"" if none comes."""
        asked = self._asked
        if asked is None or asked.sock is None:
            # Nothing was asked, or it is answered: no more comes.
            time.sleep(max(0.0, seconds))
            return b""
        asked.sock.settimeout(max(seconds, _SOONEST))
        try:
            response = asked.getresponse()
            body = response.read(_MOST)
        except TimeoutError:
            return b""
        except (OSError, http.client.HTTPException) as error:
            raise self._gone(error) from error
        finally:
            self.discard()
        if response.status == _BUSY:
            return b""
        if response.status != http.client.OK:
            raise LineError(
                f"expected OpenNeato's bridge at {self._address}, got status {response.status} of "
                "/api/serial; is another program there, or its firmware an older one?"
            )
        return body if body.endswith(END) else body + END

    def discard(self) -> None:
        """Forget what was asked."""
        asked, self._asked = self._asked, None
        if asked is not None:
            asked.close()

    def close(self) -> None:
        """Let go of the connection."""
        self.discard()

    def _gone(self, error: Exception) -> LineError:
        self.discard()
        return LineError(
            f"expected OpenNeato's bridge at {self._address}, got: {error}. Is the robot switched "
            "on, and in this network?"
        )
