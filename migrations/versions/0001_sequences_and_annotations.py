"""Accounts, sequences, imports, annotations with their history."""

from __future__ import annotations

from datetime import UTC, datetime
from uuid import UUID

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)
LOCAL_ACCOUNT = UUID("00000000-0000-4000-8000-000000000001")


def upgrade() -> None:
    accounts = op.create_table(
        "accounts",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_accounts"),
        sa.UniqueConstraint("name", name="uq_accounts_name"),
    )
    op.bulk_insert(accounts, [{"id": LOCAL_ACCOUNT, "name": "local", "created_at": datetime.now(UTC)}])
    op.create_table(
        "sequences",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("fps", sa.Double(), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("cameras", DOCUMENT, nullable=False),
        sa.Column("hands", DOCUMENT, nullable=False),
        sa.Column("objects", DOCUMENT, nullable=False),
        sa.Column("report", DOCUMENT, nullable=True),
        sa.Column("content_key", sa.String(64), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("updated_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_sequences"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_sequences_created_by_accounts"),
    )
    op.create_index("ix_sequences_created_at_id", "sequences", ["created_at", "id"])
    op.create_table(
        "imports",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("options", DOCUMENT, nullable=False),
        sa.Column("report", DOCUMENT, nullable=False),
        sa.Column("file_count", sa.Integer(), nullable=False),
        sa.Column("byte_count", sa.BigInteger(), nullable=False),
        sa.Column("sequence_id", sa.Uuid(), nullable=True),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("updated_at", MOMENT, nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_imports"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_imports_created_by_accounts"),
        sa.ForeignKeyConstraint(["sequence_id"], ["sequences.id"], name="fk_imports_sequence_id_sequences"),
        sa.CheckConstraint("state IN ('checked', 'refused', 'confirmed')", name="ck_imports_state"),
    )
    op.create_table(
        "annotations",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("sequence_id", sa.Uuid(), nullable=False),
        sa.Column("camera", sa.String(64), nullable=False),
        sa.Column("frame", sa.Integer(), nullable=False),
        sa.Column("hand", sa.String(5), nullable=False),
        sa.Column("points", DOCUMENT, nullable=True),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("updated_at", MOMENT, nullable=False),
        sa.Column("author_id", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_annotations"),
        sa.ForeignKeyConstraint(["sequence_id"], ["sequences.id"], name="fk_annotations_sequence_id_sequences"),
        sa.ForeignKeyConstraint(["author_id"], ["accounts.id"], name="fk_annotations_author_id_accounts"),
        sa.UniqueConstraint(
            "sequence_id", "camera", "frame", "hand", name="uq_annotations_sequence_id_camera_frame_hand"
        ),
        sa.CheckConstraint("hand IN ('right', 'left')", name="ck_annotations_hand"),
        sa.CheckConstraint("frame >= 0", name="ck_annotations_frame"),
    )
    op.create_table(
        "annotation_revisions",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("annotation_id", sa.Uuid(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("operation_id", sa.Uuid(), nullable=False),
        sa.Column("act", sa.String(10), nullable=False),
        sa.Column("points", DOCUMENT, nullable=True),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("author_id", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_annotation_revisions"),
        sa.ForeignKeyConstraint(
            ["annotation_id"], ["annotations.id"], name="fk_annotation_revisions_annotation_id_annotations"
        ),
        sa.ForeignKeyConstraint(["author_id"], ["accounts.id"], name="fk_annotation_revisions_author_id_accounts"),
        sa.UniqueConstraint("annotation_id", "revision", name="uq_annotation_revisions_annotation_id_revision"),
        sa.UniqueConstraint("operation_id", name="uq_annotation_revisions_operation_id"),
        sa.CheckConstraint("act IN ('put', 'delete', 'restore', 'import')", name="ck_annotation_revisions_act"),
    )


def downgrade() -> None:
    for table in ("annotation_revisions", "annotations", "imports", "sequences", "accounts"):
        op.drop_table(table)
