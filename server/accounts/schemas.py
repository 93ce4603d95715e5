"""Accounts as the API gives and takes them."""

from __future__ import annotations

import uuid
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from server.accounts.models import Role


class MyAccount(BaseModel):
    """Who I am."""

    model_config = ConfigDict(from_attributes=True)

    id: uuid.UUID
    name: str
    role: Role
    revision: int
    preferences: dict[str, Any] = Field(description="Of the browser app, such as keys that were put elsewhere.")
    is_login_needed: bool = Field(description="False where the studio is for one person at this machine only.")
    may_write: bool = Field(description="False for a token that may only read.")
    by_token: bool = Field(description="Whether the request came with a token: a script, not a person.")
