"""Scans, registrations, decisions, training sets and hand models; jobs that register and train."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)


def _refer(table: str, column: str, to: str) -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint([column], [f"{to}.id"], name=f"fk_{table}_{column}_{to}")


def upgrade() -> None:
    op.create_table(
        "scans",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("collection", sa.String(200), nullable=False),
        sa.Column("subject", sa.String(100), nullable=False),
        sa.Column("pose", sa.String(100), nullable=False),
        sa.Column("side", sa.String(5), nullable=True),
        sa.Column("state", sa.String(10), nullable=False),
        sa.Column("problem", sa.Text(), nullable=True),
        sa.Column("file", sa.String(20), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("byte_count", sa.BigInteger(), nullable=False),
        sa.Column("point_count", sa.Integer(), nullable=False),
        sa.Column("face_count", sa.Integer(), nullable=False),
        sa.Column("has_colors", sa.Boolean(), nullable=False),
        sa.Column("extent_m", DOCUMENT, nullable=False),
        sa.Column("metres_per_unit", sa.Double(), nullable=True),
        sa.Column("notes", DOCUMENT, nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("removed_count", sa.Integer(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_scans"),
        _refer("scans", "created_by", "accounts"),
        sa.CheckConstraint("state IN ('new', 'registered', 'failed')", name="ck_scans_state"),
        sa.CheckConstraint("side IN ('right', 'left')", name="ck_scans_side"),
    )
    op.create_index("ix_scans_created_at_id", "scans", ["created_at", "id"])
    op.create_index("ix_scans_collection_subject", "scans", ["collection", "subject"])
    op.create_index("ix_scans_digest", "scans", ["digest"])
    op.create_table(
        "scan_crops",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("scan_id", sa.Uuid(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("strokes", DOCUMENT, nullable=False),
        sa.Column("drops_objects", sa.Boolean(), nullable=False),
        sa.Column("removed_count", sa.Integer(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("author_id", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_scan_crops"),
        _refer("scan_crops", "scan_id", "scans"),
        _refer("scan_crops", "author_id", "accounts"),
        sa.UniqueConstraint("scan_id", "revision", name="uq_scan_crops_scan_id_revision"),
    )
    op.create_table(
        "training_sets",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("rule", DOCUMENT, nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("registration_count", sa.Integer(), nullable=False),
        sa.Column("subject_count", sa.Integer(), nullable=False),
        sa.Column("mirrored_count", sa.Integer(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_training_sets"),
        _refer("training_sets", "created_by", "accounts"),
    )
    op.create_index("ix_training_sets_created_at_id", "training_sets", ["created_at", "id"])
    op.create_table(
        "hand_models",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("kind", sa.String(10), nullable=False),
        sa.Column("side", sa.String(5), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("facts", DOCUMENT, nullable=False),
        sa.Column("round", sa.Integer(), nullable=False),
        sa.Column("parent_id", sa.Uuid(), nullable=True),
        sa.Column("training_set_id", sa.Uuid(), nullable=True),
        sa.Column("job_id", sa.Uuid(), nullable=True),
        sa.Column("report", DOCUMENT, nullable=True),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_hand_models"),
        _refer("hand_models", "parent_id", "hand_models"),
        _refer("hand_models", "training_set_id", "training_sets"),
        _refer("hand_models", "created_by", "accounts"),
        sa.CheckConstraint("kind IN ('untrained', 'trained', 'uploaded')", name="ck_hand_models_kind"),
        sa.CheckConstraint("side IN ('right', 'left')", name="ck_hand_models_side"),
    )
    op.create_index("ix_hand_models_created_at_id", "hand_models", ["created_at", "id"])
    op.create_table(
        "registrations",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("scan_id", sa.Uuid(), nullable=False),
        sa.Column("model_id", sa.Uuid(), nullable=False),
        sa.Column("job_id", sa.Uuid(), nullable=True),
        sa.Column("round", sa.Integer(), nullable=False),
        sa.Column("crop_revision", sa.Integer(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("side", sa.String(5), nullable=False),
        sa.Column("verdict", sa.String(10), nullable=False),
        sa.Column("score", sa.Double(), nullable=False),
        sa.Column("reasons", DOCUMENT, nullable=False),
        sa.Column("scan_to_mesh_mm", DOCUMENT, nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.Column("is_current", sa.Boolean(), nullable=False),
        sa.Column("decision", sa.String(10), nullable=True),
        sa.Column("standing", DOCUMENT, nullable=False),
        sa.Column("reviewer_count", sa.Integer(), nullable=False),
        sa.Column("sole_reviewer_id", sa.Uuid(), nullable=True),
        sa.Column("needs_second", sa.Boolean(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_registrations"),
        _refer("registrations", "scan_id", "scans"),
        _refer("registrations", "model_id", "hand_models"),
        _refer("registrations", "sole_reviewer_id", "accounts"),
        sa.CheckConstraint("verdict IN ('good', 'doubtful', 'bad')", name="ck_registrations_verdict"),
        sa.CheckConstraint("decision IN ('accept', 'reject', 'unsure')", name="ck_registrations_decision"),
        sa.CheckConstraint("side IN ('right', 'left')", name="ck_registrations_side"),
    )
    op.create_index("ix_registrations_created_at_id", "registrations", ["created_at", "id"])
    for column in ("scan_id", "model_id", "job_id"):
        op.create_index(f"ix_registrations_{column}", "registrations", [column])
    queue = ["is_current", "decision", "score"]
    op.create_index("ix_registrations_is_current_decision_score", "registrations", queue)
    op.create_table(
        "decisions",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("registration_id", sa.Uuid(), nullable=False),
        sa.Column("account_id", sa.Uuid(), nullable=False),
        sa.Column("model_id", sa.Uuid(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("decision", sa.String(10), nullable=False),
        sa.Column("undoes_id", sa.Uuid(), nullable=True),
        sa.Column("reasons", DOCUMENT, nullable=False),
        sa.Column("note", sa.Text(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=True),
        sa.Column("is_blind", sa.Boolean(), nullable=False),
        sa.Column("operation_id", sa.Uuid(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_decisions"),
        _refer("decisions", "registration_id", "registrations"),
        _refer("decisions", "account_id", "accounts"),
        _refer("decisions", "model_id", "hand_models"),
        _refer("decisions", "undoes_id", "decisions"),
        sa.UniqueConstraint("operation_id", name="uq_decisions_operation_id"),
        sa.UniqueConstraint("undoes_id", name="uq_decisions_undoes_id"),
        sa.CheckConstraint("decision IN ('accept', 'reject', 'unsure', 'undo')", name="ck_decisions_decision"),
        sa.CheckConstraint("(decision = 'undo') = (undoes_id IS NOT NULL)", name="ck_decisions_undo"),
    )
    op.create_index("ix_decisions_registration_id", "decisions", ["registration_id"])
    op.create_index("ix_decisions_account_id_created_at", "decisions", ["account_id", "created_at"])
    op.create_index("ix_decisions_created_at_id", "decisions", ["created_at", "id"])
    op.create_table(
        "training_members",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("training_set_id", sa.Uuid(), nullable=False),
        sa.Column("registration_id", sa.Uuid(), nullable=False),
        sa.Column("decision_id", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_training_members"),
        _refer("training_members", "training_set_id", "training_sets"),
        _refer("training_members", "registration_id", "registrations"),
        _refer("training_members", "decision_id", "decisions"),
        sa.UniqueConstraint(
            "training_set_id", "registration_id", name="uq_training_members_training_set_id_registration_id"
        ),
    )
    op.create_index("ix_training_members_registration_id", "training_members", ["registration_id"])
    with op.batch_alter_table("jobs") as altered:
        altered.alter_column("sequence_id", existing_type=sa.Uuid(), nullable=True)
        altered.add_column(sa.Column("hand_model_id", sa.Uuid(), nullable=True))
        altered.add_column(sa.Column("title", sa.String(300), nullable=False, server_default=""))
        altered.create_foreign_key("fk_jobs_hand_model_id_hand_models", "hand_models", ["hand_model_id"], ["id"])
    with op.batch_alter_table("jobs") as altered:
        altered.alter_column("title", existing_type=sa.String(300), server_default=None)
    op.create_table(
        "job_scans",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("scan_id", sa.Uuid(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_job_scans"),
        _refer("job_scans", "job_id", "jobs"),
        _refer("job_scans", "scan_id", "scans"),
        sa.UniqueConstraint("job_id", "number", name="uq_job_scans_job_id_number"),
    )


def downgrade() -> None:
    op.drop_table("job_scans")
    op.execute("DELETE FROM job_log_lines WHERE job_id IN (SELECT id FROM jobs WHERE sequence_id IS NULL)")
    op.execute("DELETE FROM jobs WHERE sequence_id IS NULL")
    with op.batch_alter_table("jobs") as altered:
        altered.drop_constraint("fk_jobs_hand_model_id_hand_models", type_="foreignkey")
        altered.drop_column("title")
        altered.drop_column("hand_model_id")
        altered.alter_column("sequence_id", existing_type=sa.Uuid(), nullable=False)
    for table in (
        "training_members",
        "decisions",
        "registrations",
        "hand_models",
        "training_sets",
        "scan_crops",
        "scans",
    ):
        op.drop_table(table)
