"""The labels of a recording that were changed last are found without reading all of them."""

from __future__ import annotations

from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

INDEX = "ix_annotations_sequence_id_updated_at"


def upgrade() -> None:
    op.create_index(INDEX, "annotations", ["sequence_id", "updated_at"])


def downgrade() -> None:
    op.drop_index(INDEX, "annotations")
