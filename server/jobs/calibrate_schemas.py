"""A job that calibrates cameras from films of a board."""

from __future__ import annotations

import uuid
from typing import Literal

from pydantic import BaseModel, ConfigDict


class CalibrateCreate(BaseModel):
    """Films of a board whose cameras are to be calibrated, with the options that were checked last."""

    model_config = ConfigDict(extra="forbid")

    calibration_id: uuid.UUID


class CalibrateJobCreate(CalibrateCreate):
    """A job that calibrates cameras from what they filmed of a board."""

    kind: Literal["calibrate"]
