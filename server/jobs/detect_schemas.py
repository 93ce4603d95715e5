"""A job that finds the hands in every image of a recording."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, ConfigDict


class DetectCreate(BaseModel):
    """A recording whose hands are to be found."""

    model_config = ConfigDict(extra="forbid")

    sequence_id: uuid.UUID


class DetectJobCreate(DetectCreate):
    """A job that finds the hands in every image of a recording; they are suggested to whoever annotates it."""

    kind: Literal["detect"]
