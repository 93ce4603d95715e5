"""Logs of jobs without the tracebacks that earlier versions wrote into them."""

from __future__ import annotations

from alembic import op

revision = "0011"
down_revision = "0010"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.execute("DELETE FROM job_log_lines WHERE level = 'debug'")


def downgrade() -> None:
    """What was removed does not come back; nothing needs it."""
