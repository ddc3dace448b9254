"""The file of a smart home: what is refused, and that no message repeats a secret."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from roomba.errors import ConfigError
from roomba.ui.smart_home.settings import read_settings

SECRET = "hunter-2-the-cat"
WHOLE = f"""
mqtt:
  host: broker.home
  user: roomba
  password: {SECRET}
  tls: {{ca: /etc/ca.crt}}
webhook:
  url: https://hooks.home/{SECRET}?x=1
  secret: {SECRET}
  events: [begun, ended]
"""


def written(folder: Path, text: str, mode: int = 0o600) -> Path:
    file = folder / "smart_home.yaml"
    file.write_text(text, "utf-8")
    file.chmod(mode)
    return file


def test_a_whole_file(tmp_path: Path) -> None:
    config = read_settings(written(tmp_path, WHOLE))
    assert config.mqtt is not None
    assert config.webhook is not None
    assert config.mqtt.address == ("broker.home", 8883)
    assert config.mqtt.password is not None
    assert config.mqtt.password.get_secret_value() == SECRET
    assert config.webhook.events == ("begun", "ended")
    assert SECRET not in repr(config)


def test_what_is_left_out_has_defaults(tmp_path: Path) -> None:
    config = read_settings(written(tmp_path, "mqtt: {host: 10.0.0.2}", 0o644))
    assert config.mqtt is not None
    assert config.mqtt.address == ("10.0.0.2", 1883)
    assert config.webhook is None


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o644])
def test_a_secret_that_others_can_read_is_refused(tmp_path: Path, mode: int) -> None:
    with pytest.raises(ConfigError, match=r"mqtt\.password, webhook\.secret.*chmod 600"):
        read_settings(written(tmp_path, WHOLE, mode))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mqtt: {host: a, user: b, password: [hunter-2-the-cat]}", "mqtt.password: .*string"),
        ("mqtt: {host: a, pasword: hunter-2-the-cat}", "mqtt.pasword: "),
        ("mqtt: {host: a, password: hunter-2-the-cat}", "mqtt: expected a user"),
        ("mqtt: {host: a, port: 0}", "mqtt.port: "),
        ("mqtt: {host: a, port: on}", "mqtt.port: expected a number, got true"),
        ("mqtt:\n  host: a\n  hunter-2-the-cat: 1\n  hunter-2-the-cat: 2", "yaml:4: expected each"),
        ("mqtt: {host: a, topics: '#'}", "mqtt.topics: "),
        ("mqtt: {host: a, robot: Two Words}", "mqtt.robot: "),
        ("mqtt: {host: ''}", "mqtt.host: "),
        ("mqtt: {host: a\n password: hunter-2-the-cat: x", "expected YAML.* in line"),
        ("webhook: {url: 'file:///hunter-2-the-cat'}", "webhook.url: expected http"),
        ("webhook: {url: 'http://user:hunter-2-the-cat@a'}", "webhook.url: .*without user"),
        ("webhook: {url: 'http://a/x\\nHost: hunter-2-the-cat'}", "webhook.url: expected http"),
        ("webhook: {url: 'http://a:99999/'}", "webhook.url: expected http"),
        ("webhook: {url: 'http://a', events: [hunter-2-the-cat]}", "webhook.events: expected"),
        ("hunter-2-the-cat", "valid dictionary"),
    ],
)
def test_what_is_wrong_is_told_without_what_came(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(ConfigError, match=told) as raised:
        read_settings(written(tmp_path, text))
    assert SECRET not in str(raised.value)


def test_only_a_short_regular_file_is_read(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="expected a file to read"):
        read_settings(tmp_path / "missing.yaml")
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(ConfigError, match="expected a file"):
        read_settings(tmp_path / "fifo")
    with pytest.raises(ConfigError, match="at most"):
        read_settings(written(tmp_path, "#" * 70_000))
    (tmp_path / "smart_home.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(ConfigError, match="UTF-8"):
        read_settings(tmp_path / "smart_home.yaml")
