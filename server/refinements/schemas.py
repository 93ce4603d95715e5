"""Refined cameras as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class RefinementCreate(BaseModel):
    """How cameras shall be refined."""

    model_config = ConfigDict(extra="forbid")

    lenses: bool = Field(default=False, description="Focal lengths, principal points and distortion may change too.")


class LabelAgreement(BaseModel):
    """How far marks are from where cameras see the points that the marks of all of them make."""

    joints: int
    rms: float | None = Field(description="px; null of none.")
    median: float | None = Field(description="px; null of none.")


class BeforeAfter(BaseModel):
    """The same of the cameras as they were and as they are refined."""

    before: LabelAgreement
    after: LabelAgreement


class RefinedCameraOut(BaseModel):
    """One camera before and after."""

    id: str
    is_moved: bool = Field(description="False of the one that stands still and of those that share too few labels.")
    moved_mm: float
    turned_deg: float
    focal_percent: float = Field(description="How much longer its focal length became.")
    unsure_px: float = Field(
        description="One standard deviation of where it sees a point, anywhere in its picture at the hands' distance."
    )
    fitted_px: BeforeAfter = Field(description="On the labels that were fitted to.")
    left_out_px: BeforeAfter = Field(description="On the labels that were left out.")


class RefinementReport(BaseModel):
    """What labels made of the cameras of a recording."""

    frames: int = Field(description="Labelled frames that were fitted to.")
    frames_left_out: int = Field(description="Labelled frames that the cameras were judged by.")
    kept: str = Field(description="What gave place and scale.")
    refusal: str = Field(description="Why the cameras should stay as they are; empty when they may be taken.")
    cameras: list[RefinedCameraOut]


class RefinementOut(BaseModel):
    """Refined cameras of a recording."""

    model_config = ConfigDict(from_attributes=True)

    id: uuid.UUID
    sequence_id: uuid.UUID
    state: Literal["proposed", "taken", "put_back"]
    report: RefinementReport
    created_at: datetime
    changed_at: datetime | None = Field(description="When it was taken or put back.")
    is_current: bool = Field(description="The recording has the cameras of before (proposed) or after (taken) now.")
