"""A job that registers scans."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class RegisterCreate(BaseModel):
    """Scans to register."""

    model_config = ConfigDict(extra="forbid")

    scan_ids: list[uuid.UUID] = Field(default_factory=list, max_length=5000, description="Empty: as the rest says.")
    collection: str | None = Field(default=None, max_length=200, description="Null: of all collections.")
    subject: str | None = Field(default=None, max_length=100)
    only: Literal["new", "not_accepted", "all"] = Field(
        default="new",
        description="`new`: those that this model has not registered as they are cropped now; `not_accepted`: those "
        "whose newest registration nobody accepted.",
    )
    model_id: uuid.UUID | None = Field(default=None, description="Null: the model that nobody has trained yet.")


class RegisterJobCreate(RegisterCreate):
    """A job that registers scans; each can be curated as soon as it is done."""

    kind: Literal["register"]
