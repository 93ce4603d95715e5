"""Fingertip detectors as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.database.texts import Name


class DetectorOut(BaseModel):
    """A fingertip detector that `handloom train-detector` wrote and somebody uploaded."""

    model_config = ConfigDict(title="Detector", from_attributes=True)

    id: uuid.UUID
    name: str
    looks_at: Literal["depth", "color"] = Field(description="The images in which it looks for fingertips.")
    trees: int
    byte_count: int = Field(description="Of its file.")
    digest: str = Field(description="SHA-256 of its file.")
    created_at: datetime


class DetectorOptions(BaseModel):
    """What the file of a detector does not tell."""

    name: Name | None = None
