"""Hand models as the API gives them."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, Field


class HandSkeleton(BaseModel):
    """The 21 joints of every hand, whatever its model."""

    joints: list[str] = Field(description="Names, in the order of every list of points.")
    edges: list[tuple[int, int]] = Field(description="Pairs of joints that a bone connects.")
    fingers: list[str]


class HandModelOut(BaseModel):
    """A hand model that recordings can be tracked with."""

    id: uuid.UUID
    name: str
    side: Literal["right", "left"]
    vertices: int
    faces: int
    bones: list[str]
    degrees_of_freedom: int = Field(description="Of its pose, the 6 of the whole hand among them.")
    shape_parameters: list[str] = Field(description="What can be fitted of whose hand it is.")
    provenance: dict[str, str] = Field(description="Where it comes from and under which licence.")
