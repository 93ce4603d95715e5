"""Decisions about stretches of frames, and what is kept of the accepted ones, as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from server.database.numbers import FrameNumber
from server.database.texts import Name, Text
from server.moving_scans.registration_schemas import Prior


class StretchDecisionMake(BaseModel):
    """What somebody decides about frames `first_frame` to `last_frame`."""

    model_config = ConfigDict(extra="forbid")

    decision: Literal["accept", "reject"]
    first_frame: FrameNumber
    last_frame: FrameNumber
    note: Text = ""
    operation_id: uuid.UUID = Field(description="Made anew for each decision; sent again, nothing is done twice.")

    @model_validator(mode="after")
    def _is_in_order(self) -> StretchDecisionMake:
        if self.first_frame > self.last_frame:
            raise ValueError("`first_frame` is after `last_frame`")
        return self


class StretchDecisionUndo(BaseModel):
    """Take a decision of one's own back."""

    model_config = ConfigDict(extra="forbid")

    operation_id: uuid.UUID = Field(description="Made anew for each undo; sent again, nothing is done twice.")


class StretchDecisionOut(BaseModel):
    """One thing that somebody decided, or took back."""

    model_config = ConfigDict(title="StretchDecision")

    id: uuid.UUID
    registration_id: uuid.UUID
    account_id: uuid.UUID
    author_name: str
    decision: Literal["accept", "reject", "undo"]
    first_frame: int
    last_frame: int
    note: str
    undoes_id: uuid.UUID | None
    stands: bool = Field(description="Nobody took it back.")
    created_at: datetime


class AcceptedStretch(BaseModel):
    """Frames in a row whose registrations one decision accepted."""

    first_frame: int
    last_frame: int
    frame_count: int
    registration_id: uuid.UUID
    registration_number: int
    prior: Prior
    job_id: uuid.UUID
    parent_id: uuid.UUID | None = Field(description="The registration that this one went on from.")
    decision_id: uuid.UUID
    accepted_by_name: str
    accepted_at: datetime


class AcceptedFrames(BaseModel):
    """The registrations of a moving scan that count: of each frame the one accepted last."""

    frame_count: int
    stretches: list[AcceptedStretch]


class BodySetMake(BaseModel):
    """Accepted frames to be kept."""

    model_config = ConfigDict(extra="forbid")

    moving_scan_id: uuid.UUID
    name: Name


class BodySetOut(BaseModel):
    """Accepted frames as they were when somebody kept them, and where each comes from."""

    model_config = ConfigDict(title="BodySet")

    id: uuid.UUID
    name: str
    moving_scan_id: uuid.UUID
    digest: str = Field(description="SHA-256 of which registrations it holds.")
    frame_count: int
    stretches: list[AcceptedStretch]
    created_at: datetime
    created_by_name: str | None
