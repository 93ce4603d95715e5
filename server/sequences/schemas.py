"""Recordings as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from server.database.texts import Name

Hand = Literal["right", "left"]


class SequenceCamera(BaseModel):
    """A camera of a recording; conventions of OpenCV."""

    id: str
    width: int = Field(description="px")
    height: int = Field(description="px")
    K: list[list[float]] = Field(description="(3, 3) px; the centre of the top-left pixel is (0, 0).")
    distortion: list[float]
    T_world_camera: list[list[float]] = Field(description="(4, 4) m")
    has_color: bool
    has_depth: bool
    depth_scale: float | None = Field(description="Metres per unit of its depth images.")
    depth_near: float | None = Field(default=None, description="m; hardly a depth value is nearer.")
    depth_far: float | None = Field(default=None, description="m; hardly a depth value is farther.")


class SequenceObject(BaseModel):
    """A thing that is handled in a recording."""

    name: str


class BestTrack(BaseModel):
    """The track of a recording that fits best."""

    id: uuid.UUID
    summary: dict[str, Any]
    error_px: float | None = Field(description="Mean distance to the annotations that no track had a part in, px.")


class SequenceOut(BaseModel):
    """A recording."""

    model_config = ConfigDict(title="Sequence")

    id: uuid.UUID
    name: str
    fps: float
    frame_count: int
    cameras: list[SequenceCamera]
    hands: list[Hand]
    objects: list[SequenceObject]
    created_at: datetime
    updated_at: datetime
    revision: int
    report: dict[str, Any] | None = Field(description="What the import found.")
    content_key: str = Field(description="Part of the address of every image; another key means other files.")
    annotated_frames: int = Field(default=0, description="Frames with at least one joint.")
    done_frames: int = Field(
        default=0, description="Frames in which every joint of every hand is marked, or marked as outside the image."
    )
    best_track: BestTrack | None = None


def _check_hands(hands: list[Hand]) -> list[Hand]:
    if len(set(hands)) != len(hands):
        raise ValueError("each hand once")
    return hands


Hands = Annotated[
    list[Hand], Field(max_length=2, json_schema_extra={"uniqueItems": True}), AfterValidator(_check_hands)
]


class SequencePatch(BaseModel):
    """What can be changed of a recording; what is left out stays."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    hands: Hands | None = None
