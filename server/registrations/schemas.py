"""Registrations as the API gives them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.scans.schemas import Side, Verdict

Queue = Literal["undecided", "all", "flagged", "second"]
Order = Literal["likely_failures", "newest"]
Standing = Literal["accept", "reject", "unsure"]


class ScanToMesh(BaseModel):
    """Distances from the points of a scan to the registered mesh, mm."""

    mean: float | None = Field(description="Null when no point was found to be of a hand.")
    median: float | None
    p95: float | None


class RegistrationScan(BaseModel):
    """The scan of a registration, in brief."""

    id: uuid.UUID
    name: str
    collection: str
    subject: str
    pose: str
    side: Side | None
    point_count: int
    geometry_key: str = Field(description="As it was when it was registered.")


class RegistrationOut(BaseModel):
    """The template brought onto a scan."""

    model_config = ConfigDict(title="Registration")

    id: uuid.UUID
    scan: RegistrationScan
    model_id: uuid.UUID
    model_name: str
    job_id: uuid.UUID | None
    round: int = Field(description="1: by an untrained model; 2: by a model trained from round 1; and so on.")
    side: Side = Field(description="As found.")
    verdict: Verdict = Field(description="The program's own.")
    score: float = Field(description="Chance that it is wrong, as the program sees it, 0 to 1; orders the queue.")
    reasons: list[str]
    scan_to_mesh_mm: ScanToMesh
    seconds: float
    is_current: bool = Field(description="Whether it is the newest one of its scan that is not outdated.")
    is_outdated: bool = Field(description="The scan has another size by now: somebody corrected the unit of its file.")
    decision: Standing | None = Field(
        description="The last one that stands; null when none does, or when it is hidden."
    )
    is_hidden: bool = Field(description="Somebody has decided, and you are to decide without seeing it.")
    my_decision: Standing | None
    my_decision_id: uuid.UUID | None = Field(description="For undo.")
    reviewer_count: int = Field(description="People whose decision stands.")
    needs_second: bool = Field(description="A second person is to decide without seeing the first one's decision.")
    created_at: datetime


class RegistrationCounts(BaseModel):
    """How much there is in each queue, of the newest registration of each scan unless asked otherwise."""

    undecided: int
    flagged: int
    second: int
    all: int
    accept: int
    reject: int
    unsure: int
