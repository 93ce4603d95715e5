"""Hand models as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, Field

from server.database.texts import Name


class HandSkeleton(BaseModel):
    """The 21 joints of every hand, whatever its model."""

    joints: list[str] = Field(description="Names, in the order of every list of points.")
    edges: list[tuple[int, int]] = Field(description="Pairs of joints that a bone connects.")
    fingers: list[str]


class HandModelOut(BaseModel):
    """A hand model. The `default` ones come with Handloom and track; the others register scans and learn from them."""

    id: uuid.UUID
    name: str
    kind: Literal["default", "untrained", "trained", "uploaded"]
    side: Literal["right", "left"]
    vertices: int
    faces: int
    bones: list[str]
    degrees_of_freedom: int = Field(description="Of its pose, the 6 of the whole hand among them.")
    shape_parameters: list[str] = Field(description="What can be fitted of whose hand it is.")
    pose_components: int = Field(default=0, description="Of its pose space.")
    has_pose_shapes: bool = Field(
        default=False, description="Whether its surface changes with its pose beyond skinning."
    )
    provenance: dict[str, str] = Field(description="Where it comes from and under which licence.")
    digest: str | None = Field(default=None, description="SHA-256 of its file.")
    round: int = Field(default=0, description="0 before any training.")
    parent_id: uuid.UUID | None = Field(default=None, description="The model that training began with.")
    training_set_id: uuid.UUID | None = None
    job_id: uuid.UUID | None = Field(default=None, description="The job that trained it.")
    registers: bool = Field(default=False, description="Whether scans can be registered with it.")
    has_report: bool = False
    registration_count: int = Field(default=0, description="Registrations by it.")
    created_at: datetime | None = Field(default=None, description="Null for those that come with Handloom.")
    created_by_name: str | None = None


class HandModelOptions(BaseModel):
    """What the file of a model does not tell."""

    name: Name | None = None
    side: Literal["right", "left"] | None = None


class HandModelReport(BaseModel):
    """What training found."""

    report: dict[str, Any]
