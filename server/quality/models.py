"""The table of flags that somebody looked at."""

from __future__ import annotations

import uuid
from datetime import datetime

from sqlalchemy import ForeignKey, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class DismissalRow(Base):
    """Somebody looked at a flag and the label is right. It counts for the revision looked at, not for later ones."""

    __tablename__ = "flag_dismissals"
    __table_args__ = (UniqueConstraint("annotation_id", "revision", "kind"),)

    annotation_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("annotations.id"))
    revision: Mapped[int]
    kind: Mapped[str] = mapped_column(String(30))
    account_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
