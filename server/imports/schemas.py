"""Imports as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from server.database.texts import Name

State = Literal["checked", "refused", "confirmed"]
Options = dict[str, Any]
OPTIONS_HELP = "What the files do not say; `/imports/form` lists them. `format` is one of its formats."


class ImportOut(BaseModel):
    """An upload and what was found in it. `refused`: see the report's problems; other options may help."""

    model_config = ConfigDict(from_attributes=True, title="Import")

    id: uuid.UUID
    state: State
    name: str
    options: Options
    report: dict[str, Any] = Field(
        description="What was found: `ok`, `problems`, `warnings`, and `questions`: every option that is missing, "
        "ambiguous or wrong, each with what it is (`field`, `label`, `kind`, `unit`), why (`ask`), whether nothing is "
        "stored without it (`is_required`), a `proposal` and its `choices` with `pictures`."
    )
    file_count: int
    byte_count: int
    sequence_id: uuid.UUID | None = Field(description="The recording that it has become.")
    calibration_id: uuid.UUID | None = Field(description="The kept calibration that its cameras are taken from.")
    created_at: datetime


class ImportCheck(BaseModel):
    """Look again, with other options."""

    model_config = ConfigDict(extra="forbid")

    options: Options = Field(description=OPTIONS_HELP)


class ImportCalibration(BaseModel):
    """Where the cameras are to come from."""

    model_config = ConfigDict(extra="forbid")

    calibration_id: uuid.UUID | None = Field(description="A finished calibration; null: the files that came along.")


class ImportConfirm(BaseModel):
    """Make it a recording, whole or not at all."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    options: Options | None = Field(
        default=None, description="Those of the report that was looked at; with others since, 409 and nothing stored."
    )


class ImportField(BaseModel):
    """An option of imports."""

    name: str
    type: str
    help: str


class SensorModeOut(BaseModel):
    """A size of a sensor's images and its typical camera, px."""

    model_config = ConfigDict(title="SensorMode", from_attributes=True)

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float


class SensorPresetOut(BaseModel):
    """Typical values of a kind of depth camera: not the calibration of anybody's own."""

    model_config = ConfigDict(title="SensorPreset", from_attributes=True)

    name: str
    label: str
    modes: list[SensorModeOut]
    depth_scales: list[float] = Field(description="m per unit: its own, then what programs usually save instead.")
    reach_m: tuple[float, float]
    fps: float
    source: str = Field(description="Where the numbers come from.")


class ImportForm(BaseModel):
    """What can be told about an upload."""

    formats: list[str]
    options: list[ImportField]
    presets: list[SensorPresetOut] = Field(description="Values that the option `preset` may name.")
