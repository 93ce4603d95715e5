"""Hand models as the API gives them."""

from __future__ import annotations

from pydantic import BaseModel, Field


class HandSkeleton(BaseModel):
    """The 21 joints of every hand, whatever its model."""

    joints: list[str] = Field(description="Names, in the order of every list of points.")
    edges: list[tuple[int, int]] = Field(description="Pairs of joints that a bone connects.")
    fingers: list[str]
