"""A server that takes connections and answers nothing is not waited for."""

from __future__ import annotations

import socket
import xmlrpc.client

import pytest

from roomba.client.xml_rpc import ImpatientTransport


def test_an_answer_that_does_not_come_is_given_up() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        uri = f"http://127.0.0.1:{silent.getsockname()[1]}"
        with (
            xmlrpc.client.ServerProxy(uri, transport=ImpatientTransport(0.02)) as server,
            pytest.raises(TimeoutError),
        ):
            server.getPid("/menu")
