"""Models of people, made from sets of accepted frames."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "person_models",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("body_set_id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("population", sa.String(10), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_person_models"),
        sa.ForeignKeyConstraint(["body_set_id"], ["body_sets.id"], name="fk_person_models_body_set_id_body_sets"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_person_models_created_by_accounts"),
        sa.UniqueConstraint("body_set_id", name="uq_person_models_body_set_id"),
    )


def downgrade() -> None:
    op.drop_table("person_models")
