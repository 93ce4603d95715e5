"""Moving scans as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from server.database.numbers import Number
from server.database.texts import Label, Name
from server.scans.schemas import UnitScale

FramesPerSecond = Annotated[Number, Field(ge=0.1, le=1000.0)]


class MovingScanOptions(BaseModel):
    """What the files of an upload do not say."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = Field(default=None, description="Left out: that of the folder or of the zip.")
    subject: Label = ""
    fps: FramesPerSecond = 60.0
    metres_per_unit: UnitScale | None = Field(default=None, description="Left out: recognised by the size of a person.")


class MovingScanPatch(BaseModel):
    """What can be changed of a moving scan."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    subject: Label | None = None
    fps: FramesPerSecond | None = None


class FrameProblem(BaseModel):
    """A frame that cannot be used."""

    frame: int
    name: str = Field(description="Of its file.")
    detail: str = Field(description="What is wrong with it, for people.")


class MovingScanOut(BaseModel):
    """Scans of one person in the order of time: one file a frame."""

    model_config = ConfigDict(title="MovingScan")

    id: uuid.UUID
    name: str
    subject: str = Field(description="Who is scanned; empty when unknown.")
    fps: float
    frame_count: int
    usable_count: int = Field(description="Frames whose files can be used.")
    point_count: int = Field(description="Of the frame with the most.")
    byte_count: int
    metres_per_unit: float
    is_unit_guessed: bool = Field(description="The unit was not given; it was recognised by the size.")
    box_m: list[list[float]] = Field(description="Around all frames: the lowest x, y, z and the highest.")
    problems: list[FrameProblem] = Field(description="Frames that cannot be used.")
    notes: list[str] = Field(description="What was noticed when they came.")
    registration_count: int
    accepted_count: int = Field(description="Frames of which a registration is accepted.")
    created_at: datetime
    created_by_name: str | None


class MovingScanAdded(BaseModel):
    """What became of an upload."""

    moving_scan: MovingScanOut
    is_known: bool = Field(description="The same files in the same order were there already; nothing was stored.")
