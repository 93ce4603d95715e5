"""The unit of a scan's file can be corrected; registrations of another size are marked."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")


def upgrade() -> None:
    op.add_column("scans", sa.Column("size_m", DOCUMENT, nullable=True))
    op.add_column("scans", sa.Column("first_metres_per_unit", sa.Double(), nullable=True))
    op.add_column("scans", sa.Column("is_unit_guessed", sa.Boolean(), nullable=False, server_default=sa.false()))
    scans = sa.table(
        "scans", sa.column("metres_per_unit"), sa.column("first_metres_per_unit"), sa.column("is_unit_guessed")
    )
    op.execute(
        sa.update(scans).values(
            first_metres_per_unit=scans.c.metres_per_unit, is_unit_guessed=scans.c.metres_per_unit.is_(None)
        )
    )
    op.add_column("scan_crops", sa.Column("metres_per_unit", sa.Double(), nullable=True))
    op.add_column("registrations", sa.Column("is_outdated", sa.Boolean(), nullable=False, server_default=sa.false()))
    for name, column in (("scans", "is_unit_guessed"), ("registrations", "is_outdated")):
        with op.batch_alter_table(name) as table:
            table.alter_column(column, server_default=None)


def downgrade() -> None:
    for name, columns in (
        ("registrations", ("is_outdated",)),
        ("scan_crops", ("metres_per_unit",)),
        ("scans", ("is_unit_guessed", "first_metres_per_unit", "size_m")),
    ):
        with op.batch_alter_table(name) as table:
            for column in columns:
                table.drop_column(column)
