"""Imports as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from server.sequences.schemas import Name

State = Literal["checked", "refused", "confirmed"]
Options = dict[str, Any]
OPTIONS_HELP = "What the files do not tell; `/imports/form` lists them. `format` is one of its formats."


class ImportOut(BaseModel):
    """An upload and what was found in it. `refused`: see the report's problems; other options may help."""

    model_config = ConfigDict(from_attributes=True, title="Import")

    id: uuid.UUID
    state: State
    name: str
    options: Options
    report: dict[str, Any]
    file_count: int
    byte_count: int
    sequence_id: uuid.UUID | None = Field(description="The recording that it has become.")
    created_at: datetime


class ImportCheck(BaseModel):
    """Look again, with other options."""

    model_config = ConfigDict(extra="forbid")

    options: Options = Field(description=OPTIONS_HELP)


class ImportConfirm(BaseModel):
    """Make it a recording."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None


class ImportField(BaseModel):
    """An option of imports."""

    name: str
    type: str
    help: str


class ImportForm(BaseModel):
    """What can be told about an upload."""

    formats: list[str]
    options: list[ImportField]
