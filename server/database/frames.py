"""Numbers of frames in addresses."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import Path
from pydantic import BeforeValidator

LAST_FRAME = 10**9


def _read_digits(text: object) -> object:
    """`1.0`, `+1` and `1_0` are no names of frame 1, so that each picture has one address."""
    if isinstance(text, str) and not re.fullmatch(r"-?[0-9]{1,12}", text):
        raise ValueError("The number of a frame is digits alone, from 0.")
    return text


FramePath = Annotated[int, Path(ge=0, le=LAST_FRAME), BeforeValidator(_read_digits)]
"""A frame in an address."""
