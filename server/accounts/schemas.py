"""Accounts as the API gives them."""

from __future__ import annotations

import uuid

from pydantic import BaseModel, ConfigDict


class AccountOut(BaseModel):
    """Somebody."""

    model_config = ConfigDict(from_attributes=True, title="Account")

    id: uuid.UUID
    name: str
