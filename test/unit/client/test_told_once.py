"""Trouble that lasts is told once."""

from __future__ import annotations

from roomba.client.told_once import ToldOnce


def test_a_text_is_told_once_until_another_one_or_none() -> None:
    said: list[str] = []
    tell = ToldOnce(said.append)
    for text in ("", "full", "full", "slow", "slow", "", "", "slow", "full"):
        tell(text)
    assert said == ["full", "slow", "slow", "full"]
