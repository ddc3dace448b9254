"""The configuration file of a smart home: the broker, the webhook, and secrets that stay secret."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import Annotated, Final
from urllib.parse import urlsplit

import yaml
from pydantic import Field, SecretStr, ValidationError, field_validator, model_validator

from roomba.client.events import EVENT_KINDS
from roomba.configuration.frozen import Frozen, truths_as_numbers
from roomba.errors import ConfigError
from roomba.files.plain_yaml import load_with_nodes
from roomba.files.strict_yaml import repeated_key

Topic = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*$", max_length=60)]
Word = Annotated[str, Field(pattern=r"^[a-z0-9_]+$", max_length=40)]
_LONGEST: Final = 65536
"""Bytes of the file."""


class TlsConfig(Frozen):
    """TLS to the broker, which must prove its name; ``ca`` is a file of who vouches for it, without
    which those of the system do."""

    ca: Path | None = None


class MqttConfig(Frozen):
    """The broker, and the names under which the robot is found there.

    ``robot`` is the word for it in topics and entities, ``name`` what a person reads; Home
    Assistant looks for announcements under ``discovery``. ``state_period`` and ``map_period`` are
    the least s between two messages of state and map.
    """

    host: Annotated[str, Field(min_length=1, max_length=253)]
    port: Annotated[int, Field(ge=1, le=65535)] | None = None
    user: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    password: SecretStr | None = None
    tls: TlsConfig | bool = False
    robot: Word = "roomba"
    name: Annotated[str, Field(min_length=1, max_length=80)] = "Roomba"
    topics: Topic = "roomba"
    discovery: Topic = "homeassistant"
    state_period: Annotated[float, Field(ge=0.2, le=60.0)] = 1.0
    map_period: Annotated[float, Field(ge=1.0, le=600.0)] = 5.0

    @property
    def address(self) -> tuple[str, int]:
        """Host and port, which is 1883, or 8883 with TLS, if none is given."""
        return self.host, self.port or (8883 if self.tls else 1883)

    @model_validator(mode="after")
    def _password_of_a_user(self) -> MqttConfig:
        if self.password is not None and self.user is None:
            raise ValueError("expected a user beside the password")
        return self


class WebhookConfig(Frozen):
    """Where events are posted; ``secret`` signs them. The ``url`` may contain another secret."""

    url: SecretStr
    secret: SecretStr | None = None
    robot: Word = "roomba"
    events: Annotated[tuple[str, ...], Field(min_length=1)] = EVENT_KINDS

    @field_validator("url")
    @classmethod
    def _is_of_the_web(cls, url: SecretStr) -> SecretStr:
        try:
            parts = urlsplit(url.get_secret_value())
            is_usable = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
        except ValueError:
            is_usable = False
        text = url.get_secret_value()
        if not is_usable or not text.isascii() or not text.isprintable() or " " in text:
            raise ValueError("expected http://HOST… or https://HOST…")
        if parts.username is not None or parts.password is not None:
            raise ValueError("expected an address without user and password; sign with a secret")
        return url

    @field_validator("events")
    @classmethod
    def _are_known(cls, events: tuple[str, ...]) -> tuple[str, ...]:
        if not set(events) <= set(EVENT_KINDS):
            raise ValueError(f"expected some of {', '.join(EVENT_KINDS)}")
        return events


class SmartHomeConfig(Frozen):
    """The whole file; a part that is left out is not used."""

    mqtt: MqttConfig | None = None
    webhook: WebhookConfig | None = None

    @property
    def secrets(self) -> list[str]:
        """The places in the file where secrets stand."""
        found = {
            "mqtt.password": self.mqtt and self.mqtt.password,
            "webhook.secret": self.webhook and self.webhook.secret,
        }
        return [where for where, secret in found.items() if secret is not None]


def read_settings(path: Path) -> SmartHomeConfig:
    """Read a file; raises ConfigError, which never repeats what stands in the file.

    A file with a secret must be one of this user, which others cannot read.
    """
    text, found = _read(path)
    try:
        raw, root = load_with_nodes(text)
        if repeated := repeated_key(root):
            where = f"{path}:{repeated.line}"
            raise ConfigError(f"{where}: expected each key once, got one again; remove one")
        config = SmartHomeConfig.model_validate(raw or {})
        for reason in truths_as_numbers(raw, config):
            raise ConfigError(f"{path}: {reason}")
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" in line {mark.line + 1}" if mark is not None else ""
        raise ConfigError(f"{path}: expected YAML, got something else{where}") from None
    except ValidationError as error:
        raise ConfigError(f"{path}: {_reason(error)}") from None
    if config.secrets and (found.st_mode & 0o077 or found.st_uid != os.geteuid()):
        raise ConfigError(
            f"{path}: expected that only you can read it, as it has {', '.join(config.secrets)}; "
            f"got mode {stat.S_IMODE(found.st_mode):04o}. To mend it: chmod 600 {path}"
        )
    return config


def _read(path: Path) -> tuple[str, os.stat_result]:
    """Return the content of a regular file, and its status."""
    try:
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as file:
            found = os.fstat(file.fileno())
            if not stat.S_ISREG(found.st_mode):
                raise ConfigError(f"{path}: expected a file, got something else")
            content = file.read(_LONGEST + 1)
    except OSError as error:
        raise ConfigError(f"{path}: expected a file to read: {error.strerror}") from error
    if len(content) > _LONGEST:
        raise ConfigError(f"{path}: expected at most {_LONGEST} bytes, got more")
    try:
        return content.decode(), found
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: expected UTF-8, got something else") from None


def _reason(error: ValidationError) -> str:
    """Return where the first fault is and what was expected, without the wrong value."""
    first = error.errors(include_input=False, include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in first["loc"])
    return f"{where}: {first['msg'].removeprefix('Value error, ')}" if where else first["msg"]
