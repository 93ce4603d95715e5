"""Suggestions as the API gives them. They are never stored: only what a person accepts becomes an annotation."""

from __future__ import annotations

import uuid
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Hand, Points

Source = Literal["triangulation", "interpolation", "fit", "track", "detector"]


class SuggestedJoint(BaseModel):
    """Where a machine would have a joint. No visibility is stated, only guessed."""

    px: tuple[float, float] = Field(description="px of the recorded image; the centre of the top-left pixel is (0, 0).")
    guess: Literal["occluded", "visible"]


class Suggestion(BaseModel):
    """What a machine proposes for one hand in one image. It is no annotation, and no request takes it for one."""

    source: Source
    label: str = Field(description='For people, after "Suggested by".', examples=["Track 2", "model fit of 7 joints"])
    camera: str
    frame: int
    hand: Hand
    track_id: uuid.UUID | None = Field(description="The track it is of.")
    model: str = Field(description="The hand model behind it.")
    joints: Annotated[list[SuggestedJoint | None], Field(min_length=21, max_length=21)] = Field(
        description="In the order of `/hand-skeleton`; null where nothing is proposed, as outside the image."
    )


class FitRequest(BaseModel):
    """The joints that somebody has placed so far."""

    model_config = ConfigDict(extra="forbid")

    points: Points
