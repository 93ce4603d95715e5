"""What a job that registers a moving scan is to do."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from server.database.numbers import FrameNumber, Whole
from server.moving_scans.registration_schemas import Population, Prior


class RegisterMovingCreate(BaseModel):
    """A moving scan whose frames are to be registered, each from where the one before ended."""

    model_config = ConfigDict(extra="forbid")

    moving_scan_id: uuid.UUID
    parent_id: uuid.UUID | None = Field(
        default=None,
        description="A registration to go on from: its model of the person is used, and the first frame follows from "
        "the one before it there. `population` and `template_frames` are then its own.",
    )
    person_model_id: uuid.UUID | None = Field(
        default=None,
        description="A model of the person to begin with, in place of one made from the first frames. `population` and "
        "`template_frames` are then its own.",
    )
    first_frame: FrameNumber = 0
    last_frame: FrameNumber | None = Field(default=None, description="Null: the last one there is.")
    prior: Prior = Field(default="mixture", description="What hands are expected to do.")
    holds_hands: StrictBool = Field(default=True, description="A hand that a frame does not show keeps its pose.")
    has_velocity: StrictBool = Field(default=True, description="Hold the pose a little to that of the frame before.")
    population: Population = Field(default="neutral", description="Whose shapes the person's is looked for among.")
    template_frames: Whole = Field(
        default=6, ge=1, le=12, description="Frames that the person's own model is made from, at most."
    )
    chunk_frames: Whole = Field(
        default=50,
        ge=0,
        le=5000,
        description="Frames of a chunk. Free workers register chunks side by side; each is then joined to the one "
        "before without a seam. 0: all frames one after the other.",
    )


class RegisterMovingJobCreate(RegisterMovingCreate):
    """A job that registers a moving scan; its frames can be looked at and decided about while it runs."""

    kind: Literal["register_moving"]
