"""Faults of a request in plain words: what was expected, and what came."""

from __future__ import annotations

import json
import re
import reprlib
from collections.abc import Mapping
from typing import Any, Final

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel

_EXPECTED: Final = re.compile(r".*? should (?:be|have|match) (.*?)(?: after validation.*)?")
"""The beginning of pydantic's sentences."""
_CHOICES: Final = ("enum", "literal_error")
"""Kinds of faults whose sentence lists the choices; other sentences have a cause after a comma."""


class Refusal(BaseModel):
    """Why a request is refused."""

    detail: str


async def refuse_unfit(_: Request, fault: Exception) -> Response:
    """Answer 422 with a sentence for each fault of a request."""
    assert isinstance(fault, RequestValidationError)
    detail = "; ".join(sentence_of(error) for error in fault.errors())
    # JSON may hold half a surrogate pair, which is no UTF-8: all but ASCII is escaped.
    return Response(json.dumps({"detail": detail}), 422, media_type="application/json")


def sentence_of(error: Mapping[str, Any]) -> str:
    """Return pydantic's fault as a sentence in the style of the project's own errors."""
    where, told = error["loc"], str(error["msg"])
    name = ".".join(map(str, where[1:])) or where[0]
    match error["type"]:
        case "value_error":  # of a validator, whose own sentence says what came
            return told.removeprefix("Value error, ")
        case "json_invalid":
            return f"expected JSON, got something else from character {where[-1]} on"
        case "missing":
            return f"{name}: expected a value, got nothing"
        case "extra_forbidden":
            expected = "no field of that name"
        case "model_attributes_type":
            expected = "keys and values"
        case kind:
            found = _EXPECTED.fullmatch(told)
            expected = "another value" if found is None else found[1]
            if kind not in _CHOICES:
                expected = expected.partition(",")[0]
    return f"{name}: expected {expected}, got {reprlib.repr(error['input'])}"
