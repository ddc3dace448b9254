"""The named errors of the library.

Each message says what was expected, what came, and what to do about it.
"""

from __future__ import annotations


class RoombaError(Exception):
    """Base of every error that the library raises on purpose."""


class RequestRefusedError(RoombaError):
    """The robot will not do what was asked; the message is its reason."""


class ConfigError(RoombaError):
    """A configuration file or parameter that cannot be used."""


class HomeError(RoombaError):
    """A home's map or layer file that cannot be used; names the file, the line and the reason."""


class PictureError(RoombaError):
    """A picture that cannot be taken, read or written."""


class RoomsError(RoombaError):
    """Rooms that cannot be named, joined, cut or drawn as was asked for."""
