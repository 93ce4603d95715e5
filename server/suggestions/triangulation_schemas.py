"""Triangulations as the API gives and takes them."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Points

MAX_VIEWS = 16


class TriangulationView(BaseModel):
    """One hand as it is marked in one camera; joints with v = 0 are left out of account."""

    model_config = ConfigDict(extra="forbid")

    camera: Annotated[str, Field(max_length=64)]
    points: Points


class TriangulationIn(BaseModel):
    """One hand at one moment, in several cameras."""

    model_config = ConfigDict(extra="forbid")

    views: Annotated[list[TriangulationView], Field(min_length=1, max_length=MAX_VIEWS)]


class TriangulatedView(BaseModel):
    """A joint in one camera."""

    camera: str
    x: float | None = Field(description="Where the camera sees the joint, px; null behind it or without a joint.")
    y: float | None
    is_seen: bool = Field(description="That is in the image.")
    is_used: bool = Field(description="The mark in this view counted. A marked view that did not was set aside.")
    residual_px: float | None = Field(description="From the mark to where the camera sees the joint, px.")
    left_out_px: float | None = Field(
        description="From the mark to where the camera sees the joint that the other views alone make, px; "
        "null with fewer than two others."
    )


class TriangulatedJoint(BaseModel):
    """A joint in space, or why there is none."""

    point: list[float] | None = Field(description="(3,) world, m")
    angle_deg: float | None = Field(description="Largest angle between two lines of sight.")
    std_mm: float | None = Field(description="Standard deviation in the worst direction if marks are off by 1 px.")
    refusal: str = Field(description="Why there is no point, for people; empty when there is one.")
    views: list[TriangulatedView] = Field(description="Every camera of the recording, in its order.")


class TriangulationOut(BaseModel):
    """The joints of a hand in space."""

    model_config = ConfigDict(title="Triangulation")

    joints: list[TriangulatedJoint] = Field(description="21, in the order of `/hand-skeleton`.")
