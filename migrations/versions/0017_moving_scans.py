"""Moving scans, their registrations, decisions about stretches, and the accepted frames that were kept."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    op.create_table(
        "moving_scans",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("subject", sa.String(100), nullable=False),
        sa.Column("fps", sa.Double(), nullable=False),
        sa.Column("frames", DOCUMENT, nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("usable_count", sa.Integer(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("byte_count", sa.BigInteger(), nullable=False),
        sa.Column("metres_per_unit", sa.Double(), nullable=False),
        sa.Column("is_unit_guessed", sa.Boolean(), nullable=False),
        sa.Column("box_m", DOCUMENT, nullable=False),
        sa.Column("notes", DOCUMENT, nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("deleted_at", MOMENT, nullable=True),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_moving_scans"),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_moving_scans_created_by_accounts"),
    )
    op.create_index("ix_moving_scans_created_at_id", "moving_scans", ["created_at", "id"])
    op.create_index("ix_moving_scans_digest", "moving_scans", ["digest"])
    op.create_table(
        "moving_registrations",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("moving_scan_id", sa.Uuid(), nullable=False),
        sa.Column("job_id", sa.Uuid(), nullable=False),
        sa.Column("parent_id", sa.Uuid(), nullable=True),
        sa.Column("template_id", sa.Uuid(), nullable=False),
        sa.Column("prior", sa.String(10), nullable=False),
        sa.Column("holds_hands", sa.Boolean(), nullable=False),
        sa.Column("has_velocity", sa.Boolean(), nullable=False),
        sa.Column("population", sa.String(10), nullable=False),
        sa.Column("first_frame", sa.Integer(), nullable=False),
        sa.Column("last_frame", sa.Integer(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_moving_registrations"),
        sa.ForeignKeyConstraint(
            ["moving_scan_id"], ["moving_scans.id"], name="fk_moving_registrations_moving_scan_id_moving_scans"
        ),
        sa.ForeignKeyConstraint(
            ["parent_id"], ["moving_registrations.id"], name="fk_moving_registrations_parent_id_moving_registrations"
        ),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_moving_registrations_created_by_accounts"),
        sa.CheckConstraint("prior IN ('mixture', 'gaussian', 'none')", name="ck_moving_registrations_prior"),
    )
    op.create_index(
        "ix_moving_registrations_moving_scan_id_created_at", "moving_registrations", ["moving_scan_id", "created_at"]
    )
    op.create_index("ix_moving_registrations_job_id", "moving_registrations", ["job_id"])
    op.create_table(
        "frame_registrations",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("registration_id", sa.Uuid(), nullable=False),
        sa.Column("frame", sa.Integer(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("verdict", sa.String(10), nullable=False),
        sa.Column("reasons", DOCUMENT, nullable=False),
        sa.Column("scan_to_mesh_mm", DOCUMENT, nullable=False),
        sa.Column("has_left", sa.Boolean(), nullable=False),
        sa.Column("has_right", sa.Boolean(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_frame_registrations"),
        sa.ForeignKeyConstraint(
            ["registration_id"],
            ["moving_registrations.id"],
            name="fk_frame_registrations_registration_id_moving_registrations",
        ),
        sa.UniqueConstraint("registration_id", "frame", name="uq_frame_registrations_registration_id_frame"),
        sa.CheckConstraint("verdict IN ('good', 'doubtful', 'bad')", name="ck_frame_registrations_verdict"),
    )
    op.create_table(
        "stretch_decisions",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("moving_scan_id", sa.Uuid(), nullable=False),
        sa.Column("registration_id", sa.Uuid(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("account_id", sa.Uuid(), nullable=False),
        sa.Column("decision", sa.String(10), nullable=False),
        sa.Column("first_frame", sa.Integer(), nullable=False),
        sa.Column("last_frame", sa.Integer(), nullable=False),
        sa.Column("note", sa.Text(), nullable=False),
        sa.Column("undoes_id", sa.Uuid(), nullable=True),
        sa.Column("operation_id", sa.Uuid(), nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_stretch_decisions"),
        sa.ForeignKeyConstraint(
            ["moving_scan_id"], ["moving_scans.id"], name="fk_stretch_decisions_moving_scan_id_moving_scans"
        ),
        sa.ForeignKeyConstraint(
            ["registration_id"],
            ["moving_registrations.id"],
            name="fk_stretch_decisions_registration_id_moving_registrations",
        ),
        sa.ForeignKeyConstraint(["account_id"], ["accounts.id"], name="fk_stretch_decisions_account_id_accounts"),
        sa.ForeignKeyConstraint(
            ["undoes_id"], ["stretch_decisions.id"], name="fk_stretch_decisions_undoes_id_stretch_decisions"
        ),
        sa.UniqueConstraint("operation_id", name="uq_stretch_decisions_operation_id"),
        sa.UniqueConstraint("undoes_id", name="uq_stretch_decisions_undoes_id"),
        sa.UniqueConstraint("moving_scan_id", "number", name="uq_stretch_decisions_moving_scan_id_number"),
        sa.CheckConstraint("decision IN ('accept', 'reject', 'undo')", name="ck_stretch_decisions_decision"),
        sa.CheckConstraint("(decision = 'undo') = (undoes_id IS NOT NULL)", name="ck_stretch_decisions_undo"),
        sa.CheckConstraint("first_frame <= last_frame", name="ck_stretch_decisions_stretch"),
    )
    op.create_index("ix_stretch_decisions_registration_id", "stretch_decisions", ["registration_id"])
    op.create_table(
        "body_sets",
        sa.Column("id", sa.Uuid(), nullable=False),
        sa.Column("moving_scan_id", sa.Uuid(), nullable=False),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("frame_count", sa.Integer(), nullable=False),
        sa.Column("members", DOCUMENT, nullable=False),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("created_by", sa.Uuid(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_body_sets"),
        sa.ForeignKeyConstraint(
            ["moving_scan_id"], ["moving_scans.id"], name="fk_body_sets_moving_scan_id_moving_scans"
        ),
        sa.ForeignKeyConstraint(["created_by"], ["accounts.id"], name="fk_body_sets_created_by_accounts"),
        sa.UniqueConstraint("moving_scan_id", "digest", name="uq_body_sets_moving_scan_id_digest"),
    )
    op.create_index("ix_body_sets_moving_scan_id_created_at", "body_sets", ["moving_scan_id", "created_at"])
    with op.batch_alter_table("jobs") as altered:
        altered.add_column(sa.Column("moving_scan_id", sa.Uuid(), nullable=True))
        altered.create_foreign_key("fk_jobs_moving_scan_id_moving_scans", "moving_scans", ["moving_scan_id"], ["id"])
    op.create_index("ix_jobs_moving_scan_id", "jobs", ["moving_scan_id"])


def downgrade() -> None:
    op.drop_index("ix_jobs_moving_scan_id", "jobs")
    with op.batch_alter_table("jobs") as altered:
        altered.drop_constraint("fk_jobs_moving_scan_id_moving_scans", type_="foreignkey")
        altered.drop_column("moving_scan_id")
    for table in ("body_sets", "stretch_decisions", "frame_registrations", "moving_registrations", "moving_scans"):
        op.drop_table(table)
