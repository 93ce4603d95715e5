"""Training sets as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from server.database.texts import Label, Name
from server.scans.schemas import Verdict


class TrainingRule(BaseModel):
    """Which registrations go in."""

    model_config = ConfigDict(extra="forbid")

    by: Literal["decisions", "verdict"] = Field(
        default="decisions",
        description="`decisions`: what the last decision of somebody accepts; `verdict`: what the program itself calls "
        "good, unless somebody rejected it.",
    )
    collections: list[Annotated[str, Field(max_length=200)]] = Field(
        default_factory=list, max_length=100, description="Of these collections; empty: of all."
    )
    model_id: uuid.UUID | None = Field(default=None, description="By this model only.")
    needs_two: StrictBool = Field(default=False, description="Only what two people accept, and nobody rejects.")
    verdicts: list[Verdict] = Field(
        default_factory=list, max_length=3, description="Only with one of these verdicts; empty: with any."
    )
    leave_out_subjects: list[Label] = Field(default_factory=list, max_length=1000, description="Kept for testing.")


class TrainingSetMake(BaseModel):
    """Keep the registrations that a rule chooses now."""

    model_config = ConfigDict(extra="forbid")

    name: Name
    rule: TrainingRule = Field(default_factory=TrainingRule)


class TrainingPreview(BaseModel):
    """What a rule would choose now."""

    registrations: int
    subjects: int
    mirrored: int = Field(description="Left hands.")
    undecided: int = Field(description="Newest registrations in its collections about which nobody has decided.")


class TrainingSetOut(BaseModel):
    """Registrations as a rule chose them at one moment."""

    model_config = ConfigDict(title="TrainingSet")

    id: uuid.UUID
    name: str
    rule: TrainingRule
    digest: str = Field(description="SHA-256 of the list of its registrations, with the SHA-256 of each.")
    registration_count: int
    subject_count: int
    mirrored_count: int = Field(description="Left hands.")
    model_count: int = Field(description="Models trained from it.")
    created_at: datetime
    created_by_name: str | None


class TrainingMember(BaseModel):
    """A registration in a training set."""

    registration_id: uuid.UUID
    scan_id: uuid.UUID
    scan_name: str
    subject: str
    pose: str
    side: Literal["right", "left"]
    digest: str
    decision_id: uuid.UUID | None


class TrainingVerification(BaseModel):
    """Whether the files of a training set are still what they were."""

    is_intact: bool
    damaged: list[uuid.UUID] = Field(description="Registrations whose file has changed or is gone, the first 100.")
