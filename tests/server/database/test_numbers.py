"""Numbers in JSON: true is not 1, "5" is not 5, 5.0 is 5, and nothing is infinite."""

from __future__ import annotations

import json
from typing import Annotated, Literal

import pytest
from pydantic import BaseModel, ValidationError

from server.database.frames import LAST_FRAME, FramePath
from server.database.numbers import FrameNumber, IsNumber, Joint, Number, Whole


class Sent(BaseModel):
    whole: Whole = 0
    number: Number = 0.0
    frame: FrameNumber = 0
    joint: Joint = 0
    choice: Annotated[Literal[0, 1], IsNumber] = 0
    path: FramePath = 0


@pytest.mark.parametrize(
    ("field", "text", "value"),
    [
        ("whole", "5", 5),
        ("whole", "5.0", 5),
        ("whole", "-7e0", -7),
        ("number", "5", 5.0),
        ("number", "1e-300", 1e-300),
        ("frame", "1000000000", LAST_FRAME),
        ("joint", "20.0", 20),
        ("choice", "1", 1),
        ("path", '"12"', 12),
    ],
)
def test_a_number_is_taken_as_what_it_is(field: str, text: str, value: float) -> None:
    found = getattr(Sent.model_validate_json(f'{{"{field}": {text}}}'), field)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("field", ["whole", "number", "frame", "joint", "choice"])
@pytest.mark.parametrize("value", [True, False, "1", None, [], {}, float("nan"), float("inf"), 1e400])
def test_what_is_no_number_is_refused(field: str, value: object) -> None:
    with pytest.raises(ValidationError):
        Sent.model_validate_json(json.dumps({field: value}))
    with pytest.raises(ValidationError):
        Sent.model_validate({field: value})


@pytest.mark.parametrize(
    ("field", "text"),
    [("whole", "5.5"), ("frame", "-1"), ("frame", "1000000001"), ("frame", "0.5"), ("joint", "21"), ("choice", "2")],
)
def test_numbers_out_of_their_range_are_refused(field: str, text: str) -> None:
    with pytest.raises(ValidationError):
        Sent.model_validate_json(f'{{"{field}": {text}}}')


@pytest.mark.parametrize("text", ["1.0", "+1", "1_0", " 1", "1\n", "", "٣", "0x1", "1" * 13, "-1", "1000000001"])
def test_a_frame_has_one_address(text: str) -> None:
    with pytest.raises(ValidationError):
        Sent.model_validate({"path": text})
