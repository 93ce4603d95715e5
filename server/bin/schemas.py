"""What lies in the bin, as the API gives it."""

from __future__ import annotations

import uuid
from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field


class BinItem(BaseModel):
    """A thing that was deleted and can be restored."""

    model_config = ConfigDict(title="BinItem")

    kind: str = Field(description="Such as `scan`; part of the address that restores it.")
    word: str = Field(description="The kind for people.")
    id: uuid.UUID
    name: str
    deleted_at: datetime
    deleted_by_name: str | None = Field(description="Null: by a script, or before the audit trail kept it.")
    byte_count: int | None = Field(description="Of its files on this machine; null when it has none of its own.")


class BinGoing(BaseModel):
    """Things of one kind that go with another."""

    word: str = Field(description="The kind for people.")
    count: int


class BinErasure(BaseModel):
    """What is deleted with a thing in the bin when it is deleted for good. It cannot be restored."""

    word: str = Field(description="The kind for people.")
    name: str
    going: list[BinGoing] = Field(description="What hangs on it and goes too.")
    byte_count: int = Field(description="Of the files on this machine that go.")
    obstacle: str | None = Field(description="Why it cannot go; null when it can.")
