"""Several jobs at once: batches that one request starts, and one act on many."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from server.jobs.schemas import JobOut, JobState


class BatchCreate(BaseModel):
    """The same for several recordings."""

    kind: Literal["track"] = "track"
    sequence_ids: list[uuid.UUID] = Field(min_length=1, max_length=500, description="One job for each.")
    params: dict[str, Any] = Field(default_factory=dict, description="As of one job; the same for all.")


class BatchOut(BaseModel):
    """Jobs that one request started, taken together. A job that was tried again is counted once, as its last try."""

    model_config = ConfigDict(title="Batch")

    id: uuid.UUID
    kind: str
    params: dict[str, Any]
    created_at: datetime
    created_by: uuid.UUID | None
    created_by_name: str | None
    ended_at: datetime | None = Field(description="When the last of them ended; null while one has not.")
    total: int
    states: dict[JobState, int] = Field(description="How many are in each state.")
    progress: float = Field(ge=0, le=1)
    seconds_left: float | None = Field(description="With as many workers as are at it now; null while not known.")


class BatchMade(BaseModel):
    """A batch and its jobs, in the order of the recordings."""

    batch: BatchOut
    jobs: list[JobOut]


class BulkAct(BaseModel):
    """One act on several jobs."""

    act: Literal["cancel", "retry", "resume"]
    job_ids: list[uuid.UUID] = Field(min_length=1, max_length=500)


class BulkRefusal(BaseModel):
    """One that it could not be done to."""

    id: uuid.UUID
    detail: str = Field(description="Why, for people.")


class BatchCheck(BaseModel):
    """Which of several recordings cannot be tracked so."""

    refused: list[BulkRefusal]


class BulkDone(BaseModel):
    """What became of each."""

    jobs: list[JobOut] = Field(description="Those it was done to; of `retry` the new ones.")
    refused: list[BulkRefusal]
