"""Cameras refined from labels."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    op.create_table(
        "refinements",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("sequence_id", sa.Uuid(), nullable=False),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("report", DOCUMENT, nullable=False),
        sa.Column("cameras_before", DOCUMENT, nullable=False),
        sa.Column("cameras_after", DOCUMENT, nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.Column("changed_at", MOMENT, nullable=True),
        sa.Column("changed_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_refinements"),
        sa.ForeignKeyConstraint(["sequence_id"], ["sequences.id"], name="fk_refinements_sequence_id_sequences"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_refinements_created_by_accounts"),
        sa.ForeignKeyConstraint(["changed_by"], ["accounts.id"], name="fk_refinements_changed_by_accounts"),
        sa.CheckConstraint("state IN ('proposed', 'taken', 'put_back')", name="ck_refinements_state"),
    )
    op.create_index("ix_refinements_sequence_id_created_at", "refinements", ["sequence_id", "created_at"])


def downgrade() -> None:
    op.drop_index("ix_refinements_sequence_id_created_at", "refinements")
    op.drop_table("refinements")
