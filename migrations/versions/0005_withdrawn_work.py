"""Assignments and replica sets can be withdrawn, and brought back."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    for table in ("assignments", "replica_sets"):
        op.add_column(table, sa.Column("deleted_at", sa.DateTime(timezone=True), nullable=True))


def downgrade() -> None:
    for table in ("assignments", "replica_sets"):
        with op.batch_alter_table(table) as altered:
            altered.drop_column("deleted_at")
