"""Access control: only pages of this server are served, and changes need its token.

The server listens on loopback, or where its user opened it. A page of another site in the same
browser can reach it as well, so Host and Origin are checked (DNS rebinding, cross-site requests),
and each request that changes something must carry the token of the printed address.
"""

from __future__ import annotations

import hmac
import ipaddress
import secrets
from dataclasses import dataclass
from typing import Final
from urllib.parse import urlsplit

_TOKEN_BYTES: Final = 24
"""192 bits: no number of guesses finds it, so none are counted."""
LOOPBACK: Final = ("127.0.0.1", "localhost", "::1")


def new_token() -> str:
    """Return a token that cannot be guessed."""
    return secrets.token_urlsafe(_TOKEN_BYTES)


@dataclass
class Guard:
    """Checks requests; ``hosts`` are names by which the server may be called.

    With ``takes_numbers`` any numeric address is allowed, too: the owner of a name can point it at
    this server (DNS rebinding), but not a number.
    """

    token: str
    hosts: tuple[str, ...] = LOOPBACK
    takes_numbers: bool = False

    def is_host(self, host: str | None) -> bool:
        """Whether a request's Host header names this server."""
        if not host:
            return False
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        return name in self.hosts or (self.takes_numbers and _is_number(name))

    def is_origin(self, origin: str | None, host: str | None) -> bool:
        """Whether a request's Origin header, if there is one, is a page of this server."""
        if origin is None:
            return True
        try:
            asked = urlsplit(origin)
        except ValueError:
            return False
        return asked.scheme in ("http", "https") and asked.netloc == host

    def is_token(self, given: str) -> bool:
        """Whether a token is the right one."""
        return hmac.compare_digest(given.encode("utf-8", "surrogatepass"), self.token.encode())


def _is_number(name: str) -> bool:
    """Whether a host is an address in numbers."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
