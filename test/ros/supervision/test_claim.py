"""A robot is of one run at a time."""

from __future__ import annotations

import socket

import pytest

from roomba.errors import RoombaError
from roomba_ros.supervision.claim import claim_robot

HERE, ELSEWHERE = "http://127.0.0.1:19311", "http://127.0.0.1:19312"


def test_a_robot_is_of_one_run_until_that_ends() -> None:
    with claim_robot(HERE, "/"):
        with pytest.raises(RoombaError, match=f"^expected no such robot on {HERE}, got another"):
            claim_robot(HERE, "/")
        # 127.0.1.1 is what Debian gives the machine's own name.
        for host in ("127.0.0.1", "localhost", "127.0.1.1", socket.gethostname()):
            with pytest.raises(RoombaError, match="got another run on this machine"):
                claim_robot(f"http://{host}:19311/", "/")
        claim_robot(HERE, "/second/").close()
        claim_robot(ELSEWHERE, "/").close()
    claim_robot(HERE, "/").close()


def test_a_kernel_without_an_address_family_has_no_such_address(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    there = (socket.AF_INET, socket.SOCK_STREAM, 6, "", ("192.0.2.1", 19311))
    foreign = (99, socket.SOCK_STREAM, 6, "", ("2001:db8::1", 19311, 0, 0))
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: [foreign, there])
    claim_robot("http://elsewhere:19311", "/").close()
