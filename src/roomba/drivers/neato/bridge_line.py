"""The line of a Neato behind OpenNeato's bridge: commands and answers go by HTTP.

The bridge hands a command on as it is (``POST /api/serial?cmd=…``) and answers with what the robot
said, without the byte that ends it. It does one command at a time and rests for 50 ms after each.
What its other addresses tell may be a second old, and says nothing of where the floor ends, so no
robot is driven by them. A robot behind a bridge that hands no commands on is told to clean by
itself (``bridge_remote``). Source: OpenNeato's user guide and firmware.
"""

from __future__ import annotations

import http.client
import time
from typing import Final
from urllib.parse import quote

from roomba.drivers.line import LineError
from roomba.drivers.neato.bridge_requests import MOST_BYTES, BridgeAddress, gone
from roomba.drivers.neato.conversation import END

_CONNECT_WAIT: Final = 1.0
"""s; in a home network a connection is there at once."""
_BUSY: Final = 503
_LEAST_WAIT: Final = 0.001
"""s; a wait of 0 would be none for connections."""
PATIENCE: Final = 0.5
"""s that an answer may take longer than on a wire: the bridge's rest, what it asks by itself, and
the radio."""
PER_BYTE: Final = 10.0 / 115_200
"""s that each byte of an answer took on the robot's own line before the bridge sent any."""


class BridgeLine:
    """A :class:`roomba.drivers.line.Line` to the robot behind the bridge at an address.

    Each command is a request of its own, so a late answer is never taken for that of another
    command.
    """

    def __init__(self, address: str) -> None:
        """Connect nothing; ``address`` is a name or a number, with a port where it is not 80.

        Raises LineError for another text.
        """
        self._address = BridgeAddress.of(address)
        self._asked: http.client.HTTPConnection | None = None

    def write(self, data: bytes) -> None:
        """Send a command; raises LineError when the bridge is not reached."""
        self.discard()
        command = quote(data.decode("ascii", "replace").strip())
        place = self._address
        asked = http.client.HTTPConnection(place.host, place.port, timeout=_CONNECT_WAIT)
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
        asked.sock.settimeout(max(seconds, _LEAST_WAIT))
        try:
            response = asked.getresponse()
            body = response.read(MOST_BYTES)
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
                "/api/serial; is another program there, or one that hands on no commands? Behind "
                "such a one ./roomba play can tell a robot to clean by itself"
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
        return gone(self._address, error)
