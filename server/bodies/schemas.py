"""The body with hands as the API gives and takes it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, Field

from server.database.numbers import Number

Population = Literal["neutral", "male", "female"]
Bounded = Annotated[Number, Field(ge=-1000.0, le=1000.0)]
Vector = Annotated[list[Bounded], Field(min_length=3, max_length=3)]

MAX_POSED = 64
"""Frames that are posed at a time; the page asks for the next ones while it plays."""
MAX_EXPORTED = 3000
NUMBERS = 156


class BodyModelOut(BaseModel):
    """The body with hands for one population."""

    population: Population
    vertices: int
    faces: int
    joints: list[str] = Field(description="In SMPL-H's order; `parents` has the joint before each, -1 for the first.")
    parents: list[int]
    shape_count: int = Field(description="Directions of the shape space, body and hands together.")
    hand_component_count: int = Field(description="Directions of the pose space of each hand.")
    landmarks: dict[str, int] = Field(description="What `smplx.SMPLH` must be told as `vertex_ids`.")
    provenance: dict[str, str] = Field(description="Where it comes from and under which licence.")


class BodyFrame(BaseModel):
    """One pose: either all 52 rotation vectors, or those of some joints, with the hands in their pose spaces."""

    pose: Annotated[list[Bounded], Field(min_length=NUMBERS, max_length=NUMBERS)] | None = Field(
        default=None, description="156 numbers, rotation vectors in the joints' order, rad, as AMASS keeps them."
    )
    joints: dict[str, Vector] = Field(default={}, max_length=52, description="Rotation vectors by joint, rad.")
    hands: dict[Literal["left", "right"], Annotated[list[Bounded], Field(max_length=44)]] = Field(
        default={}, description="Coefficients of each hand's pose space, counted from its mean pose."
    )
    translation: Vector = [0.0, 0.0, 0.0]


class BodyPoses(BaseModel):
    """Poses of one person."""

    shape: Annotated[list[Bounded], Field(max_length=400)] = Field(
        default=[], description="Standard deviations along the first directions of the shape space."
    )
    frames: list[BodyFrame] = Field(min_length=1, max_length=MAX_POSED)


class BodyExport(BaseModel):
    """Poses to be written as a file for other programs."""

    format: Literal["obj", "ply", "glb"] = Field(description="obj and ply hold one mesh; glb moves through all frames.")
    shape: Annotated[list[Bounded], Field(max_length=400)] = []
    frames: list[BodyFrame] = Field(min_length=1, max_length=MAX_EXPORTED)
    fps: Number = Field(default=30.0, gt=0.0, le=1000.0)


class BodyMotionOut(BaseModel):
    """A motion file as it was read."""

    population: Population
    fps: float
    shape: list[float]
    poses: list[list[float]] = Field(description="Frames x 156, rad.")
    translations: list[list[float]] = Field(description="Frames x 3, m.")
