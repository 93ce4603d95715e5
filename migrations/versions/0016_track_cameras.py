"""The cameras that a track was made with."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np
import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects.postgresql import JSONB

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None

DOCUMENT = sa.JSON(none_as_null=True).with_variant(JSONB(none_as_null=True), "postgresql")
MOMENT = sa.DateTime(timezone=True)

TRACKS = sa.table(
    "tracks",
    sa.column("id", sa.Uuid()),
    sa.column("sequence_id", sa.Uuid()),
    sa.column("created_at", MOMENT),
    sa.column("cameras_digest", sa.String(64)),
)
SEQUENCES = sa.table("sequences", sa.column("id", sa.Uuid()), sa.column("cameras", DOCUMENT))
REFINEMENTS = sa.table(
    "refinements",
    sa.column("sequence_id", sa.Uuid()),
    sa.column("state", sa.String(10)),
    sa.column("cameras_before", DOCUMENT),
    sa.column("cameras_after", DOCUMENT),
    sa.column("changed_at", MOMENT),
)


def upgrade() -> None:
    op.add_column("tracks", sa.Column("cameras_digest", sa.String(64), nullable=True))
    connection = op.get_bind()
    cameras = {row.id: row.cameras for row in connection.execute(sa.select(SEQUENCES))}
    query = sa.select(REFINEMENTS).where(REFINEMENTS.c.changed_at.is_not(None)).order_by(REFINEMENTS.c.changed_at)
    changes = connection.execute(query).all()
    for track in connection.execute(sa.select(TRACKS.c.id, TRACKS.c.sequence_id, TRACKS.c.created_at)).all():
        later = (
            change
            for change in changes
            if change.sequence_id == track.sequence_id and change.changed_at > track.created_at
        )
        made_with = cameras[track.sequence_id]
        if (first := next(later, None)) is not None:  # what that change replaced
            made_with = first.cameras_before if first.state == "taken" else first.cameras_after
        change = sa.update(TRACKS).where(TRACKS.c.id == track.id).values(cameras_digest=digest_cameras(made_with))
        connection.execute(change)


def downgrade() -> None:
    op.drop_column("tracks", "cameras_digest")


def digest_cameras(cameras: list[dict[str, Any]]) -> str:
    """As `server/tracks/cameras.py` has it at this revision."""
    names = ("K", "distortion", "T_world_camera")
    places = [[np.asarray(camera[name], dtype=np.float64).tolist() for name in names] for camera in cameras]
    return hashlib.sha256(json.dumps(places).encode()).hexdigest()
