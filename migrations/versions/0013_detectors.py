"""Fingertip detectors that were uploaded."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None

MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    op.create_table(
        "detectors",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("looks_at", sa.String(5), nullable=False),
        sa.Column("trees", sa.Integer(), nullable=False),
        sa.Column("byte_count", sa.BigInteger(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_detectors"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_detectors_created_by_accounts"),
        sa.CheckConstraint("looks_at IN ('depth', 'color')", name="ck_detectors_looks_at"),
    )
    op.create_index("ix_detectors_created_at_id", "detectors", ["created_at", "id"])


def downgrade() -> None:
    op.drop_index("ix_detectors_created_at_id", "detectors")
    op.drop_table("detectors")
