"""Lineage as the API gives it."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, Field

Kind = Literal[
    "scan",
    "registration",
    "decision",
    "training_set",
    "hand_model",
    "moving_scan",
    "moving_registration",
    "stretch_decision",
    "body_set",
    "person_model",
]


class LineageItem(BaseModel):
    """One thing on the way from a scan to a model of hands, or of a person."""

    kind: Kind
    id: uuid.UUID
    name: str
    detail: str = Field(description="For people, such as `accept by Anna`.")
    created_at: datetime


class LineageGroup(BaseModel):
    """Things of one kind."""

    kind: Kind
    total: int
    items: list[LineageItem] = Field(description="The newest ones.")


class Lineage(BaseModel):
    """Where a thing comes from, and what came of it; nearest first."""

    of: LineageItem
    comes_from: list[LineageGroup]
    went_into: list[LineageGroup]
