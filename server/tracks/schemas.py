"""Tracks as the API gives them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field


class TrackOut(BaseModel):
    """A track."""

    model_config = ConfigDict(from_attributes=True, title="Track")

    id: uuid.UUID
    sequence_id: uuid.UUID
    job_id: uuid.UUID | None
    name: str
    frame_first: int
    frame_count: int
    hands: list[Literal["right", "left"]]
    summary: dict[str, Any] = Field(description="As `summary.json`.")
    error_px: float | None = Field(
        description="Mean distance to the annotations that no track had a part in, when last evaluated, px."
    )
    is_of_earlier_cameras: bool = Field(
        description="Made before the cameras changed: its joints stay where the cameras of that time saw them."
    )
    created_at: datetime
    deleted_at: datetime | None


class TrackView(BaseModel):
    """How well one camera agrees, as columns with one value per frame, the worse hand's; null where it saw none."""

    camera: str
    fit_px: list[float | None] = Field(description="From the fitted joints to where the detector saw them, median.")
    left_out_px: list[float | None] = Field(
        description="From where the detector saw the joints to what the other cameras make of them, median."
    )
    weight: list[float | None] = Field(description="0 to 1, mean of the camera's joints in the fit.")


class TermLook(BaseModel):
    """How a term of the objective is shown."""

    model_config = ConfigDict(from_attributes=True)

    name: str = Field(description="As in the costs.")
    label: str = Field(description="For people.")
    color: str = Field(description="As in CSS, on dark ground; no two terms look alike to anybody.")
    color_on_white: str = Field(description="As in CSS, on white ground.")
    dash: list[int] = Field(description="Strokes and gaps of its curve, px; empty for an unbroken one.")


class TrackFrames(BaseModel):
    """Columns with one value per frame; null where nothing was measured."""

    frame: list[int]
    status: list[Literal["ok", "lost", "recovered"]]
    seconds: list[float | None]
    depth_residual_mm: list[float | None]
    silhouette_iou: list[float | None]
    iterations: list[int]
    costs: dict[str, list[float | None]] = Field(
        description="Of each term at the last iteration, mm²; null where it had no part."
    )
    terms: list[TermLook] = Field(description="Of every name in the costs of any frame, in their order.")
    stages: dict[str, list[float | None]] = Field(description="Of each stage of the work, s.")
    views: list[TrackView] = Field(description="Of a track in several colour cameras; none in others.")


class TrackJoints(BaseModel):
    """Joints of all frames in one camera."""

    joint_names: list[str]
    frames: list[int]
    points: list[list[list[float | None]]] = Field(
        description="Per frame and joint [x, y], px; null behind the camera."
    )


class FrameEnergy(BaseModel):
    """The energy of one frame's fit, iteration by iteration."""

    frame: int
    is_recorded: bool = Field(description="False for tracks made before iterations were recorded.")
    iterations: int = Field(description="Of the fit that was kept; 0 where nothing was fitted.")
    costs: dict[str, list[float | None]] = Field(
        description="Of each term at the beginning of every iteration, mm²; null where it had no part."
    )
