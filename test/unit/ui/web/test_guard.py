"""Only this server's own pages, and only with the token."""

from __future__ import annotations

import pytest

from roomba.ui.web.guard import Guard, new_token


def test_tokens_differ_and_are_long() -> None:
    tokens = {new_token() for _ in range(100)}
    assert len(tokens) == 100
    assert all(len(token) * 6 >= 128 for token in tokens)


@pytest.mark.parametrize(
    ("host", "is_ours"),
    [
        ("127.0.0.1:8400", True),
        ("localhost:8400", True),
        ("[::1]:8400", True),
        ("localhost", True),
        ("evil.example", False),
        ("127.0.0.1.evil.example:8400", False),
        ("localhost@evil.example", False),
        ("", False),
        (None, False),
    ],
)
def test_only_names_of_this_server_are_its_hosts(host: str | None, is_ours: bool) -> None:
    assert Guard("t").is_host(host) is is_ours


@pytest.mark.parametrize(
    ("host", "is_ours"),
    [
        ("192.0.2.7:8400", True),
        ("[fd00::2]:8400", True),
        ("127.0.0.1:8400", True),
        ("192.0.2.7.evil.example:8400", False),
        ("evil.example", False),
        ("", False),
    ],
)
def test_one_that_is_opened_is_called_by_numbers_too(host: str, is_ours: bool) -> None:
    assert Guard("t", takes_numbers=True).is_host(host) is is_ours


@pytest.mark.parametrize(
    ("origin", "is_ours"),
    [
        (None, True),
        ("http://127.0.0.1:8400", True),
        ("http://127.0.0.1:8401", False),
        ("http://evil.example", False),
        ("null", False),
        ("file://127.0.0.1:8400", False),
    ],
)
def test_only_pages_of_this_server_are_its_origins(origin: str | None, is_ours: bool) -> None:
    assert Guard("t").is_origin(origin, "127.0.0.1:8400") is is_ours


def test_wrong_tokens_do_not_keep_the_right_one_out() -> None:
    guard = Guard("right")
    for _ in range(100):
        assert not guard.is_token("wrong")
    assert guard.is_token("right")
