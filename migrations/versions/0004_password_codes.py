"""One-time codes with which people set their password."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "password_codes",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("account_id", sa.Uuid(), nullable=False),
        sa.Column("secret_hash", sa.String(64), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_password_codes"),
        sa.ForeignKeyConstraint(["account_id"], ["accounts.id"], name="fk_password_codes_account_id_accounts"),
        sa.UniqueConstraint("account_id", name="uq_password_codes_account_id"),
        sa.UniqueConstraint("secret_hash", name="uq_password_codes_secret_hash"),
    )


def downgrade() -> None:
    op.drop_table("password_codes")
