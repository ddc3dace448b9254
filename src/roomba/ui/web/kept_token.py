"""The token of the page's server, kept over restarts so that open pages stay valid."""

from __future__ import annotations

from pathlib import Path

from roomba.client.token import read_token, token_file
from roomba.files.atomic import write_whole
from roomba.ui.web.guard import new_token


def kept_token(path: Path | None = None) -> str:
    """Return this user's token, and make it if there is none.

    A token that other users could read, or of a wrong form, is replaced. Where no file can be
    written, the token holds for this server alone.
    """
    file = path or token_file()
    kept = read_token(file)
    if kept is not None:
        return kept
    made = new_token()
    try:
        write_whole(file, made.encode() + b"\n")
    except OSError:
        return made
    return read_token(file) or made
