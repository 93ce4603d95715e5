"""Errors of tracks are worked out anew: those kept so far may have been by labels that the track itself made."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None


def upgrade() -> None:
    tracks = sa.table("tracks", sa.column("error_px", sa.Float()))
    op.execute(tracks.update().values(error_px=None))


def downgrade() -> None:
    """What was kept before is gone; the next look at an evaluation finds it again."""
