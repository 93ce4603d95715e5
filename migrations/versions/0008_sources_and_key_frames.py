"""Where joints came from, how many are decided, key frames of everybody."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0008"
down_revision = "0006"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
BATCH = 2000


def upgrade() -> None:
    op.add_column("annotation_revisions", sa.Column("sources", DOCUMENT, nullable=True))
    op.add_column("annotations", sa.Column("sources", DOCUMENT, nullable=True))
    op.add_column("annotations", sa.Column("decided", sa.Integer(), nullable=False, server_default="0"))
    _count_decided()
    with op.batch_alter_table("annotations") as table:
        table.alter_column("decided", server_default=None)
    op.create_table(
        "key_frames",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("sequence_id", sa.Uuid(), nullable=False),
        sa.Column("replica", sa.String(36), nullable=False),
        sa.Column("camera", sa.String(64), nullable=False),
        sa.Column("frame", sa.Integer(), nullable=False),
        sa.Column("hand", sa.String(5), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_key_frames"),
        sa.ForeignKeyConstraint(["sequence_id"], ["sequences.id"], name="fk_key_frames_sequence_id_sequences"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_key_frames_created_by_accounts"),
        sa.UniqueConstraint(
            *("sequence_id", "replica", "camera", "frame", "hand"),
            name="uq_key_frames_sequence_id_replica_camera_frame_hand",
        ),
    )


def downgrade() -> None:
    op.drop_table("key_frames")
    for table, columns in (("annotations", ("sources", "decided")), ("annotation_revisions", ("sources",))):
        with op.batch_alter_table(table) as altered:
            for column in columns:
                altered.drop_column(column)


def _count_decided() -> None:
    """A joint is decided when it was placed, or said to be outside (v = 0 at a position other than (0, 0))."""
    table = sa.table("annotations", sa.column("id", sa.Uuid()), sa.column("points", DOCUMENT), sa.column("decided"))
    connection = op.get_bind()
    rows = connection.execute(sa.select(table.c.id, table.c.points).where(table.c.points.is_not(sa.null()))).all()
    counted = [{"key": id_, "count": sum(any(point) for point in points)} for id_, points in rows]
    statement = sa.update(table).where(table.c.id == sa.bindparam("key")).values(decided=sa.bindparam("count"))
    for first in range(0, len(counted), BATCH):
        connection.execute(statement, counted[first : first + BATCH])
