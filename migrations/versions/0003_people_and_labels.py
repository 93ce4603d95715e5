"""Roles, logins, tokens, audit; projects, assignments, replicas; snapshots; dismissed flags; batches of jobs."""

from __future__ import annotations

from uuid import UUID

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)
LOCAL_ACCOUNT = UUID("00000000-0000-4000-8000-000000000001")
PLACE = ["sequence_id", "camera", "frame", "hand"]
OLD_PLACE, NEW_PLACE = (
    "uq_annotations_sequence_id_camera_frame_hand",
    "uq_annotations_sequence_id_replica_camera_frame_hand",
)


def _id() -> sa.Column:
    return sa.Column("id", sa.Uuid(), nullable=False)


def _ref(table: str, column: str, target: str) -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint([column], [f"{target}.id"], name=f"fk_{table}_{column}_{target}")


def _table(name: str, *columns: sa.Column, refs: dict[str, str], rules: tuple[sa.Constraint, ...] = ()) -> None:
    constraints = (sa.PrimaryKeyConstraint("id", name=f"pk_{name}"), *(_ref(name, c, t) for c, t in refs.items()))
    op.create_table(name, _id(), *columns, *constraints, *rules)


def _text(name: str, length: int | None = None, nullable: bool = False) -> sa.Column:
    return sa.Column(name, sa.Text() if length is None else sa.String(length), nullable=nullable)


def _uuid(name: str, nullable: bool = False) -> sa.Column:
    return sa.Column(name, sa.Uuid(), nullable=nullable)


def _moment(name: str, nullable: bool = False) -> sa.Column:
    return sa.Column(name, MOMENT, nullable=nullable)


def _count(name: str, nullable: bool = False) -> sa.Column:
    return sa.Column(name, sa.Integer(), nullable=nullable)


def _document(name: str) -> sa.Column:
    return sa.Column(name, DOCUMENT, nullable=False)


def upgrade() -> None:
    with op.batch_alter_table("accounts") as accounts:
        accounts.add_column(sa.Column("role", sa.String(10), nullable=False, server_default="annotator"))
        accounts.add_column(_text("password_hash", 300, nullable=True))
        accounts.add_column(sa.Column("preferences", DOCUMENT, nullable=False, server_default="{}"))
        accounts.add_column(sa.Column("revision", sa.Integer(), nullable=False, server_default="1"))
        accounts.add_column(_moment("disabled_at", nullable=True))
        accounts.create_check_constraint("ck_accounts_role", "role IN ('annotator', 'reviewer', 'lead', 'admin')")
    table = sa.table("accounts", sa.column("id", sa.Uuid()), sa.column("role", sa.String()))
    op.execute(table.update().where(table.c.id == LOCAL_ACCOUNT).values(role="admin"))
    with op.batch_alter_table("annotations") as annotations:
        annotations.add_column(sa.Column("replica", sa.String(36), nullable=False, server_default=""))
        annotations.drop_constraint(OLD_PLACE, type_="unique")
        annotations.create_unique_constraint(NEW_PLACE, ["sequence_id", "replica", "camera", "frame", "hand"])
    with op.batch_alter_table("jobs") as jobs:
        jobs.add_column(_uuid("batch_id", nullable=True))
        jobs.add_column(_uuid("created_by", nullable=True))
        jobs.create_foreign_key("fk_jobs_created_by_accounts", "accounts", ["created_by"], ["id"])
    op.create_index("ix_jobs_batch_id", "jobs", ["batch_id"])
    _people()
    _teams()
    _labels()


def _people() -> None:
    _table(
        "logins",
        _uuid("account_id"),
        _text("secret_hash", 64),
        _text("user_agent", 300),
        _moment("created_at"),
        _moment("last_seen_at"),
        _moment("expires_at"),
        refs={"account_id": "accounts"},
        rules=(sa.UniqueConstraint("secret_hash", name="uq_logins_secret_hash"),),
    )
    op.create_index("ix_logins_account_id", "logins", ["account_id"])
    _table(
        "tokens",
        _uuid("account_id"),
        _text("name", 200),
        _text("secret_hash", 64),
        sa.Column("may_write", sa.Boolean(), nullable=False),
        _moment("created_at"),
        _moment("expires_at", nullable=True),
        _moment("last_used_at", nullable=True),
        _moment("revoked_at", nullable=True),
        refs={"account_id": "accounts"},
        rules=(sa.UniqueConstraint("secret_hash", name="uq_tokens_secret_hash"),),
    )
    op.create_index("ix_tokens_account_id", "tokens", ["account_id"])
    _table(
        "audit",
        _moment("time"),
        _uuid("account_id", nullable=True),
        _text("act", 60),
        _text("subject", 40),
        _uuid("subject_id", nullable=True),
        _document("detail"),
        refs={"account_id": "accounts"},
    )
    op.create_index("ix_audit_time_id", "audit", ["time", "id"])
    op.create_index("ix_audit_subject_subject_id", "audit", ["subject", "subject_id"])


def _teams() -> None:
    _table(
        "projects",
        _text("name", 200),
        _text("description"),
        _count("revision"),
        _moment("created_at"),
        _uuid("created_by", nullable=True),
        _moment("archived_at", nullable=True),
        refs={"created_by": "accounts"},
        rules=(sa.UniqueConstraint("name", name="uq_projects_name"),),
    )
    _table(
        "project_sequences",
        _uuid("project_id"),
        _uuid("sequence_id"),
        _moment("added_at"),
        refs={"project_id": "projects", "sequence_id": "sequences"},
        rules=(sa.UniqueConstraint("project_id", "sequence_id", name="uq_project_sequences_project_id_sequence_id"),),
    )
    _table(
        "replica_sets",
        _uuid("project_id"),
        _uuid("sequence_id"),
        _text("name", 200),
        _document("frames"),
        _document("cameras"),
        _document("hands"),
        _moment("created_at"),
        _uuid("created_by", nullable=True),
        refs={"project_id": "projects", "sequence_id": "sequences", "created_by": "accounts"},
    )
    _table(
        "assignments",
        _uuid("project_id"),
        _uuid("sequence_id"),
        _uuid("account_id"),
        _uuid("replica_set_id", nullable=True),
        _count("frame_first"),
        _count("frame_last"),
        _text("state", 10),
        _text("note"),
        _count("revision"),
        _moment("created_at"),
        _uuid("created_by", nullable=True),
        _moment("updated_at"),
        _uuid("reviewer_id", nullable=True),
        refs={
            "project_id": "projects",
            "sequence_id": "sequences",
            "account_id": "accounts",
            "replica_set_id": "replica_sets",
            "created_by": "accounts",
            "reviewer_id": "accounts",
        },
        rules=(
            sa.CheckConstraint("state IN ('open', 'submitted', 'returned', 'accepted')", name="ck_assignments_state"),
            sa.CheckConstraint("frame_first >= 0 AND frame_last >= frame_first", name="ck_assignments_frames"),
        ),
    )
    op.create_index("ix_assignments_account_id_state", "assignments", ["account_id", "state"])
    op.create_index("ix_assignments_sequence_id", "assignments", ["sequence_id"])
    _table(
        "assignment_comments",
        _uuid("assignment_id"),
        _uuid("account_id"),
        _text("text"),
        _text("camera", 64, nullable=True),
        _count("frame", nullable=True),
        _text("hand", 5, nullable=True),
        _count("joint", nullable=True),
        _moment("created_at"),
        _moment("resolved_at", nullable=True),
        _uuid("resolved_by", nullable=True),
        refs={"assignment_id": "assignments", "account_id": "accounts", "resolved_by": "accounts"},
    )
    op.create_index("ix_assignment_comments_assignment_id", "assignment_comments", ["assignment_id"])


def _labels() -> None:
    _table(
        "label_snapshots",
        _uuid("sequence_id"),
        _count("version"),
        _text("name", 200),
        _text("content_hash", 64),
        _count("item_count"),
        _count("joint_count"),
        _moment("created_at"),
        _uuid("created_by", nullable=True),
        refs={"sequence_id": "sequences", "created_by": "accounts"},
    )
    op.create_index("ix_label_snapshots_sequence_id_created_at", "label_snapshots", ["sequence_id", "created_at"])
    _table(
        "flag_dismissals",
        _uuid("annotation_id"),
        _count("revision"),
        _text("kind", 30),
        _uuid("account_id", nullable=True),
        _moment("created_at"),
        refs={"annotation_id": "annotations", "account_id": "accounts"},
        rules=(
            sa.UniqueConstraint(
                "annotation_id", "revision", "kind", name="uq_flag_dismissals_annotation_id_revision_kind"
            ),
        ),
    )


def downgrade() -> None:
    for table in (
        "flag_dismissals",
        "label_snapshots",
        "assignment_comments",
        "assignments",
        "replica_sets",
        "project_sequences",
        "projects",
        "audit",
        "tokens",
        "logins",
    ):
        op.drop_table(table)
    op.drop_index("ix_jobs_batch_id", "jobs")
    with op.batch_alter_table("jobs") as jobs:
        jobs.drop_constraint("fk_jobs_created_by_accounts", type_="foreignkey")
        jobs.drop_column("created_by")
        jobs.drop_column("batch_id")
    replicas = sa.table("annotations", sa.column("id", sa.Uuid()), sa.column("replica", sa.String()))
    history = sa.table("annotation_revisions", sa.column("annotation_id", sa.Uuid()))
    blind = sa.select(replicas.c.id).where(replicas.c.replica != "")
    op.execute(history.delete().where(history.c.annotation_id.in_(blind)))
    op.execute(replicas.delete().where(replicas.c.replica != ""))
    with op.batch_alter_table("annotations") as annotations:
        annotations.drop_constraint(NEW_PLACE, type_="unique")
        annotations.create_unique_constraint(OLD_PLACE, PLACE)
        annotations.drop_column("replica")
    with op.batch_alter_table("accounts") as accounts:
        accounts.drop_constraint("ck_accounts_role", type_="check")
        for column in ("role", "password_hash", "preferences", "revision", "disabled_at"):
            accounts.drop_column(column)
