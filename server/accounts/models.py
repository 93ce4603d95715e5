"""Accounts."""

from __future__ import annotations

import uuid
from datetime import datetime

from sqlalchemy import String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now

LOCAL_ACCOUNT_ID = uuid.UUID("00000000-0000-4000-8000-000000000001")
"""Whoever sits at this machine; the first migration makes the row."""


class Account(Base):
    """Somebody who annotates, tracks or decides."""

    __tablename__ = "accounts"

    name: Mapped[str] = mapped_column(String(200), unique=True)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
