"""What lies in the bin, as the API gives it."""

from __future__ import annotations

import uuid
from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field


class BinItem(BaseModel):
    """A thing that was deleted and can be brought back."""

    model_config = ConfigDict(title="BinItem")

    kind: str = Field(description="Such as `scan`; part of the address that restores it.")
    word: str = Field(description="The kind for people.")
    id: uuid.UUID
    name: str
    deleted_at: datetime
    deleted_by_name: str | None = Field(description="Null: by a script, or before the audit trail kept it.")
    byte_count: int | None = Field(description="Of its files on this machine; null when it has none of its own.")
