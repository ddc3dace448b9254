"""The HTTP API of a robot's page, for programs that use it from outside."""

from __future__ import annotations

import http.client
import json
import urllib.error
import urllib.request
from http import HTTPStatus
from typing import Any, Final

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError

_PATIENCE: Final = 6.0
"""s of wall time; of a robot that says nothing for 5 s the server itself tells that."""


class PageApi:
    """Asks the server of a page; with its token it may change what the robot does."""

    def __init__(self, address: str, token: str = "", patience: float = _PATIENCE) -> None:
        """Ask nothing yet. ``address`` is as http://HOST:PORT; ``patience`` is in s."""
        self._address, self._token, self._patience = address.rstrip("/"), token, patience
        # Past any proxy: the server is on this machine, or in this network.
        self._opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))

    def get(self, path: str) -> dict[str, Any]:
        """Return what is told at a path below the address; raises as :meth:`send` does."""
        return self._asked(urllib.request.Request(f"{self._address}/{path}"))

    def send(
        self, path: str, values: dict[str, Any] | None = None, method: str = "POST"
    ) -> dict[str, Any]:
        """Send values to a path of the API, and return the answer.

        Raises RequestRefusedError with the server's reason, and RobotUnavailableError if no server
        of a page answers, or if it tells that its robot does not.
        """
        headers = {"Authorization": f"Bearer {self._token}", "Content-Type": "application/json"}
        content = json.dumps(values or {}).encode()
        address = f"{self._address}/api/v1/{path}"
        return self._asked(urllib.request.Request(address, content, headers, method=method))

    def _asked(self, request: urllib.request.Request) -> dict[str, Any]:
        try:
            with self._opener.open(request, timeout=self._patience) as answer:
                told = json.load(answer)
        except urllib.error.HTTPError as refusal:
            is_silent = refusal.code == HTTPStatus.SERVICE_UNAVAILABLE
            raised = RobotUnavailableError if is_silent else RequestRefusedError
            raise raised(_reason_of(refusal)) from refusal
        except (OSError, ValueError, http.client.HTTPException) as error:
            raise RobotUnavailableError(f"the robot cannot be reached: {error}") from error
        if not isinstance(told, dict):
            kind = type(told).__name__
            raise RobotUnavailableError(
                f"the robot cannot be reached: expected an object, got {kind}"
            )
        return told


def _reason_of(refusal: urllib.error.HTTPError) -> str:
    """Return the sentence of the server, or what HTTP says."""
    try:
        return str(json.load(refusal)["detail"])
    except (ValueError, KeyError, TypeError, OSError):
        return str(refusal)
