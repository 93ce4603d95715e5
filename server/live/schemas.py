"""Events of an open recording, and where somebody is in it."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Hand, Points, Sources
from server.database.numbers import FrameNumber


class LabelChange(BaseModel):
    """One hand in one image as it is now: `event: label`."""

    frame: int
    camera: str
    hand: Hand
    points: Points | None = Field(description="Null: it was deleted.")
    sources: Sources | None
    revision: int
    updated_at: datetime
    author: str | None


class Sight(BaseModel):
    """`event: sight`: which labels are hidden from whoever listens; another digest means: load the labels again."""

    digest: str


class Work(BaseModel):
    """`event: work`: an assignment of the recording, or a comment on one, has changed; load them again."""


class PersonHere(BaseModel):
    """Somebody else who has the recording open, and where."""

    name: str
    camera: str
    frame: int
    hand: Hand


class VisitPut(BaseModel):
    """Where somebody is in a recording that they have open."""

    model_config = ConfigDict(extra="forbid")

    camera: Annotated[str, Field(max_length=64)]
    frame: FrameNumber
    hand: Hand
