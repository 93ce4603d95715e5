"""Models of people as the API gives them."""

from __future__ import annotations

import uuid
from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field

from server.moving_scans.registration_schemas import Population


class PersonModelOut(BaseModel):
    """The body of one person: accepted frames taken back to the zero pose, and their median."""

    model_config = ConfigDict(title="PersonModel")

    id: uuid.UUID
    name: str = Field(description="Of the set.")
    body_set_id: uuid.UUID
    population: Population
    digest: str = Field(description="SHA-256 of its file.")
    frame_count: int = Field(description="Frames of the set that it was made from, spread over it.")
    created_at: datetime
    created_by_name: str | None
