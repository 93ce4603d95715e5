"""A job that registers scans, trains on them and registers them again."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.database.numbers import Whole
from server.database.texts import Label, Name
from server.jobs.train_schemas import Evaluate, TrainingParams


class LoopCreate(BaseModel):
    """Register, choose, train, register again."""

    model_config = ConfigDict(extra="forbid")

    name: Name = Field(description="Of the models; the round is added.")
    collection: str | None = Field(default=None, max_length=200, description="Null: all scans.")
    model_id: uuid.UUID | None = Field(default=None, description="To begin with; null: the one not trained yet.")
    by: Literal["verdict", "decisions"] = Field(
        default="verdict",
        description="What is trained from. `verdict`: what the program calls good and nobody rejected; `decisions`: "
        "what people have accepted by now. Then one round is done, and its registrations wait for people.",
    )
    rounds: Whole = Field(default=1, ge=1, le=10, description="By decisions: 1.")
    leave_out_subjects: list[Label] = Field(default_factory=list, max_length=1000, description="Kept for testing.")
    options: TrainingParams = Field(default_factory=TrainingParams)
    evaluate: Evaluate = "no"


class LoopJobCreate(LoopCreate):
    """A job that registers all scans, chooses, trains, and registers all with the new model."""

    kind: Literal["loop"]
