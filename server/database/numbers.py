"""Numbers in the JSON that people send, in one way everywhere: true is not 1, and "5" is not 5."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, Strict


def _refuse_truth(value: object) -> object:
    if isinstance(value, bool):
        raise ValueError("needed a number, not true or false")
    return value


IsNumber = BeforeValidator(_refuse_truth)
"""For a choice of few numbers: pydantic takes true for `Literal[1]`."""


def _take_whole(value: object) -> object:
    """JSON has one kind of number: 5.0 is the whole number 5."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Whole = Annotated[int, Strict(), BeforeValidator(_take_whole)]
Number = Annotated[float, Strict(), Field(allow_inf_nan=False)]
FrameNumber = Annotated[int, Strict(), Field(ge=0, le=10**9), BeforeValidator(_take_whole)]
Joint = Annotated[int, Strict(), Field(ge=0, le=20), BeforeValidator(_take_whole)]
