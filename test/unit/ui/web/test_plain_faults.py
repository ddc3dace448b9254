"""Faults that pydantic finds, in the words of the project's own errors."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from roomba.ui.web.plain_faults import sentence_of


class Asked(BaseModel):
    model_config = ConfigDict(extra="forbid")

    x: Annotated[float, Field(le=10.0, allow_inf_nan=False)] = 0.0
    kind: Literal["wall", "no-go"] = "wall"
    rooms: Annotated[list[str], Field(max_length=2)] = []
    name: str = "a"

    @field_validator("name")
    @classmethod
    def _is_no_dot(cls, name: str) -> str:
        if name == ".":
            raise ValueError("expected a name, got a dot")
        return name


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"x": 11.0}, "x: expected less than or equal to 10, got 11.0"),
        ({"x": "far"}, "x: expected a valid number, got 'far'"),
        ({"x": float("nan")}, "x: expected a finite number, got nan"),
        ({"kind": "door"}, "kind: expected 'wall' or 'no-go', got 'door'"),
        ({"y": 1}, "y: expected no field of that name, got 1"),
        ({"name": "."}, "expected a name, got a dot"),
        ({"rooms": ["a", 3]}, "rooms.1: expected a valid string, got 3"),
    ],
)
def test_a_fault_is_told_with_what_was_expected_and_what_came(
    values: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(ValidationError) as fault:
        Asked.model_validate(values)
    (error,) = fault.value.errors()
    assert sentence_of({**error, "loc": ("body", *error["loc"])}) == sentence
