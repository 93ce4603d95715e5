"""What is asked of an evaluation and what it answers. Errors are px."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import SOURCES_HELP, JointsOfSource, SourceChoice

Hand = Literal["right", "left"]
MAX_TRACKS = 60


class EvaluationQuery(BaseModel):
    """Which tracks to judge, by which labels, and what of them counts."""

    model_config = ConfigDict(extra="forbid")

    track: list[uuid.UUID] = Field(default=[], max_length=MAX_TRACKS, description="Tracks to compare, in this order.")
    sequence: list[uuid.UUID] = Field(
        default=[], max_length=MAX_TRACKS, description="Recordings of which every track is taken, the newest first."
    )
    project: uuid.UUID | None = Field(
        default=None, description="Project; of each of its recordings the newest track of every method is taken."
    )
    reference: uuid.UUID | None = Field(default=None, description="Track that the others are set against.")
    snapshot: list[uuid.UUID] = Field(
        default=[], max_length=MAX_TRACKS, description="Label snapshots; recordings without one are judged by now's."
    )
    camera: str = Field(default="", max_length=64, description="This camera alone.")
    hand: Hand | None = Field(default=None, description="This hand alone.")
    source: list[SourceChoice] = Field(default=["independent"], min_length=1, max_length=10, description=SOURCES_HELP)
    visibility: Literal["visible", "occluded"] | None = Field(default=None, description="Joints marked so alone.")
    without_start: bool = Field(
        default=False, description="Leave out the frame that each track began at: its annotation may have helped."
    )
    within: float = Field(default=10.0, gt=0, le=1000, allow_inf_nan=False, description="px, for the share below it.")


class ErrorStatistics(BaseModel):
    """Of a set of joint errors, px; null but for `count` where there are none."""

    count: int
    mean: float | None
    std: float | None
    median: float | None
    p75: float | None
    p95: float | None
    p99: float | None
    max: float | None


class PairedDifferenceOut(BaseModel):
    """Errors minus those of the reference, over joints that both have; below zero is better."""

    joints: int
    frames: int
    mean: float
    reference_mean: float
    difference: float
    low: float = Field(description="Of the 95 % interval of the difference: a bootstrap over frames.")
    high: float
    better: float = Field(description="Share of the joints that are nearer than the reference's.")


class ErrorCurve(BaseModel):
    """Mean and largest error of each annotated frame."""

    frame: list[int]
    mean: list[float | None]
    max: list[float | None]


class WorstFrame(BaseModel):
    """One hand in one image, with a picture of it."""

    frame: int
    camera: str
    hand: Hand
    status: str
    mean_px: float
    max_px: float
    joints: int
    worst_joint: str
    picture: str | None = Field(default=None, description="Address of a JPEG that may be kept for good.")


class JudgedTrackOut(BaseModel):
    """A track with its errors."""

    key: uuid.UUID
    name: str
    recording_key: uuid.UUID
    recording: str
    parameters: dict[str, Any]
    labels: dict[str, Any] = Field(description="Which labels judged it: of now with their revision, or a snapshot.")
    origin: dict[str, Any] = Field(description="Which track this was.")
    frames: int
    lost: int
    lost_frames: list[int]
    annotated: int = Field(description="Annotated hands in images.")
    evaluated: int = Field(description="Those of them that the track holds and that have joints which count.")
    annotated_frames: int
    untracked: int
    sources: list[JointsOfSource] = Field(description="Where the joints came from that count, or are left out.")
    left_out_joints: int = Field(description="Placed joints that do not count because of where they came from.")
    error: ErrorStatistics
    visible: ErrorStatistics
    occluded: ErrorStatistics
    hands: dict[str, ErrorStatistics]
    cameras: dict[str, ErrorStatistics]
    by_joint: list[ErrorStatistics] = Field(description="In the order of `joints`.")
    within: float | None = Field(description="Share of the joints within `within_px`.")
    shares: list[float | None] = Field(description="Share of the joints within each of `thresholds_px` (PCK).")
    curve: ErrorCurve
    common: ErrorStatistics = Field(description="Over the joints that every track of the recording here has.")
    paired: PairedDifferenceOut | None = Field(description="Null for the reference, and for other recordings' tracks.")
    worst: list[WorstFrame]


class MethodOut(BaseModel):
    """Tracks with the same parameters, one for each recording, pooled."""

    name: str
    tracks: list[uuid.UUID]
    recordings: int
    frames: int
    lost: int
    error: ErrorStatistics
    within: float | None
    is_reference: bool
    paired: PairedDifferenceOut | None


class DifferingParameter(BaseModel):
    """A parameter that is not the same in all."""

    name: str
    values: dict[str, Any] = Field(description="By the track's id.")


class ComparedParameters(BaseModel):
    """What the runs share and what not."""

    different: list[DifferingParameter]
    same: dict[str, Any]


class Comparison(BaseModel):
    """Tracks judged by labels, side by side."""

    version: int
    made_at: datetime
    within_px: float
    thresholds_px: list[float]
    source: list[SourceChoice] = Field(description="Joints that count, as asked for.")
    reference: uuid.UUID | None
    joints: list[str]
    cameras: list[str] = Field(description="That `camera` may name.")
    tracks: list[JudgedTrackOut]
    methods: list[MethodOut]
    parameters: ComparedParameters
