"""Registrations of moving scans as the API gives them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.scans.schemas import Verdict

Prior = Literal["mixture", "gaussian", "none"]
Population = Literal["neutral", "male", "female"]
Hand = Literal["left", "right"]


class MovingRegistrationOut(BaseModel):
    """A stretch of a moving scan registered by one job with one prior."""

    model_config = ConfigDict(title="MovingRegistration")

    id: uuid.UUID
    number: int = Field(description="Counts the registrations of a moving scan from 1, the oldest first.")
    moving_scan_id: uuid.UUID
    job_id: uuid.UUID
    parent_id: uuid.UUID | None = Field(description="The registration that this one goes on from.")
    prior: Prior = Field(description="What hands were expected to do.")
    holds_hands: bool = Field(description="A hand that a frame does not show keeps its pose.")
    has_velocity: bool = Field(description="The pose is held a little to that of the frame before.")
    population: Population
    first_frame: int
    last_frame: int = Field(description="The last one that was asked for; `frames_done` says how far it is.")
    frames_done: int
    verdicts: dict[Verdict, int]
    guessed: dict[Hand, int] = Field(description="Frames that do not show this hand.")
    scan_to_mesh_mm: float | None = Field(description="Mean over its frames.")
    accepted_count: int
    rejected_count: int
    created_at: datetime
    created_by_name: str | None


class FrameRegistrationOut(BaseModel):
    """The body laid onto one frame."""

    model_config = ConfigDict(title="FrameRegistration")

    frame: int
    verdict: Verdict
    reasons: list[str] = Field(description="Why it is not good, and which hands are guessed.")
    mean_mm: float | None = Field(description="Of the scan's points from the surface.")
    p95_mm: float | None
    guessed: list[Hand] = Field(description="Hands that the frame does not show.")
    decision: Literal["accept", "reject"] | None = Field(description="The last one about this frame that stands.")


class FrameRegistrations(BaseModel):
    """All frames of a registration, in order."""

    frames: list[FrameRegistrationOut]
