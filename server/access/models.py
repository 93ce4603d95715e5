"""Accounts, their logins and tokens, and what was done by whom."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal, get_args

from sqlalchemy import CheckConstraint, ForeignKey, Index, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now

LOCAL_ACCOUNT_ID = uuid.UUID("00000000-0000-4000-8000-000000000001")
"""Whoever sits at this machine; the first migration makes the row."""

Role = Literal["annotator", "reviewer", "lead", "admin"]
ROLES: tuple[Role, ...] = get_args(Role)
"""From who may do least to who may do most; each may do what those before it may."""


class Account(Base):
    """Somebody who annotates, tracks or decides."""

    __tablename__ = "accounts"
    __table_args__ = (CheckConstraint("role IN ('annotator', 'reviewer', 'lead', 'admin')", name="role"),)

    name: Mapped[str] = mapped_column(String(200), unique=True)
    role: Mapped[Role] = mapped_column(String(10), default="annotator")
    password_hash: Mapped[str | None] = mapped_column(String(300))
    """argon2; without one nobody logs in as this account."""
    preferences: Mapped[dict[str, Any]] = mapped_column(default=dict)
    """Of the browser app, such as keys that were put elsewhere."""
    revision: Mapped[int] = mapped_column(default=1)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    disabled_at: Mapped[datetime | None]


class LoginRow(Base):
    """A browser in which somebody is logged in; the cookie's secret is kept as its hash only."""

    __tablename__ = "logins"
    __table_args__ = (UniqueConstraint("secret_hash"), Index(None, "account_id"))

    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    secret_hash: Mapped[str] = mapped_column(String(64))
    user_agent: Mapped[str] = mapped_column(String(300), default="")
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    last_seen_at: Mapped[datetime] = mapped_column(default=utc_now)
    expires_at: Mapped[datetime]


class PasswordCodeRow(Base):
    """A one-time code with which somebody sets their password; an account has one at most."""

    __tablename__ = "password_codes"
    __table_args__ = (UniqueConstraint("account_id"), UniqueConstraint("secret_hash"))

    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    secret_hash: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    expires_at: Mapped[datetime]


class TokenRow(Base):
    """A script's way in; the secret is shown once and kept as its hash only."""

    __tablename__ = "tokens"
    __table_args__ = (UniqueConstraint("secret_hash"), Index(None, "account_id"))

    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    name: Mapped[str] = mapped_column(String(200))
    secret_hash: Mapped[str] = mapped_column(String(64))
    may_write: Mapped[bool] = mapped_column(default=False)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    expires_at: Mapped[datetime | None]
    last_used_at: Mapped[datetime | None]
    revoked_at: Mapped[datetime | None]


class AuditRow(Base):
    """One thing that somebody did. Rows are only ever added; annotations have their own history."""

    __tablename__ = "audit"
    __table_args__ = (Index(None, "time", "id"), Index(None, "subject", "subject_id"))

    time: Mapped[datetime] = mapped_column(default=utc_now)
    account_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    act: Mapped[str] = mapped_column(String(60))
    """Such as `assignment.submit`."""
    subject: Mapped[str] = mapped_column(String(40))
    subject_id: Mapped[uuid.UUID | None]
    detail: Mapped[dict[str, Any]] = mapped_column(default=dict)
