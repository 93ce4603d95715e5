"""Jobs, logs and workers as the API gives them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

JobKind = Literal["track", "detect", "register", "train", "loop", "calibrate", "register_moving"]
JobState = Literal["queued", "running", "succeeded", "failed", "cancelled"]


class JobCheck(BaseModel):
    """Whether a job can be started, asked before it is."""

    can_start: bool
    obstacles: list[str] = Field(description="Why not, sentences for people. The request for the job is refused so.")
    notes: list[str] = Field(description="What one should know, though the job can be started.")


class RestartCheck(BaseModel):
    """What can be done with a job that has ended without success, and what is kept of it."""

    resume: JobCheck
    retry: JobCheck
    kept: list[str] = Field(description="What it has done so far and need not do again, for people.")


class JobWorker(BaseModel):
    """The worker that runs a job, or ran it last."""

    id: uuid.UUID
    name: str
    host: str


class JobOut(BaseModel):
    """A job as it is now."""

    model_config = ConfigDict(title="Job")

    id: uuid.UUID
    kind: str
    state: JobState
    title: str = Field(description="The recording as it is called now, or what else it is about.")
    sequence_id: uuid.UUID | None = Field(description="The recording of a job that tracks or detects.")
    moving_scan_id: uuid.UUID | None = Field(description="The moving scan of a job that registers one.")
    track_id: uuid.UUID | None = Field(description="What a tracking job produced.")
    hand_model_id: uuid.UUID | None = Field(description="What training produced, the last model of a loop.")
    params: dict[str, Any]
    progress: float = Field(ge=0, le=1)
    stage: str = Field(description="What is being done, for people.")
    frames_done: int = Field(description="Or scans or cameras, see `unit`.")
    frames_total: int = Field(description="0 while not known.")
    unit: Literal["frames", "scans", "cameras"] = Field(description="What is counted.")
    seconds_left: float | None
    error: str | None = Field(description="What went wrong, for people.")
    attempt: int = Field(description="1, and one more for every resume.")
    retry_of: uuid.UUID | None
    batch_id: uuid.UUID | None = Field(description="Shared by the jobs that one request started.")
    created_by: uuid.UUID | None
    created_by_name: str | None = Field(description="Who started it; null for jobs of before there were accounts.")
    worker: JobWorker | None = Field(description="Who runs it, or ran it last.")
    version: int = Field(description="Grows with every change.")
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None


class JobLogLine(BaseModel):
    """One line of a job's log."""

    n: int
    time: datetime
    level: Literal["info", "warning", "error"]
    text: str


class JobLog(BaseModel):
    """Lines of a job's log, in order."""

    lines: list[JobLogLine]


class WorkerOut(BaseModel):
    """A worker process."""

    model_config = ConfigDict(title="Worker")

    id: uuid.UUID
    name: str
    host: str
    pid: int
    state: Literal["running", "silent", "stopped", "lost"]
    job_id: uuid.UUID | None = Field(description="What it is doing.")
    started_at: datetime
    last_seen_at: datetime
