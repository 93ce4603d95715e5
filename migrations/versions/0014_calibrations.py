"""Cameras calibrated from filmed boards, and imports that take theirs from them."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    op.create_table(
        "calibrations",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("options", DOCUMENT, nullable=False),
        sa.Column("report", DOCUMENT, nullable=False),
        sa.Column("result", DOCUMENT, nullable=True),
        sa.Column("films_id", sa.Uuid(), nullable=False),
        sa.Column("job_id", sa.Uuid(), nullable=True),
        sa.Column("file_count", sa.Integer(), nullable=False),
        sa.Column("byte_count", sa.BigInteger(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("updated_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_calibrations"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_calibrations_created_by_accounts"),
        sa.CheckConstraint("state IN ('checked', 'refused')", name="ck_calibrations_state"),
    )
    op.create_index("ix_calibrations_created_at_id", "calibrations", ["created_at", "id"])
    op.add_column("imports", sa.Column("calibration_id", sa.Uuid(), nullable=True))


def downgrade() -> None:
    op.drop_column("imports", "calibration_id")
    op.drop_index("ix_calibrations_created_at_id", "calibrations")
    op.drop_table("calibrations")
