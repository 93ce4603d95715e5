"""A job that tracks hands and objects in a recording, and what the form of its options shows."""

from __future__ import annotations

import uuid
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field


class JobCreate(BaseModel):
    """What to do."""

    kind: Literal["track"] = "track"
    sequence_id: uuid.UUID
    params: dict[str, Any] = Field(
        default_factory=dict, description="Options of the tracker; `GET /jobs/form` lists them."
    )


class JobFormField(BaseModel):
    """One option of the tracker."""

    name: str
    label: str
    type: Literal["integer", "number", "boolean", "text"]
    default: int | float | bool | str
    help: str
    choices: list[str] | None = Field(description="The only values there are; null when any will do.")
    choice_labels: list[str] | None = Field(description="The choices for people, in the same order.")
    low: float | None = Field(description="Smallest number allowed.")
    high: float | None = Field(description="Largest number allowed.")
    unit: str | None = Field(description="Of a number.")
    is_advanced: bool = Field(description="Few people ever set it.")
    about: Literal["recording", "method", "machine"] = Field(
        description="What is tracked, how, or with what; presets are about the method."
    )


class JobPreset(BaseModel):
    """Values of some options that go together."""

    model_config = ConfigDict(from_attributes=True)

    name: str
    label: str
    help: str = Field(description="One sentence.")
    one_hand_ms: float = Field(description="Measured median time of a frame with one hand, ms.")
    two_hands_and_object_ms: float = Field(description="The same with two hands and an object, ms.")
    values: dict[str, int | float | bool | str] = Field(description="As in `params`.")


class JobForm(BaseModel):
    """Options that a tracking job takes as `params`."""

    kind: str
    fields: list[JobFormField]
    presets: list[JobPreset] = Field(description="From the quickest to the most thorough.")
    usual_preset: str = Field(description="Name of the one that forms begin with; jobs without params take defaults.")
